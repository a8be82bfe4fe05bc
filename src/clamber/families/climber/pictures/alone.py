"""A climber or a board by itself, as pictures and the viewer take them: a task that is never planned stands around it."""

import cmath
import math
from typing import Final

import numpy as np
from matplotlib.axes import Axes

from ....tasks.robots import read_robot, robot_names
from ....types import Json
from ....viewing import style
from ....viewing.alone import Alone
from ....viewing.scene import fit_bounds, halo, set_axes
from ..planning.task import LimbedTask, Rules, Start, Step
from ..robot.robot import Limb, LimbedRobot, build_limbed
from ..world.board import Board
from .artists import ClimberArtists, draw_scene, find_bounds, unloaded
from .geometry import Posture, joint_margin, limb_chain, pose

SHARES: Final = (0.8, 0.7, 0.9, 0.6, 0.95, 0.5)
"""How far limbs are stretched, over their length; the first that their joints allow is taken [-]."""


def _around(robot: LimbedRobot, board: Board, document: Json) -> LimbedTask:
    """What stands in for a task; `document` has the documents of the robot and of what else is shown."""
    return LimbedTask(
        name=board.name, title=board.title, robot=robot, world=board, start=Start(x=0.0, y=0.0, holds={}),
        step=Step(length=0.01, angle=math.radians(15.0)), goals=(), rules=Rules(), document=document,
    )  # fmt: skip


def board_alone(board: Board, document: Json) -> Alone:
    """A board; what the viewer asks of a robot, such as how long pegs need be, one that comes with Clamber says."""
    robot = read_robot(robot_names("limbed")[0])
    task = _around(build_limbed(robot), board, {"board": document, "robot": robot.data})
    bounds = find_bounds(task, [])
    return Alone(task, bounds, lambda axes: draw_scene(axes, task, bounds))


def climber_alone(robot: LimbedRobot, document: Json) -> Alone:
    """A climber upright, its limbs stretched out of their ports as far as their joints let them."""
    task = _around(robot, Board(name=robot.name, title=robot.title, holds=()), {"robot": document})
    tips, sides = zip(*map(_spread, robot.limbs), strict=True)
    free = (-1,) * len(robot.limbs)
    posture = pose(robot, 0j, 0.0, list(tips), list(sides), free)
    bounds = fit_bounds(np.vstack((posture.outline, posture.chains.reshape(-1, 2))), ())

    def draw(axes: Axes) -> None:
        set_axes(axes, task, bounds)
        ClimberArtists(axes, task, bounds, arrows=False).update(unloaded(posture))
        _name_limbs(axes, robot, posture)

    return Alone(task, bounds, draw, unloaded(posture))


def _spread(limb: Limb) -> tuple[complex, float]:
    """Tip of a limb in the body frame [m], and the side of its elbow."""
    port, ahead = complex(limb.port_x, limb.port_y), cmath.exp(1j * limb.port_angle)
    ways = [(port + share * limb.length * ahead, side) for share in SHARES for side in (1.0, -1.0)]
    margins = [joint_margin(limb, 0.0, limb_chain(limb, 0j, 0.0, tip, side)) for tip, side in ways]
    return next(
        (way for way, margin in zip(ways, margins, strict=True) if margin >= 0.0), ways[int(np.argmax(margins))]
    )


def _name_limbs(axes: Axes, robot: LimbedRobot, posture: Posture) -> None:
    for i, (limb, chain) in enumerate(zip(robot.limbs, posture.chains, strict=True)):
        axes.annotate(
            limb.name, chain[3], xytext=(0, 9), textcoords="offset points", ha="center", va="bottom", fontsize=8, zorder=9,
            color=style.PARTS[i % len(style.PARTS)], weight="bold", path_effects=[halo(2.5)],
        )  # fmt: skip
