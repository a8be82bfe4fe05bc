"""The paper's robot, as its file states it, and its walks."""

from collections.abc import Sequence

from ...families.walker.planning import load_walk
from ...families.walker.robot import WalkerRobot
from ...families.walker.robot.robot import build_walker
from ...families.walker.trials.noise import WalkNoise
from ...families.walker.trials.run_walk import WalkRun, run_walk, walk_flaws
from ...tasks.robots import read_robot

MM = 1e3
CM2 = 1e4
ANGLES = tuple(range(-17, 48))
"""Angles of the frames to each other that are looked at [deg]."""


def hoshino() -> WalkerRobot:
    """The robot."""
    return build_walker(read_robot("hoshino"))


def known_noise() -> WalkNoise:
    """The usual noise but for the inclinometers' offset, which is known."""
    return WalkNoise.of("usual", ("inclinometer_offset=0deg",))


def run_changed(name: str, changes: Sequence[str], noise: WalkNoise, seed: int = 0) -> WalkRun:
    """A shipped walk with changes, each "key=value", carried out on its usual plant."""
    walk = load_walk(name, changes)
    return run_walk(walk, walk_flaws(walk, ()), noise=noise, seed=seed)
