"""Walkers on springs, ready to move: what the tests of walks share."""

import math
from typing import Any

import numpy as np
from springs_walker import Ground, SpringsWalker, flat

from clamber.families.walker.control.posture import tilt_of
from clamber.families.walker.execution.settings import WalkSettings
from clamber.families.walker.execution.walk_trace import TracedWalker
from clamber.families.walker.robot import WalkerRobot
from clamber.tasks.robots import load_robot

found = load_robot("hoshino")
assert isinstance(found, WalkerRobot)
ROBOT = found
RADIUS = ROBOT.legs.radius_delta
NOISE = math.radians(0.05)
BEST = math.radians(90.0)
"""A direction of the longest steps."""


def stood(
    ground: Ground = flat, *, tilt: float = 0.0, uphill: float = 0.0, payload: float = 0.0, arm: Any = None,
    settings: WalkSettings = WalkSettings(), seed: int = 0, every: int = 5, **options: Any,  # noqa: B008  # frozen
) -> tuple[TracedWalker, SpringsWalker]:  # fmt: skip
    """A walker that stands on six equal legs, its plate tilted [rad]."""
    plant = SpringsWalker(ROBOT, ground, payload=payload, seed=seed, **({"noise": NOISE} | options))
    walker = TracedWalker(ROBOT, plant, settings=settings, payload=payload, every=every)
    beta, gamma = tilt_of(uphill, tilt)
    pose = np.array((0.0, 0.0, 0.36, 0.0, beta, gamma))
    walker.start(pose, np.zeros(3), np.full(6, 0.35), arm)
    return walker, plant
