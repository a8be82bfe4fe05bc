"""How well a law did: errors of the tip in truth and as its encoders tell, what it cost, and whether it stayed stable."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from operator import attrgetter
from typing import Annotated, Any, Final, Generic, TypeAlias, TypeVar

import numpy as np

from ..control.law_settings import LawSettings
from ..execution.trace import LimbTrace
from ..json_form import Jsonable, Key, OrNull
from ..sim.bench_limb import BenchLimb
from ..types import Floats
from .scenario import ForceTask, Scenario, direction, left_of

M = TypeVar("M")
BAND: Final = 0.02
"""Settled is who stays within this part of the motion asked for."""
CYCLE_FROM: Final = 5.0
"""A limit cycle is looked for after this time [s]."""
BEYOND: Final = math.radians(20.0)
"""A joint this far beyond its limits has run away: a real one would have hit its stop [rad]."""
WINDOWS: Final = 8
"""Parts of a run in which its swing is looked at, at most."""
SWING: Final = 0.5
"""Shortest such part [s]: it has to hold a swing of the limb."""
NEVER: Final = math.inf
"""In place of a time that never came."""
MayBeMissing: TypeAlias = Annotated[float | None, Key(may_be_missing=True)]
"""A measure that not every scenario has; in JSON null is a time that never came."""


UNITS: Final[dict[str, tuple[float, str]]] = {
    "lag": (math.degrees(1.0), "deg"),
    "overshoot": (100.0, "%"),
    "settling": (1.0, "s"),
    "on_aim": (1.0, "s"),
    "iae": (1e3, "mm s"),
    "work": (1.0, "J"),
    "heat": (1.0, "J"),
    "saturated": (100.0, "%"),
    "tick": (1e6, "us"),
}
"""Measure -> what it is multiplied by to be shown, and its unit then; all others are lengths, shown in mm."""


def measure_scale(name: str) -> tuple[float, str]:
    """What a measure such as "encoder.rest" is multiplied by to be shown, and its unit then."""
    return UNITS.get(name.rpartition(".")[2], (1e3, "mm"))


@dataclass(frozen=True, slots=True)
class Entry:
    """One law in a contest, under a label."""

    label: str
    settings: LawSettings
    own_gains: bool = True
    """Whether its gains are as stated for it, not matched to a reference."""


@dataclass(frozen=True, slots=True, eq=False)
class Run:
    """What one entry did."""

    entry: Entry
    trace: LimbTrace
    tick_seconds: float
    """Of one call of the controller from Python, on this machine [s]."""

    @property
    def period(self) -> float:
        """Of the control [s]; 0 for a single tick."""
        return float(self.trace.time[1] - self.trace.time[0]) if len(self.trace.time) > 1 else 0.0

    def force_into(self, angle: float) -> Floats:
        """True force in a direction from the x axis, tick by tick, shape (ticks,) [N]."""
        force: Floats = self.trace.wrenches[:, 0, :2] @ direction(angle)
        return force

    def work(self) -> float:
        """Sum of what each motor gives or brakes, |torque x turn| [J]."""
        turned = np.diff(self.trace.true[:, 0, 0], axis=0)
        return float(np.abs(self.trace.applied[:-1, 0] * turned).sum())


LabelledRun: TypeAlias = Annotated[
    Run,
    Key("label", get=attrgetter("entry.label"), kind=str),
    Key("settings", get=attrgetter("entry.settings"), kind=dict[str, Any], meaning="Of the law, SI units and radians."),
]


@dataclass(frozen=True, slots=True, kw_only=True)
class TipMeasures(Jsonable):
    """Errors of the tip; None where a scenario has no such measure."""

    across_max: MayBeMissing = None
    """Largest distance from the line of the step or the push [m]."""
    across_rms: MayBeMissing = None
    """The same, root of the mean square over the run [m]."""
    along_max: MayBeMissing = None
    """Largest yielding along a push [m]."""
    radial_rms: MayBeMissing = None
    """Of the distance from a circle, last lap [m]."""
    radial_max: MayBeMissing = None
    """Largest distance from a circle, last lap [m]."""
    lag: MayBeMissing = None
    """Mean angle behind the aim on a circle, last lap [rad]."""
    overshoot: MayBeMissing = None
    """Beyond the aim of a step, over its length [-]."""
    settling: MayBeMissing = None
    """Until the tip stays within 2 % of where it comes to rest, from the step or the end of the push [s]; inf: never."""
    on_aim: MayBeMissing = None
    """Until it stays within 2 % of the aim itself [s]; inf: never."""
    rest: MayBeMissing = None
    """Distance from the aim over the last tenth of the run, mean [m]."""
    iae: MayBeMissing = None
    """Integral of the distance from the aim [m s]."""
    cycle: MayBeMissing = None
    """Peak to peak of x or y after 5 s, the larger, where the aim stands still so long [m]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Figures(Jsonable):
    """What the tip did, and what it cost: of one run, or the mean or worst of several."""

    true: TipMeasures
    """By the true joint angles."""
    encoder: TipMeasures
    """By what the encoders told, delay included."""
    work: OrNull
    """Sum of what each motor gives or brakes, |torque x turn|, turned at the gear's output, rattle in the play included [J]."""
    heat: OrNull
    """Lost in the windings, (torque / (N k_t))^2 R [J]; no other loss is known."""
    saturated: OrNull
    """Share of ticks with a joint at its motor's limit [-]."""
    tick: OrNull
    """Of one call from Python, measured on this machine: no two runs give the same [s]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Measures(Figures):
    """What one run of one law gave."""

    unstable_at: float | None = None
    """When the run left what can be called control [s]; its other measures say nothing then."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ForceMeasures(Jsonable):
    """What one law did to the wall, by the true force, after it had time to settle. Errors are actual less wanted force."""

    mean_error: OrNull
    """[N]."""
    worst_standing: OrNull
    """Largest size of the error before and after the slide [N]."""
    worst_sliding: OrNull
    """Largest size of the error during the slide; 0 without one [N]."""
    worst: OrNull
    """Largest size of all, where the slide starts and ends too [N]."""
    contact: OrNull
    """Share of ticks with the tip on the wall [-]."""
    held: bool
    """Whether the tip never left the wall and no error was beyond the tolerance."""
    bounces: int
    """How often the tip left the wall before that."""
    peak: OrNull
    """Largest force of the whole run, with the impact at the start [N]."""
    off_line: OrNull
    """Largest error of the place along the wall, in truth [m]."""
    work: OrNull
    """Sum of what each motor gives or brakes, |torque x turn| [J]."""


