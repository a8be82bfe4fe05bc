"""What is asked of the limb: a step, a circle, a push, a force on a wall, as aims tick by tick. One command for every law."""

import math
from dataclasses import dataclass
from typing import Final, Literal

import numpy as np

from ..control.controller import still_aim
from ..errors import ClamberError
from ..sim.limb_flaws import LimbFlaws, Push, Wall
from ..types import Records
from .bench_limb import BenchLimb

LEAST_TICKS: Final = 2
"""A run has to have more: else there is nothing to measure."""


class ScenarioError(ClamberError):
    """A command that the limb cannot be given: names the scenario, the key, the value and what is allowed."""

    def __init__(self, scenario: str, key: str, value: object, allowed: str) -> None:
        super().__init__(scenario, key, value, allowed)
        self.scenario, self.key, self.value, self.allowed = scenario, key, value, allowed

    def __str__(self) -> str:
        return f"{self.scenario}: {self.key} = {self.value}: {self.allowed}"


@dataclass(frozen=True, slots=True, eq=False)
class Scenario:
    """A command for a limb from rest at its start, with what the surroundings do."""

    kind: Literal["step", "circle", "push", "force"]
    aims: Records
    """Records of `control.records.AIM`, shape (ticks, 1)."""
    settle: float
    """Measures of what lasts count from here [s]."""
    direction: tuple[float, float]
    """Unit vector along which the motion is asked for; what happens across it is an error of coupling."""
    start: tuple[float, float] | None = None
    """Where the tip is at first [m]; None: where the limb is."""
    push: Push | None = None
    wall: Wall | None = None
    lap: float | None = None
    """Period of a circle [s]."""
    centre: tuple[float, float] | None = None
    radius: float | None = None

    def on(self, flaws: LimbFlaws) -> LimbFlaws:
        """The plant with the scenario's push and wall."""
        return flaws.with_changes(push=self.push, wall=self.wall)


def _ticks(kind: str, seconds: float, rate: float) -> int:
    if not 0.0 < seconds <= 600.0:
        raise ScenarioError(kind, "seconds", seconds, "must be more than 0 and at most 600 s")
    if not seconds * rate > LEAST_TICKS:
        raise ScenarioError(
            kind, "seconds", seconds, f"must be more than {LEAST_TICKS} control periods of {1.0 / rate:g} s"
        )
    return round(seconds * rate)


def _within_reach(kind: str, limb: BenchLimb, x: float, y: float) -> None:
    """By length alone: the thesis's own circle about (0.22, 0) asks for 5.6 deg more of the elbow than its printed limit."""
    least, most = abs(limb.spec.l1 - limb.spec.l2_effective), limb.spec.length
    target = f"({x:.6g}, {y:.6g}) m"
    if not least <= math.hypot(x, y) <= most:
        raise ScenarioError(kind, "target", target, f"must be {least:.3g} to {most:.3g} m from the limb's port")


def step_scenario(
    limb: BenchLimb, rate: float, *, dx: float = 0.0, dy: float = -0.02, seconds: float = 2.0
) -> Scenario:
    """The aim jumps by (dx, dy) at time 0 [m]; `rate` is the control's [Hz]."""
    length = math.hypot(dx, dy)
    if not length > 0.0:
        raise ScenarioError("step", "dx, dy", (dx, dy), "must not both be 0")
    x, y = limb.start[0] + dx, limb.start[1] + dy
    _within_reach("step", limb, x, y)
    aims = np.stack([still_aim((x, y))] * _ticks("step", seconds, rate))
    return Scenario("step", aims, settle=0.75 * seconds, direction=(dx / length, dy / length), start=limb.start)


def circle_scenario(
    limb: BenchLimb,
    rate: float,
    *,
    centre: tuple[float, float] = (0.22, 0.0),
    radius: float = 0.05,
    lap: float = 6.0,
    laps: int = 2,
) -> Scenario:
    """The aim runs anticlockwise round a circle from where the limb starts, which must lie on it; the last lap counts.

    The speed is even from the first tick on: a limb at rest is behind at first, in its first lap.
    """
    if not lap > 0.0 or laps < 1:
        raise ScenarioError("circle", "lap", lap, "must be more than 0 s, and at least one lap")
    if not radius > 0.0:
        raise ScenarioError("circle", "radius", radius, "must be more than 0 m")
    x0, y0 = limb.start[0] - centre[0], limb.start[1] - centre[1]
    if not abs(math.hypot(x0, y0) - radius) < 1e-6:
        start = f"({limb.start[0]:.6g}, {limb.start[1]:.6g}) m"
        raise ScenarioError("circle", "start", start, f"must lie on the circle of {radius:g} m about {centre}")
    for k in range(36):
        _within_reach(
            "circle",
            limb,
            centre[0] + radius * math.cos(k * math.tau / 36),
            centre[1] + radius * math.sin(k * math.tau / 36),
        )
    ticks = _ticks("circle", laps * lap, rate)
    aims = np.stack([still_aim((0.0, 0.0))] * ticks)
    turn = math.tau / lap
    angle = math.atan2(y0, x0) + turn * np.arange(ticks) / rate
    c, s = radius * np.cos(angle), radius * np.sin(angle)
    aims["place"][:, 0, 0], aims["place"][:, 0, 1] = centre[0] + c, centre[1] + s
    aims["twist"][:, 0, 0], aims["twist"][:, 0, 1] = -turn * s, turn * c
    aims["acceleration"][:, 0, 0], aims["acceleration"][:, 0, 1] = -(turn**2) * c, -(turn**2) * s
    return Scenario(
        "circle", aims, settle=(laps - 1) * lap, direction=(1.0, 0.0), lap=lap, centre=centre, radius=radius
    )


def push_scenario(
    limb: BenchLimb,
    rate: float,
    *,
    force: tuple[float, float] = (10.0, 0.0),
    start: float = 0.5,
    end: float = 2.0,
    seconds: float = 5.0,
) -> Scenario:
    """The aim stands still; a force pushes the tip from `start` to `end` [s] and lets it go."""
    size = math.hypot(*force)
    if not size > 0.0:
        raise ScenarioError("push", "force", force, "must not be 0 N")
    if not end < seconds:
        raise ScenarioError("push", "end", end, f"must come before the end of the run at {seconds:g} s")
    aims = np.stack([still_aim(limb.start)] * _ticks("push", seconds, rate))
    direction = (force[0] / size, force[1] / size)
    return Scenario(
        "push", aims, settle=end, direction=direction, push=Push(x=force[0], y=force[1], start=start, end=end)
    )
