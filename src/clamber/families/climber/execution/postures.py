"""Postures of a two-joint limb: the joint angles that put its tip at a place of the world, and where its hook then pulls."""

import math
from dataclasses import dataclass

import numpy as np

from ....types import Floats
from ..control.limb_chain import closed_branches
from ..robot.robot import Limb


@dataclass(frozen=True, slots=True, eq=False)
class Posture:
    """Joint angles of a limb, and the direction in which its hook pulls."""

    angles: Floats
    """Shoulder and elbow [rad], shape (2,)."""
    grab: Floats
    """Unit vector, world frame, shape (2,)."""
    inside: bool
    """Whether both joints are within their limits."""

    @property
    def on_top(self) -> float:
        """1 for a hook that pulls straight down, -1 for one that pulls up [-]."""
        return -float(self.grab[1])


def postures(limb: Limb, pose: Floats, place: Floats) -> list[Posture]:
    """Both postures with the tip at a place, elbow angle positive first; none out of reach.

    Args:
        limb: Of the robot.
        pose: Body x, y [m], theta [rad].
        place: Of the tip, world frame [m].
    """
    (x, y, angle), (to_x, to_y) = pose.tolist(), place.tolist()
    c, s = math.cos(angle), math.sin(angle)
    dx = to_x - x - (c * limb.port_x - s * limb.port_y)
    dy = to_y - y - (s * limb.port_x + c * limb.port_y)
    turn = limb.port_angle + angle
    ct, st = math.cos(turn), math.sin(turn)
    out, first, second = [], limb.shoulder, limb.elbow
    for shoulder, elbow in closed_branches(limb, ct * dx + st * dy, ct * dy - st * dx):
        inside = (
            first.lower - 1e-9 <= shoulder <= first.upper + 1e-9 and second.lower - 1e-9 <= elbow <= second.upper + 1e-9
        )
        grab = turn + (shoulder + elbow) + limb.end.angle
        out.append(Posture(np.array((shoulder, elbow)), np.array((math.cos(grab), math.sin(grab))), inside))
    return out


def bent_postures(limb: Limb, pose: Floats, place: Floats, side: float, bend: float = 0.0) -> list[Posture]:
    """Those of `postures` within the joints' limits whose elbow is bent to the side of `side`, its sign, by more than `bend` [rad]."""
    found = postures(limb, pose, place)
    return [one for one in found if one.inside and side * one.angles[1] > 0.0 and abs(one.angles[1]) > bend]