@dataclass(frozen=True, slots=True, eq=False)
class Measured(Generic[M]):
    """One run of one law, with its measures."""

    run: LabelledRun
    measures: M

    @property
    def entry(self) -> Entry:
        """The law."""
        return self.run.entry


def measure(run: Run, scenario: Scenario, limb: BenchLimb) -> Measures:
    """Measures of a run; the heat is that of the limb's motors."""
    trace = run.trace
    true, told = TipMeasures(), TipMeasures()
    if np.isfinite(trace.true[:, 0]).all():
        true = tip_measures(trace.true_places()[:, 0, :2], run, scenario)
        told = tip_measures(trace.sensed_places()[:, 0, :2], run, scenario)
    return Measures(
        true=true,
        encoder=told,
        work=run.work(),
        heat=_heat(run, limb),
        saturated=_saturated(trace),
        tick=run.tick_seconds,
        unstable_at=instability(trace, scenario),
    )


def tip_measures(tip: Floats, run: Run, scenario: Scenario) -> TipMeasures:
    """Measures of a path of the tip, shape (ticks, 2) [m]."""
    trace = run.trace
    error = tip - trace.wanted_places()[:, 0, :2]
    distance = np.hypot(error[:, 0], error[:, 1])
    common: dict[str, Any] = {"iae": float(distance.sum() * run.period)}
    if scenario.kind == "circle":
        return TipMeasures(**common, **_round_measures(tip, trace, scenario))
    if scenario.kind == "force":
        return TipMeasures(**common)
    along, across = components(error, scenario.direction)
    common |= {
        "across_max": float(np.abs(across).max()),
        "across_rms": float(np.sqrt(np.mean(across**2))),
        "rest": float(distance[_last_tenth(trace.time)].mean()),
    }
    late = trace.time >= CYCLE_FROM
    if trace.time[-1] >= CYCLE_FROM + 0.5:
        common["cycle"] = float(np.ptp(tip[late], axis=0).max())
    begin = 0.0
    size = scenario_size(trace, scenario)
    if scenario.push is not None:
        begin = scenario.push.end + scenario.push.rise
        common["along_max"] = float(np.abs(along).max())
        size = float(distance.max())
    else:
        common["overshoot"] = max(0.0, float(along.max()) / size)
    own = error - error[_last_tenth(trace.time)].mean(axis=0)
    common["settling"] = _settled(np.hypot(own[:, 0], own[:, 1]), trace.time, BAND * size, begin)
    common["on_aim"] = _settled(distance, trace.time, BAND * size, begin)
    return TipMeasures(**common)


def components(vectors: Floats, direction: Sequence[float] | Floats) -> tuple[Floats, Floats]:
    """Parts of plane vectors along a unit direction and across it, to its left."""
    x, y = direction
    return vectors @ np.array((x, y)), vectors @ np.array((-y, x))


