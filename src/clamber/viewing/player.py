"""A climb as one HTML file that plays in any browser: all data inside, nothing loaded from elsewhere."""

import html
import json
import math
from pathlib import Path
from typing import Any, Final

from ..files import write_atomically
from ..types import Json
from ..units import OZ_IN
from . import style
from .climber import force_scale
from .frames import Frame, make_frames
from .geometry import body_outline
from .margins import grade
from .panel import NEAR_LIMIT, nice_force, torque_limits
from .player_page import PAGE
from .scene import goal_label, goal_outline, hold_radius
from .view import ClimbView
from .words import describe_action, describe_holds, describe_pose, length_unit

MOST_FRAMES: Final = 2400
GRID: Final = 1e4
"""Places are whole tenths of a millimetre in the file [1/m]."""


def write_html(view: ClimbView, path: Path, *, most_frames: int = MOST_FRAMES) -> None:
    """Write a climb as a page with its own player."""
    text = json.dumps(player_data(view, make_frames(view, most_frames)), separators=(",", ":"), allow_nan=False)
    text = text.replace("<", "\\u003c")  # so that no name in the data can end the script
    page = PAGE.replace("@TITLE@", html.escape(view.task.title)).replace("@DATA@", text)
    write_atomically(path, page)


def player_data(view: ClimbView, frames: list[Frame]) -> Json:
    """What the player is given; places in tenths of a millimetre, world frame."""
    task = view.task
    robot, least = task.robot, hold_radius(task, view.bounds)
    outline = body_outline(robot)
    unit, size = length_unit(task)
    ounces = unit == "in"
    limits = torque_limits(task)
    force = nice_force(robot.weight)
    return {
        "title": task.title,
        "unit": [unit, size * GRID],
        "bounds": _whole(view.bounds),
        "palette": {
            "strip": style.STRIP, "words": style.STRIP_WORDS, "body": style.BODY, "hold": style.HOLD,
            "goal": style.GOAL, "force": style.FORCE, "alert": style.ALERT,
        },
        "holds": [
            {
                "at": _whole((hold.x, hold.y)),
                "r": round(GRID * max(hold.radius, least)),
                "n": hold.number,
                "cone": None
                if hold.direction is None
                else [hold.direction, math.pi / 2 if hold.cone is None else hold.cone],
            }
            for hold in task.world.holds
        ],
        "keepOut": [[_whole(corner) for corner in polygon] for polygon in task.world.keep_out],
        "goals": [
            {"corners": [_whole(c) for c in corners], "label": goal_label(task, k), "last": k == len(task.goals) - 1}
            for k, goal in enumerate(task.goals)
            if (corners := goal_outline(goal, view.bounds)) is not None
        ],
        "limbs": [
            {"name": limb.name, "colour": style.PARTS[i % len(style.PARTS)], "kind": limb.end.kind}
            for i, limb in enumerate(robot.limbs)
        ],
        "limits": limits.ravel().tolist(),
        "torqueUnit": ["oz-in", OZ_IN] if ounces else ["N m", 1.0],
        "nearLimit": NEAR_LIMIT,
        "radius": round(GRID * max(robot.link_radius, 0.004)),
        "body": [_whole((point.real, point.imag)) for point in outline],
        "forceScale": GRID * force_scale(task),
        "forceKey": force,
        "steps": [_step(view, step) for step in range(len(view.replay.stances))],
        "frames": [_frame(frame) for frame in frames],
    }  # fmt: skip


def _whole(values: Any) -> list[int]:
    return [round(GRID * float(value)) for value in values]


def _step(view: ClimbView, step: int) -> Json:
    stances = view.replay.stances
    reason = int(view.replay.reasons[step - 1]) if step else -1
    limit = view.limiting[step - 1] if step else None
    at = view.postures[step]
    return {
        "action": describe_action(view.task, stances[step - 1], stances[step], reason) if step else "start",
        "pose": describe_pose(view.task, at.x, at.y, at.angle),
        "holds": describe_holds(view.task, stances[step]),
        "limit": "not judged" if limit is None else str(limit),
        "grade": grade(limit),
    }


def _frame(frame: Frame) -> list[Any]:
    at = frame.snapshot
    posture = at.posture
    return [
        frame.step,
        round(frame.length, 2),
        [*_whole((posture.x, posture.y)), round(posture.angle, 4)],
        _whole(posture.chains.ravel()),
        [round(float(grip), 3) for grip in posture.grips],
        list(posture.held),
        [round(float(force), 2) for force in at.forces.ravel()],
        [round(float(torque), 3) for torque in at.torques.ravel()],
    ]
