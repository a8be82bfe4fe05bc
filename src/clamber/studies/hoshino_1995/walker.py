"""The paper's robot, as its file states it."""

from ...robots.library import load_robot
from ...robots.walker import WalkerRobot

MM = 1e3
CM2 = 1e4
ANGLES = tuple(range(-17, 48))
"""Angles of the frames to each other that are looked at [deg]."""


def hoshino() -> WalkerRobot:
    """The robot."""
    robot = load_robot("hoshino")
    assert isinstance(robot, WalkerRobot)
    return robot
