"""What is asked of the limb: a step, a circle, a push, a force on a wall, as aims tick by tick. One command for every law."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Annotated, Final, Literal, TypeAlias

import numpy as np
import numpy.typing as npt

from ..control.controller import still_aim
from ..errors import StatedError
from ..json_form import HIDDEN, Jsonable, Key, in_json
from ..sim.bench_limb import BenchLimb
from ..sim.limb_flaws import LimbFlaws, Push, Wall
from ..types import Floats, Records

LEAST_TICKS: Final = 2
"""A run has to have more: else there is nothing to measure."""
SETTLE: Final = 0.5
"""Time that a law has after the force has risen, before it is judged [s]."""
TURN: Final = 0.3
"""What lies this near to the start or end of the slide counts neither as standing nor as sliding [s]."""


class ScenarioError(StatedError):
    """A command that the limb cannot be given: names the scenario, the key, the value and what is allowed."""

    says = "{scenario}: {key} = {value}: {allowed}"
    scenario: str
    key: str
    value: object
    allowed: str


LAST: Final = "Place of the tip that is asked for at the end [m]."


def _last_place(aims: Records) -> list[float]:
    return [float(value) for value in aims["place"][-1, 0, :2]]


@dataclass(frozen=True, slots=True, eq=False)
class Scenario(Jsonable):
    """A command for a limb from rest at its start, with what the surroundings do."""

    kind: Literal["step", "circle", "push", "force"]
    period: Annotated[float, HIDDEN]
    """Of the control [s]."""
    aims: Annotated[Records, Key("aim", get=_last_place, kind=tuple[float, float], meaning=LAST, after="radius")]
    """Records of `control.records.AIM`, shape (ticks, 1)."""
    settle: Annotated[float, HIDDEN]
    """Measures of what lasts count from here [s]."""
    direction: tuple[float, float]
    """Unit vector along which the motion is asked for; what happens across it is an error of coupling."""
    start: Annotated[tuple[float, float] | None, HIDDEN] = None
    """Where the tip is at first [m]; None: where the limb is."""
    push: Annotated[Push | None, HIDDEN] = None
    wall: Annotated[Wall | None, HIDDEN] = None
    lap: float | None = None
    """Period of a circle [s]."""
    centre: tuple[float, float] | None = None
    radius: float | None = None

    @property
    @in_json(after="kind")
    def seconds(self) -> float:
        """How long it takes [s]."""
        return len(self.aims) * self.period

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
    least, most = limb.reach
    target = f"({x:.6g}, {y:.6g}) m"
    if not least <= math.hypot(x, y) <= most:
        raise ScenarioError(kind, "target", target, f"must be {least:.3g} to {most:.3g} m from the limb's port")


def left_of(vector: Floats) -> Floats:
    """A plane vector turned by 90 deg to its left, shape (2,)."""
    return np.array((-vector[1], vector[0]))


def direction(angle: float) -> Floats:
    """Unit vector at an angle from the x axis, shape (2,)."""
    return np.array((math.cos(angle), math.sin(angle)))


def rest_at(place: tuple[float, float], ticks: int) -> Records:
    """References that stand still at a place, shape (ticks, 1)."""
    return np.stack([still_aim(place)] * ticks)


def step_scenario(
    limb: BenchLimb, rate: float, *, dx: float = 0.0, dy: float = -0.02, seconds: float = 2.0
) -> Scenario:
    """The aim jumps by (dx, dy) at time 0 [m]; `rate` is the control's [Hz]."""
    length = math.hypot(dx, dy)
    if not length > 0.0:
        raise ScenarioError("step", "dx, dy", (dx, dy), "must not both be 0")
    x, y = limb.start[0] + dx, limb.start[1] + dy
    _within_reach("step", limb, x, y)
    aims = rest_at((x, y), _ticks("step", seconds, rate))
    return Scenario(
        "step", 1.0 / rate, aims, settle=0.75 * seconds, direction=(dx / length, dy / length), start=limb.start
    )


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
    aims = rest_at((0.0, 0.0), ticks)
    turn = math.tau / lap
    angle = math.atan2(y0, x0) + turn * np.arange(ticks) / rate
    c, s = radius * np.cos(angle), radius * np.sin(angle)
    aims["place"][:, 0, 0], aims["place"][:, 0, 1] = centre[0] + c, centre[1] + s
    aims["twist"][:, 0, 0], aims["twist"][:, 0, 1] = -turn * s, turn * c
    aims["acceleration"][:, 0, 0], aims["acceleration"][:, 0, 1] = -(turn**2) * c, -(turn**2) * s
    return Scenario(
        "circle", 1.0 / rate, aims, settle=(laps - 1) * lap, direction=(1.0, 0.0), lap=lap, centre=centre, radius=radius
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
    aims = rest_at(limb.start, _ticks("push", seconds, rate))
    direction = (force[0] / size, force[1] / size)
    return Scenario(
        "push",
        1.0 / rate,
        aims,
        settle=end,
        direction=direction,
        push=Push(x=force[0], y=force[1], start=start, end=end),
    )


MotionKind: TypeAlias = Literal["step", "circle", "push"]
MOTIONS: Final[dict[MotionKind, Callable[..., Scenario]]] = {
    "step": step_scenario,
    "circle": circle_scenario,
    "push": push_scenario,
}
"""Scenarios that ask for a motion by name."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ForceTask:
    """How hard, on which wall, and when. What the laws believe of the wall may differ from what it is."""

    force: float = 20.0
    """Into the wall [N]."""
    angle: float = math.pi / 2
    """Direction into the wall, from the x axis of the limb's port frame [rad]."""
    stiffness: float = 10_000.0
    """Of the wall [N/m]."""
    damping: float = 20.0
    """Of the wall [N s/m]."""
    friction: float = 0.0
    """Friction coefficient of the wall's surface [-]."""
    believed_angle: float | None = None
    """What the laws take for the angle [rad]; None: the truth."""
    believed_stiffness: float | None = None
    """What they take for the stiffness [N/m]; None: the truth."""
    slide: float = 0.03
    """Way along the wall at full force, positive to the left of the direction into it [m]."""
    gap: float = 0.002
    """From the start to the wall [m]."""
    touch: float = 0.4
    """Part of the force that the limb touches the wall with [-]."""
    tolerance: float = 1.0
    """Largest error of a force that counts as held [N]."""
    approach: float = 1.0
    """Time to come to the wall [s]."""
    rise: float = 1.0
    """Time in which the force rises to its full size [s]."""
    stand: float = 2.0
    """Time to stand before and after the slide [s]."""
    sliding: float = 2.0
    """Time of the slide [s]."""

    def __post_init__(self) -> None:
        for key in ("force", "stiffness", "tolerance", "approach", "rise", "sliding"):
            self._demand(key, 0.0 < getattr(self, key) < math.inf, "must be more than 0, and finite")
        for key in ("gap", "damping", "friction"):
            self._demand(key, 0.0 <= getattr(self, key) < math.inf, "must be 0 or more, and finite")
        for key in ("angle", "slide"):
            self._demand(key, math.isfinite(getattr(self, key)), "must be a finite number")
        self._demand("stand", SETTLE + TURN < self.stand < math.inf, f"must be more than {SETTLE + TURN:g} s")
        self._demand("touch", 0.0 < self.touch <= 1.0, "must be more than 0 and at most 1")
        believed = self.believed_angle
        self._demand("believed_angle", believed is None or math.isfinite(believed), "must be a finite number")
        stiff = self.believed_stiffness
        self._demand("believed_stiffness", stiff is None or 0.0 < stiff < math.inf, "must be more than 0 N/m")

    def _demand(self, key: str, fine: bool, allowed: str) -> None:
        if not fine:
            raise ScenarioError("force", key, getattr(self, key), allowed)

    @property
    def task_angle(self) -> float:
        """Angle of the wall as the laws believe it [rad]."""
        return self.angle if self.believed_angle is None else self.believed_angle

    @property
    def task_stiffness(self) -> float:
        """Stiffness of the wall as the laws believe it [N/m]."""
        return self.stiffness if self.believed_stiffness is None else self.believed_stiffness

    @property
    def slide_from(self) -> float:
        """When the slide begins [s]."""
        return self.approach + self.rise + self.stand

    @property
    def seconds(self) -> float:
        """Length of the run [s]."""
        return self.slide_from + self.sliding + self.stand

    def wall(self, limb: BenchLimb) -> Wall:
        """The wall, its untouched surface `gap` before the limb's tip."""
        x, y = np.array(limb.start) + self.gap * direction(self.angle)
        return Wall(
            x=float(x),
            y=float(y),
            angle=self.angle,
            stiffness=self.stiffness,
            damping=self.damping,
            friction=self.friction,
        )

    def judged(self, time: Floats) -> tuple[npt.NDArray[np.bool_], npt.NDArray[np.bool_]]:
        """Which ticks count as standing and which as sliding, shape (ticks,) each; together with the turns between all after `SETTLE`."""
        begin, end = self.slide_from, self.slide_from + self.sliding
        still = ((time >= self.approach + self.rise + SETTLE) & (time < begin)) | (time >= end + TURN)
        return still, (time >= begin + TURN) & (time < end - TURN) & (self.slide != 0.0)


def force_scenario(limb: BenchLimb, rate: float, task: ForceTask) -> Scenario:
    """The command of a force task, by what the laws believe of the wall; `rate` is the control's [Hz].

    The aim moves from the start to the wall's surface and, later, along it with a smooth start and end. Its wrench is the force; while that
    rises, its speed into the wall is that at which the wall gives way.

    Raises:
        ScenarioError: If the wall is out of the limb's reach.
    """
    if not task.seconds <= 600.0:
        raise ScenarioError("force", "seconds", task.seconds, "must be at most 600 s in all")
    time = np.arange(max(1, round(task.seconds * rate))) / rate
    into = direction(task.task_angle)
    along = left_of(into)
    near = np.clip(time / task.approach, 0.0, 1.0)
    risen = np.clip((time - task.approach) / task.rise, 0.0, 1.0)
    growth = (1.0 - task.touch) * task.force
    size = task.touch * task.force + growth * _smooth(risen)
    part = np.clip((time - task.slide_from) / task.sliding, 0.0, 1.0)
    aims = rest_at(limb.start, len(time))
    places = np.outer(task.gap * near, into) + np.outer(task.slide * _smooth(part), along)
    speeds = np.outer(task.gap / task.approach * (near < 1.0), into)
    speeds += np.outer(growth / task.task_stiffness / task.rise * _smooth_rate(risen), into)
    speeds += np.outer(task.slide / task.sliding * _smooth_rate(part), along)
    change = np.outer(task.slide / task.sliding**2 * (6.0 - 12.0 * part) * ((part > 0.0) & (part < 1.0)), along)
    aims["place"][:, 0, :2] += places
    aims["twist"][:, 0, :2], aims["acceleration"][:, 0, :2] = speeds, change
    aims["wrench"][:, 0, :2] = np.outer(size, into)
    _check_reach(limb, task)
    x, y = left_of(direction(task.angle))
    settle = task.approach + task.rise + SETTLE
    return Scenario("force", 1.0 / rate, aims, settle=settle, direction=(float(x), float(y)), wall=task.wall(limb))


def _smooth(part: Floats) -> Floats:
    """From 0 to 1 with speed 0 at both ends."""
    return part * part * (3.0 - 2.0 * part)


def _smooth_rate(part: Floats) -> Floats:
    return 6.0 * part * (1.0 - part)


def _check_reach(limb: BenchLimb, task: ForceTask) -> None:
    into = direction(task.angle)
    depth = task.gap + task.force / task.stiffness
    least, most = limb.reach[0], 0.98 * limb.reach[1]
    for part in np.linspace(0.0, task.slide, 16):
        place = np.array(limb.start) + depth * into + part * left_of(into)
        if not least < float(np.hypot(*place)) < most:
            allowed = f"pressed in, the tip must stay {least:.3g} to {most:.3g} m from the limb's port"
            raise ScenarioError("force", "wall", f"({place[0]:.3g}, {place[1]:.3g}) m", allowed)
