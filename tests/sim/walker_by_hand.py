"""What tests of simulated walkers share: the robot, postures, and letting time pass."""

import math
from typing import Any

import numpy as np

from clamber.families.walker.robot import WalkerRobot
from clamber.families.walker.sim.walker_flaws import WalkerFlaws
from clamber.families.walker.sim.walker_plant import WalkerSim
from clamber.families.walker.world.ground import Ground
from clamber.tasks.robots import load_robot

LEVEL = Ground(name="level")
POSE = np.array((0.0, 0.0, 0.35, 0.0, 0.0, 0.0))


def hoshino() -> WalkerRobot:
    robot = load_robot("hoshino")
    assert isinstance(robot, WalkerRobot)
    return robot


def legs_with(lifted: int | None, by: float = 0.05, length: float = 0.35) -> np.ndarray:
    """Leg lengths of a robot whose frame `lifted` is off the ground; None: six feet stand."""
    legs = np.full((2, 3), length)
    if lifted is not None:
        legs[lifted] -= by
    return legs


def standing(
    place: tuple[float, float, float] = (0.0, 0.0, 0.0),
    *,
    lifted: int | None = None,
    ground: Ground = LEVEL,
    flaws: WalkerFlaws = WalkerFlaws(),  # noqa: B008  # frozen
    pose: np.ndarray = POSE,
    legs: np.ndarray | None = None,
    arm: tuple[float, ...] | None = None,
    **keys: Any,
) -> WalkerSim:
    """A walker that has been put down and has settled."""
    robot = hoshino()
    assert robot.arm is not None
    sim = WalkerSim(robot, ground, flaws, **keys)
    sim.reset(pose, np.array(place), legs_with(lifted) if legs is None else legs, np.array(arm or robot.arm.rest))
    return sim


def let_pass(sim: WalkerSim, seconds: float) -> None:
    for _ in range(round(seconds / sim.period)):
        sim.step()


def lengths(robot: WalkerRobot, place: np.ndarray) -> np.ndarray:
    """Of the actuators, written from the page of the walker's model."""
    on_delta, on_y = robot.attachments()
    c, s = math.cos(place[2]), math.sin(place[2])
    ways = on_y @ np.array(((c, s), (-s, c))) + place[:2] - on_delta
    return np.array([math.hypot(x, y) for x, y in ways])
