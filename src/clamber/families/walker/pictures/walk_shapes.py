"""A walker's parts in the world at one moment of its trace: what side view and top view both draw."""

from dataclasses import dataclass

import numpy as np

from ....types import Floats, Ints
from ..execution.true_walk import TrueWalk
from ..robot import WalkerRobot


@dataclass(frozen=True, slots=True, eq=False)
class WalkShapes:
    """Points in the world [m]."""

    frames: tuple[Floats, Floats]
    """Lines of the Delta-frame's triangle, shape (4, 3), and of the Y-frame's star, shape (5, 3)."""
    actuators: Floats
    """Ends of the actuators, shape (3, 2, 3)."""
    legs: Floats
    """Tops and soles of the legs, shape (2, 3, 2, 3)."""
    touching: Ints
    """1 for feet on the ground, shape (2, 3)."""
    arm: Floats
    """From the plate over the shoulder to the tool point, shape (3, 3); NaN without an arm."""
    centre: Floats
    """Centre of mass, shape (3,)."""


def shapes_at(robot: WalkerRobot, trace: TrueWalk, k: int) -> WalkShapes:
    """The robot at a row of its trace."""
    axes, origin = plate_axes(*trace.pose[k, 3:]), trace.pose[k, :3]
    x, y, theta = trace.place[k]
    c, s = np.cos(theta), np.sin(theta)

    def in_world(points: Floats, f: int) -> Floats:
        flat = points @ np.array(((c, s), (-s, c))) + (x, y) if f else points
        placed: Floats = origin + flat @ axes[:, :2].T
        return placed

    attachments = [in_world(points, f) for f, points in enumerate(robot.attachments())]
    middle = in_world(np.zeros((1, 2)), 1)[0]
    delta, star = attachments
    tops = np.stack([in_world(points, f) for f, points in enumerate(robot.feet())])
    shoulder = np.full(3, np.nan) if robot.arm is None else origin + robot.arm.up * axes[:, 2]
    return WalkShapes(
        (delta[[0, 1, 2, 0]], np.array((star[1], middle, star[0], middle, star[2]))),
        np.stack((delta, star), axis=1),
        np.stack((tops, trace.feet[k]), axis=2),
        trace.touching[k],
        np.array((origin, shoulder, trace.tool[k])),
        trace.centre[k],
    )


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
