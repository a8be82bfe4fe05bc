"""Where a walker's weight is with its arm in some posture and a payload at its tool."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ....types import Floats
from .robot import Arm, WalkerRobot


@dataclass(frozen=True, slots=True)
class Weight:
    """A walker's mass, as its balance needs it."""

    total: float
    """Frames, arm and payload [kg]."""
    share: Floats
    """Parts of it that each frame carries, arm and payload on the Delta-frame [-], shape (2,); their sum is 1."""
    load: Floats
    """From the Delta-frame's origin to the centre of its part, times that part, in the Delta-frame [m], shape (2,)."""

    def centre(self, poses: Floats) -> Floats:
        """Centre of mass over the ground [m], shape (2,).

        Args:
            poses: x, y [m] and angle [rad] of both frames, world frame, shape (2, 3).
        """
        c, s = math.cos(poses[0, 2]), math.sin(poses[0, 2])
        middle: Floats = self.share @ poses[:, :2] + np.array([[c, -s], [s, c]]) @ self.load
        return middle


def arm_places(arm: Arm, angles: Sequence[float]) -> Floats:
    """Where an arm's joints and its tool are (Hoshino and others, equation 8), in the plate's frame.

    Args:
        arm: The arm.
        angles: Joint angles [rad], shape (n + 1,).

    Returns:
        The axes of the pitching joints in order, then the tool point [m], shape (n + 1, 3).
    """
    pitch = np.cumsum(angles[1:])
    along = np.concatenate([[arm.out], np.cos(pitch) * arm.links]).cumsum()
    up = np.concatenate([[arm.up], np.sin(pitch) * arm.links]).cumsum()
    return np.stack([math.cos(angles[0]) * along, math.sin(angles[0]) * along, up], axis=-1)


def weight_of(robot: WalkerRobot, angles: Sequence[float] | None = None, payload: float = 0.0) -> Weight:
    """A walker's weight.

    Args:
        robot: The robot.
        angles: Joint angles of its arm [rad], shape (n + 1,); None for those at rest.
        payload: Mass at the tool point, or at the Delta-frame's origin of a robot without an arm [kg].
    """
    mass = payload
    moment = np.zeros(2)
    if robot.arm is not None:
        places = arm_places(robot.arm, robot.arm.rest if angles is None else angles)
        middles = 0.5 * (places[1:] + places[:-1])
        moment = (np.array(robot.arm.masses) @ middles + payload * places[-1])[:2]
        mass += math.fsum(robot.arm.masses)
    total = robot.mass.frames + mass
    share = robot.mass.frames / total * np.array([robot.mass.share_delta, 1.0 - robot.mass.share_delta])
    share[0] += mass / total
    return Weight(total=total, share=share, load=moment / total)