def scenario_size(trace: LimbTrace, scenario: Scenario) -> float:
    """Size of the motion asked for [m]: the step's length, the circle's radius; 5 cm where none is asked for."""
    if scenario.kind == "circle":
        assert scenario.radius is not None
        return scenario.radius
    if scenario.kind == "step":
        start = trace.true_places()[0, 0, :2] if scenario.start is None else np.array(scenario.start)
        return float(np.linalg.norm(trace.wanted_places()[-1, 0, :2] - start))
    return 0.05


def radial_error(tip: Floats, scenario: Scenario) -> Floats:
    """Distance of each place from the circle, outwards positive, shape (ticks,) [m]."""
    assert scenario.centre is not None and scenario.radius is not None
    arm = tip - np.array(scenario.centre)
    out: Floats = np.hypot(arm[:, 0], arm[:, 1]) - scenario.radius
    return out


def _round_measures(tip: Floats, trace: LimbTrace, scenario: Scenario) -> dict[str, float]:
    lap = trace.time >= scenario.settle
    off = radial_error(tip, scenario)[lap]
    centre = np.array(scenario.centre)
    places = tip[lap] - centre
    wanted = trace.wanted_places()[lap, 0, :2] - centre
    behind = np.angle((wanted @ (1, 1j)) / (places @ (1, 1j)))
    return {
        "radial_rms": float(np.sqrt(np.mean(off**2))),
        "radial_max": float(np.abs(off).max()),
        "lag": float(behind.mean()),
    }


def _last_tenth(time: Floats) -> slice:
    return slice(-max(1, len(time) // 10), None)


def _settled(distance: Floats, time: Floats, band: float, begin: float) -> float:
    """Seconds from `begin` until a distance stays within a band; inf if it leaves it in the last tenth."""
    outside = np.flatnonzero(distance > band)
    if outside.size == 0 or time[outside[-1]] < begin:
        return 0.0
    last = int(outside[-1])
    if last >= len(time) - max(1, len(time) // 10):
        return NEVER
    return float(time[last + 1] - begin)


def instability(trace: LimbTrace, scenario: Scenario) -> float | None:
    """When a run went unstable [s], or None.

    A run is unstable where a number is not finite, where a joint is 20 deg beyond its limits, or where the tip swings by more than the
    motion that was asked for, peak to peak, in every window of the last quarter; then from the first window after the last calm one.
    """
    states = trace.true[:, 0]
    lost = ~np.isfinite(states).all(axis=(1, 2))
    angles = np.where(np.isfinite(states[:, 0]), states[:, 0], 0.0)
    joints = trace.chain.joints
    gone = ((angles < joints["lower"] - BEYOND) | (angles > joints["upper"] + BEYOND)).any(axis=1) | lost
    if gone.any():
        return float(trace.time[int(np.argmax(gone))])
    error = (trace.true_places() - trace.wanted_places())[:, 0, :2]
    distance = np.hypot(error[:, 0], error[:, 1])
    size = scenario_size(trace, scenario)
    if scenario.push is not None:
        size = max(size, float(distance[trace.time <= scenario.push.end].max()))
    count = min(WINDOWS, max(2, int(len(trace.time) * trace.time[1] / SWING)))
    wild = [np.ptp(part, axis=0).max() > size for part in np.array_split(error, count)]
    if not all(wild[-max(1, count // 4) :]):
        return None
    calm = max((k for k in range(count) if not wild[k]), default=-1)
    return float(trace.time[round((calm + 1) * len(trace.time) / count)])


def _heat(run: Run, limb: BenchLimb) -> float:
    motor = limb.robot.motor
    currents = run.trace.applied[:, 0] / (limb.gears * motor.torque_constant)
    return float((currents**2).sum() * motor.resistance * run.period)


def _saturated(trace: LimbTrace) -> float:
    cut = (trace.applied[:, 0] != trace.commanded[:, 0]).any(axis=1)
    return float(np.mean(cut | (trace.reports["saturated"][:, 0] > 0)))


def measure_force(run: Run, task: ForceTask) -> ForceMeasures:
    """Measures of a run of `force_scenario`."""
    trace = run.trace
    force = run.force_into(task.angle)
    still, sliding = task.judged(trace.time)
    judged = trace.time >= trace.time[np.argmax(still)]
    error = force - task.force
    touching = force > 0.0
    off = (trace.true_places() - trace.wanted_places())[:, 0, :2] @ left_of(direction(task.angle))
    worst = float(np.abs(error[judged]).max())
    contact = float(touching[judged].mean())
    return ForceMeasures(
        mean_error=float(error[judged].mean()),
        worst_standing=float(np.abs(error[still]).max()),
        worst_sliding=float(np.abs(error[sliding]).max()) if sliding.any() else 0.0,
        worst=worst,
        contact=contact,
        held=bool(contact == 1.0 and worst <= task.tolerance),
        bounces=int((np.diff(touching[~judged].astype(int)) < 0).sum()),
        peak=float(force.max()),
        off_line=float(np.abs(off[judged]).max()),
        work=run.work(),
    )
