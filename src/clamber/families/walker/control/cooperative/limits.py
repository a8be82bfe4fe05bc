"""The limits of a robot as the kernels take them."""

from typing import Literal

import numpy as np

from ...robot import WalkerRobot
from .arm_moment import arm_moment
from .planted_feet import ACTUATOR, BALANCE, GUARD, LEG, N_ROWS, ROW_NAMES, PlantedFeet
from .scratch import Chain
from .tool_chain import POSE

Kept = Literal["all", "places", "arm"]
"""Which limits are kept: all; all but the speeds of actuators and legs; those of the arm's joints alone."""


def chain_of(robot: WalkerRobot, *, balance: float, footing: PlantedFeet | None = None, kept: Kept = "all") -> Chain:
    """The arm and every limit of a robot.

    Args:
        robot: With an arm.
        balance: Least distance of the centre of mass from the support's edges [m].
        footing: Which legs stand: only they, and the mechanism while it moves, are bounded; None: all.
        kept: Which limits.
    """
    arm = robot.own_arm
    lowest, highest, speed = np.full(N_ROWS, -np.inf), np.full(N_ROWS, np.inf), np.full(N_ROWS, np.inf)
    if footing is None or footing.support == "y":
        rows = slice(ACTUATOR, GUARD)
        lowest[rows], highest[rows] = robot.mechanism.shortest, robot.mechanism.longest
        speed[rows] = robot.mechanism.speed
        lowest[GUARD] = 0.0
    for frame in (0, 1) if footing is None else footing.standing():
        rows = slice(LEG + 3 * frame, LEG + 3 * frame + 3)
        lowest[rows], highest[rows], speed[rows] = robot.legs.shortest, robot.legs.longest, robot.legs.speed
    lowest[BALANCE:] = balance
    if kept != "all":
        speed[:] = np.inf
    if kept == "arm":
        lowest[:], highest[:] = -np.inf, np.inf
    moment = arm_moment(robot, 0.0 if footing is None else footing.payload)
    return Chain(
        np.array(arm.links),
        np.array([arm.out, arm.up]),
        moment.links,
        np.array(arm.lowest),
        np.array(arm.highest),
        lowest,
        highest,
        speed,
    )


def freedom_names(robot: WalkerRobot) -> tuple[str, ...]:
    """Names of the freedoms."""
    return ("x", "y", "z", "alpha", "beta", "gamma", *(f"theta{k}" for k in range(robot.own_arm.n_joints)))


def limit_names(robot: WalkerRobot) -> tuple[str, ...]:
    """What each limit is called: ranges of the arm's joints and of the rows of `plate_bounds`, then speeds of freedoms and of rows."""
    freedoms = freedom_names(robot)
    ranges = (*(f"joint {k} of the arm" for k in range(len(freedoms) - POSE)), *ROW_NAMES)
    return (*ranges, *(f"speed of {name}" for name in (*freedoms, *ROW_NAMES)))
