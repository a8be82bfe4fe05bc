"""A climb on a plane wall, by limbs that grip, stated as one in space, where whole-body control carries it out.

The body's x is the plane's, to its right; the wall's normal is -y of the world, and z is up. Tips stay in the plane: they are not lifted
over their holds, and grip what stands out of the wall anywhere within their jaws.
"""

import math
from collections.abc import Mapping
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Final

import numpy as np

from ....files import Document
from ....regular_files import write_atomically
from ....tasks.imported import PlaneClimb
from ....tasks.regions import GoalBox
from ....types import Json
from ..robot.robot import FAMILY, LIMB_ROOM, STRETCH, whole_document
from .task import SpatialTask, build_task

GRIP: Final = "grip"
STRONG: Final = 10.0
"""Strength of a hold that states none, of the robot's weight: more than any plan asks for [-]."""
PUSHED: Final = 0.15
"""Push out of the wall that every stance is to bear, of the weight: tips in one line, about which the robot would swing, do not [-]."""
ROOM: Final = "3 deg"
"""That joints keep from their limits, as elsewhere in this family."""


def task_of(climb: PlaneClimb) -> SpatialTask:
    """The task of a climb.

    Raises:
        ClamberError: If it breaks a rule of tasks in space, such as a joint without limits.
    """
    label = f"task '{climb.name}' in space"
    with TemporaryDirectory() as folder:
        file = Path(folder) / "robot.xml"
        write_atomically(file, climb.model)
        robot = whole_document(Document(label, _robot(climb), (), file.parent))
    data = {
        "schema": "clamber-task-1",
        "name": climb.name,
        "title": climb.title,
        "robot": robot.data,
        "world": _world(climb),
        "labels": {"robot": climb.robot, "world": climb.wall},
        "start": {
            "along": _metres(climb.start[1] - _lowest(climb)),
            "height": "0 m",
            "yaw": _angle(climb.start[2] - math.pi / 2.0),
            **({} if climb.held is None else {"holds": dict(climb.held)}),
        },
        "step": {
            "length": _metres(climb.length),
            "height": _metres(climb.length),
            "heights": 0,
            "angle": _angle(climb.angle),
        },
        "goal": _goal(climb, climb.goals[-1]),
        "subgoals": [_goal(climb, goal) for goal in climb.goals[:-1]],
        "rules": {"lift": "0 m", "push": ["0 N", f"{-PUSHED * climb.weight:.9g} N", "0 N"]},
    }
    return build_task(Document(label, data))


def _robot(climb: PlaneClimb) -> Json:
    """Its robot's document."""
    reach = 2.0 * climb.radius if climb.opening is None else climb.opening / 2.0 - climb.radius
    pull = STRONG * climb.weight if climb.strength is None else climb.strength
    contact: dict[str, Any] = {
        "schema": "clamber-contact-1",
        "kind": "gripper",
        "name": GRIP,
        "title": "Gripper about a hold that stands out of the wall",
        "friction": 1.0,  # as strong along the wall as away from it
        "pull": f"{pull:.9g} N",
        "capture": _metres(reach),
        "centring": _metres(math.hypot(reach, reach)),
        "jaws": _metres(2.0 * reach),
    }
    limbs = [
        {"name": name, "tip": f"{name} tip", "contact": GRIP, "nominal": [_angle(joint) for joint in joints]}
        for name, joints in climb.limbs.items()
    ]
    return {
        "schema": "clamber-robot-1",
        "family": FAMILY,
        "name": climb.robot,
        "title": climb.robot,
        "model": "robot.xml",
        "base": "body",
        "speed": f"{climb.speed:.9g} rad/s",
        "torque_share": 1.0,
        "joint_room": ROOM,
        "stretch": STRETCH,
        "limb_room": LIMB_ROOM,
        "limb": limbs,
        "contacts": {GRIP: contact},
    }


def _world(climb: PlaneClimb) -> Json:
    """Its wall's document: holds in its plane, and a guide straight up through where it starts."""
    normal = [0, -1, 0]
    holds = []
    for number, (x, y) in enumerate(climb.holds.tolist(), start=1):
        strength = climb.strengths[number - 1]
        own = {} if math.isinf(strength) else {"strength": f"{strength:.9g} N"}
        holds.append({"number": number, "at": _place(x, y), "normal": normal, **own})
    highest = max(float(np.max(climb.holds[:, 1])), *(goal.y_min or -math.inf for goal in climb.goals), climb.start[1])
    guide = [{"at": _place(climb.start[0], _lowest(climb)), "normal": normal}, {"at": _place(climb.start[0], highest)}]
    return {"schema": "clamber-world-1", "name": climb.wall, "title": climb.wall, "guide": guide, "holds": holds}


def _lowest(climb: PlaneClimb) -> float:
    """Height at which the guide begins [m]."""
    return min(float(np.min(climb.holds[:, 1])), climb.start[1])


def _goal(climb: PlaneClimb, goal: GoalBox) -> Mapping[str, str]:
    """A goal by places along and across, and turns, of the guide."""
    x_min, x_max, y_min, y_max = goal.box
    ends = {
        "along_min": y_min - _lowest(climb),
        "along_max": y_max - _lowest(climb),
        "across_min": climb.start[0] - x_max,
        "across_max": climb.start[0] - x_min,
    }
    stated = {key: _metres(value) for key, value in ends.items() if math.isfinite(value)}
    for key, turn in (("yaw_min", goal.theta_min), ("yaw_max", goal.theta_max)):
        if turn is not None:
            stated[key] = _angle(turn - math.pi / 2.0)
    return stated | ({"name": goal.name} if goal.name else {})


def _metres(value: float) -> str:
    return f"{value:.9g} m"


def _angle(value: float) -> str:
    return f"{value:.12g} rad"


def _place(x: float, y: float) -> list[str]:
    """Of a place of the plane, in the world."""
    return [_metres(x), "0 m", _metres(y)]
