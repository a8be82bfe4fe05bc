"""Where a walker's centre of mass is, with arm and payload, and how far inside its standing feet."""

import numpy as np

from ....types import Floats
from ..robot import WalkerRobot
from ..robot.weight import arm_places
from .dead_reckoning import orient


def mass_moment(robot: WalkerRobot, place: Floats, arm: Floats, payload: float = 0.0) -> tuple[float, Floats]:
    """Mass of the robot [kg], and its centre of mass in the plate, shape (..., 3) [m].

    Args:
        robot: The walker.
        place: Of the Y-frame in the Delta-frame, one or several, shape (..., 3) [m], [rad].
        arm: Joint angles, shape (joints,) [rad]; any without an arm.
        payload: Mass at the tool point [kg].
    """
    mass = robot.mass.frames
    on_y = 1.0 - robot.mass.share_delta
    moment = np.empty(place.shape)
    moment[..., :2] = mass * (on_y * place[..., :2])
    moment[..., 2] = mass * robot.mass.height
    if robot.arm is not None:
        points = arm_places(robot.arm, arm.tolist())
        masses = np.array(robot.arm.masses)
        moment += masses @ (0.5 * (points[:-1] + points[1:])) + payload * points[-1]
        mass += float(masses.sum()) + payload
    return mass, moment / mass


def mass_centre(robot: WalkerRobot, pose: Floats, place: Floats, arm: Floats, payload: float = 0.0) -> Floats:
    """Centre of mass in the world, shape (3,) [m]; `pose` is that of the plate, shape (6,) [m], [rad], the rest as in `mass_moment`."""
    matrix = np.empty((3, 3))
    orient(pose[3], pose[4], pose[5], matrix)
    centre: Floats = pose[:3] + matrix @ mass_moment(robot, place, arm, payload)[1]
    return centre
