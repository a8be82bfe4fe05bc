"""A walk in three dimensions, as its log tells it."""

from typing import Final

import numpy as np

from ....execution.log_scene import WORLD, Frame, LoggedScene, Shape, ball, rod, turn_of
from ....execution.sample_log import columns_of
from ....types import Floats
from ..robot import FRAME_TITLES, LEG_NAMES, WalkerRobot
from ..world.ground import Ground
from .walk_trace import walk_titles

GROUND: Final = "ground"
PLATE, SECOND = FRAME_TITLES
COLOURS: Final = ("#0072B2", "#D55E00")
"""Of Delta-frame and Y-frame."""
LEVEL: Final = "#ECE9E1"
HIGHER: Final = "#E0C9A0"
LOWER: Final = "#9FB0C0"
PATCH: Final = "#C1272D88"
FAR: Final = 4.0
"""How much of the ground is told about the origin, unless it ends sooner [m]."""
THICK: Final = 0.028
"""Radius of a frame's bars over that of its circle of feet [-]."""


def walk_scene(robot: WalkerRobot, ground: Ground, *, true: bool, arm: bool) -> LoggedScene:
    """A ground and a walker on it.

    Args:
        robot: The walker.
        ground: As it truly is.
        true: Whether samples tell how things truly are; then the frames are there, else where the walker believes them.
        arm: Whether they tell of a tool.
    """
    columns = columns_of(walk_titles(true=true, arm=arm))
    tops = np.concatenate((robot.feet(), np.zeros((2, 3, 1))), axis=2)  # in their frames

    def frames(row: Floats) -> list[Frame]:
        pose, (x, y, theta) = (
            row[columns["true_pose" if true else "believed"]],
            row[columns["true_place" if true else "place"]],
        )
        plate = plate_axes(*pose[3:])
        inner = plate_axes(theta, 0.0, 0.0)
        soles = tops - row[columns["lengths"]].reshape(2, 3, 1) * (0.0, 0.0, 1.0)
        if true:
            soles = (row[columns["true_feet"]].reshape(2, 3, 3) - pose[:3]) @ plate
            soles[1] = (soles[1] - (x, y, 0.0)) @ inner
        made = [
            Frame(GROUND, WORLD, (0.0, 0.0, 0.0), turn_of(ground.axes())),
            Frame(PLATE, WORLD, pose[:3], turn_of(plate)),
            Frame(SECOND, PLATE, (x, y, 0.0), turn_of(inner)),
        ]
        made += [Frame(f"{name} sole", FRAME_TITLES[k // 3], soles[k // 3, k % 3]) for k, name in enumerate(LEG_NAMES)]
        return made + ([Frame("tool", WORLD, row[columns["true_tool"]])] if true and arm else [])

    shapes = {GROUND: _ground(ground)} | _robot(robot)
    if true and arm:
        shapes["tool"] = [ball(0.02, "#6B6B6B")]
    return LoggedScene(shapes, frames)


def plate_axes(alpha: float | Floats, beta: float | Floats, gamma: float | Floats) -> Floats:
    """The plate's axes in the world as columns, R = Rz(alpha) Ry(beta) Rx(gamma), shape (3, 3), or (3, 3, n) of n angles each."""
    (ca, sa), (cb, sb), (cg, sg) = ((np.cos(t), np.sin(t)) for t in (alpha, beta, gamma))
    return np.array(
        (
            (ca * cb, ca * sb * sg - sa * cg, ca * sb * cg + sa * sg),
            (sa * cb, sa * sb * sg + ca * cg, sa * sb * cg - ca * sg),
            (-sb, cb * sg, cb * cg),
        )
    )


def _ground(ground: Ground) -> list[Shape]:
    tiles = ground.tiles()
    bottom = float(tiles[:, 4].min(initial=0.0, where=tiles[:, 4] > -ground.depth)) - 0.1
    shapes = []
    for low_x, high_x, low_y, high_y, top in tiles:
        x0, x1, y0, y1 = max(low_x, -FAR), min(high_x, FAR), max(low_y, -FAR), min(high_y, FAR)
        if x0 < x1 and y0 < y1 and top > bottom:
            shade = LOWER if top < 0.0 else HIGHER if top > 0.0 else LEVEL
            middle = (0.5 * (x0 + x1), 0.5 * (y0 + y1), 0.5 * (top + bottom))
            shapes.append(Shape("cubes", middle, (x1 - x0, y1 - y0, top - bottom), shade))
    for patch in ground.forbidden():
        (x0, y0), (x1, y1) = np.min(patch, axis=0), np.max(patch, axis=0)
        shapes.append(Shape("cubes", (0.5 * (x0 + x1), 0.5 * (y0 + y1), 0.0), (x1 - x0, y1 - y0, 0.004), PATCH))
    return shapes


def _robot(robot: WalkerRobot) -> dict[str, list[Shape]]:
    r = THICK * max(robot.legs.radius_delta, robot.legs.radius_y)
    shapes: dict[str, list[Shape]] = {}
    for frame, colour, corners in zip(FRAME_TITLES, COLOURS, robot.attachments(), strict=True):
        places = np.column_stack((corners, np.zeros(3)))
        others = np.roll(places, -1, axis=0) if frame == PLATE else np.zeros((3, 3))
        shapes[frame] = [rod(here, there, r, colour) for here, there in zip(places, others, strict=True)]
    pad = max(robot.legs.pad_radius, 1.6 * r)
    up = np.array((0.0, 0.0, 1.0))
    for k, name in enumerate(LEG_NAMES):
        leg = rod(0.0 * up, robot.legs.nominal * up, 0.7 * r, COLOURS[k // 3])  # as long as it is on level ground
        shapes[f"{name} sole"] = [leg, rod(0.0 * up, 0.35 * pad * up, pad, COLOURS[k // 3])]
    return shapes
