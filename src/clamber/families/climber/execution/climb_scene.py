"""A climb in three dimensions, as its log tells it: the wall stands upright, x to the right, z up, and y into it."""

import math
from collections.abc import Sequence
from typing import Final

import numpy as np

from ....execution.log_scene import BODY, HOLD, LIMBS, WORLD, Frame, LoggedScene, Shape, Turn, ball, rod
from ....execution.sample_log import columns_of
from ....types import Floats
from ..planning.task import LimbedTask
from .climb_trace import climb_titles

WALL: Final = "#EEF0F3"
OUT: Final = 5.0
"""How far in front of the wall the robot moves, in radii of a link [-]."""
THICK: Final = 0.03
"""Of the wall [m]."""
EDGE: Final = 0.2
"""Of the wall beyond its holds [m]."""


def climb_scene(task: LimbedTask, *, true: bool) -> LoggedScene:
    """A board and a climber on it.

    Args:
        task: Robot and board, as it is mapped.
        true: Whether samples tell how things truly are; then the frames are there, else where the controller believes them.
    """
    robot, columns = task.robot, columns_of(climb_titles(task.robot.limb_names, true=true))
    pose_at, angles_at = (columns["true_pose" if true else "believed"], columns["true_angles" if true else "angles"])

    def frames(row: Floats) -> list[Frame]:
        x, y, theta = row[pose_at]
        made = [Frame("body", WORLD, (x, 0.0, y), _about(theta))]
        for limb, (shoulder, elbow) in zip(robot.limbs, row[angles_at].reshape(-1, 2), strict=True):
            first, second = f"{limb.name} upper link", f"{limb.name} lower link"
            tip = limb.second_link
            made += (
                Frame(first, "body", (limb.port_x, 0.0, limb.port_y), _about(limb.port_angle + shoulder)),
                Frame(second, first, (limb.l1, 0.0, 0.0), _about(elbow)),
                Frame(f"{limb.name} tip", second, (tip.real, 0.0, tip.imag)),
            )
        return made

    return LoggedScene({WORLD: _wall(task)} | _robot(task), frames)


def _about(angle: float) -> Turn:
    """A turn on the wall [rad], anticlockwise for who stands in front of it: about -y."""
    return 0.0, -math.sin(0.5 * angle), 0.0, math.cos(0.5 * angle)


def _radius(task: LimbedTask) -> float:
    return max(task.robot.link_radius, 0.004)


def _wall(task: LimbedTask) -> list[Shape]:
    places, back = task.world.positions(), OUT * _radius(task)
    low, high = places.min(axis=0) - EDGE, places.max(axis=0) + EDGE
    middle, size = 0.5 * (low + high), high - low
    wall = Shape("cubes", (middle[0], back + 0.5 * THICK, middle[1]), (size[0], THICK, size[1]), WALL)
    return [
        wall,
        *(_peg(x, y, max(hold.radius, 0.003), back) for (x, y), hold in zip(places, task.world.holds, strict=True)),
    ]


def _peg(x: float, y: float, radius: float, back: float) -> Shape:
    return rod(np.array((x, back, y)), np.array((x, -back, y)), radius, HOLD)


def _robot(task: LimbedTask) -> dict[str, Sequence[Shape]]:
    robot, r = task.robot, _radius(task)
    ports = np.array([(limb.port_x, 0.0, limb.port_y) for limb in robot.limbs])
    body = [
        rod(here, there, 1.5 * r, BODY)
        for here, there in zip(ports, np.roll(ports, -1, axis=0), strict=True)
        if (here != there).any()
    ]
    shapes: dict[str, Sequence[Shape]] = {"body": [*body, ball(3.0 * r, BODY)]}
    for k, limb in enumerate(robot.limbs):
        shade, none, tip = LIMBS[k % len(LIMBS)], np.zeros(3), limb.second_link
        end = np.array((tip.real, 0.0, tip.imag))
        shapes[f"{limb.name} upper link"] = [ball(1.6 * r, shade), rod(none, np.array((limb.l1, 0.0, 0.0)), r, shade)]
        shapes[f"{limb.name} lower link"] = [ball(1.6 * r, shade), rod(none, end, r, shade)]
        shapes[f"{limb.name} tip"] = [ball(1.3 * r, shade)]
    return shapes
