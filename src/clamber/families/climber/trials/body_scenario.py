"""What is asked of a body: a circle, a push-up, or to stand still while something pushes it."""

import math
from dataclasses import dataclass
from typing import Final, Literal, TypeAlias

import numpy as np

from ....sim.plant_rules import PlantError
from ....types import Floats

Kind: TypeAlias = Literal["circle", "push-up", "push"]
SETTLE: Final = 1.0
"""Time in which the body comes to rest at its start before anything is asked of it [s]."""


@dataclass(frozen=True, slots=True, eq=False)
class BodyScenario:
    """The aim of every tick, and the force on the body."""

    kind: Kind
    period: float
    """[s]."""
    aims: Floats
    """Body x, y [m], theta [rad], shape (ticks, 3)."""
    speeds: Floats
    """Of the aims, shape (ticks, 3)."""
    pushes: Floats
    """At the body's centre, world frame, shape (ticks, 2) [N]."""
    begin: int
    """First tick that is measured."""
    centre: tuple[float, float] | None = None
    """Of a circle [m]."""
    radius: float = 0.0

    @property
    def time(self) -> Floats:
        """Of each tick; 0 where the measured part begins [s]."""
        out: Floats = self.period * np.arange(-self.begin, len(self.aims) - self.begin, dtype=np.float64)
        return out


def circle(pose: Floats, period: float, *, radius: float, lap: float, laps: int = 2) -> BodyScenario:
    """Laps of a circle whose lowest point is the pose, the angle held; the last lap is measured.

    Args:
        pose: Of the body at the start, shape (3,).
        period: Of the control [s].
        radius: Of the circle [m].
        lap: Time of one lap [s].
        laps: How many.

    Raises:
        PlantError: If radius or lap is not more than nothing.
    """
    for key, value in (("radius", radius), ("lap", lap)):
        if not 0.0 < value < math.inf:
            raise PlantError(key, value, "must be more than 0")
    count, wait = round(laps * lap / period), round(SETTLE / period)
    phase = 2 * np.pi / lap * period * np.arange(1, count + 1)
    aims = np.tile(pose, (wait + count, 1))
    speeds = np.zeros_like(aims)
    aims[wait:, 0] += radius * np.sin(phase)
    aims[wait:, 1] += radius * (1.0 - np.cos(phase))
    rate = 2 * np.pi / lap * radius
    speeds[wait:, 0], speeds[wait:, 1] = rate * np.cos(phase), rate * np.sin(phase)
    begin = wait + round((laps - 1) * lap / period)
    middle = (float(pose[0]), float(pose[1]) + radius)
    return BodyScenario("circle", period, aims, speeds, np.zeros((len(aims), 2)), begin, middle, radius)


def push_up(pose: Floats, period: float, *, height: float, seconds: float, after: float = 1.5) -> BodyScenario:
    """Straight up, from rest to rest.

    Args:
        pose: Of the body at the start.
        period: Of the control [s].
        height: How far up [m].
        seconds: In that time.
        after: Time that is kept after it [s].

    Raises:
        PlantError: If it takes no time.
    """
    if not 0.0 < seconds < math.inf:
        raise PlantError("seconds", seconds, "must be more than 0 s")
    wait, count, rest = round(SETTLE / period), round(seconds / period), round(after / period)
    u = np.concatenate((np.zeros(wait), np.arange(1, count + 1) / count, np.ones(rest)))
    aims = np.tile(pose, (len(u), 1))
    speeds = np.zeros_like(aims)
    aims[:, 1] += height * u * u * (3 - 2 * u)
    speeds[:, 1] = height * 6 * u * (1 - u) / seconds
    return BodyScenario("push-up", period, aims, speeds, np.zeros((len(aims), 2)), wait)


def push(
    pose: Floats,
    period: float,
    *,
    force: tuple[float, float],
    seconds: float,
    half_sine: bool = True,
    after: float = 2.5,
) -> BodyScenario:
    """Standing still, pushed at the body's centre.

    Args:
        pose: Of the body.
        period: Of the control [s].
        force: Largest, world frame [N].
        seconds: How long it acts.
        half_sine: Whether it grows and goes as half a sine; else it grows and goes over a fifth of the time and is full between.
        after: Time that is kept after it [s].

    Raises:
        PlantError: If it acts for no time.
    """
    if not 0.0 < seconds < math.inf:
        raise PlantError("seconds", seconds, "must be more than 0 s")
    wait, count, rest = round(SETTLE / period), round(seconds / period), round(after / period)
    u = (np.arange(count) + 0.5) / count
    shape = np.sin(np.pi * u) if half_sine else np.minimum(1.0, np.minimum(5 * u, 5 * (1 - u)))
    pushes = np.zeros((wait + count + rest, 2))
    pushes[wait : wait + count] = shape[:, None] * np.array(force)
    aims = np.tile(pose, (len(pushes), 1))
    return BodyScenario("push", period, aims, np.zeros_like(aims), pushes, wait)
