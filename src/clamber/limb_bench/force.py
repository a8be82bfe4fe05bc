"""Force on a wall: laws with their ways to deal with joint friction, gains from the wall and the limb, and how well each held it."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass
from typing import Annotated, Any, Final

import numpy as np

from ..control.law_settings import LawSettings
from ..errors import UnknownNameError
from ..execution.trace import LimbTrace
from ..json_form import HIDDEN, INLINE, Jsonable, Key, in_json
from ..sim.bench_limb import BenchLimb
from ..sim.flaw_texts import plant_words
from ..sim.limb_flaws import LimbFlaws
from .measures import Entry, ForceMeasures, LabelledRun, Measured, measure_force
from .result import Comparison
from .runner import run_contest, with_sensors
from .scenario import ForceTask, Scenario, direction, force_scenario

SCHEMA: Final = "clamber-limb-force-1"

CONTROLLERS: Final = ("hybrid", "implicit-force", "admittance")
COMPENSATIONS: Final = ("none", "model", "integral", "wrist", "base", "wrist+model", "base+model")
"""Of joint friction: left alone; fed forward from the model; the integral of the force felt at the wrist; a torque loop on a sensor at the
wrist or the base, with that integral; the same with the friction of the motion asked for fed forward too."""
USUAL: Final = (
    ("hybrid", "none"),
    ("hybrid", "model"),
    ("hybrid", "integral"),
    ("hybrid", "wrist"),
    ("hybrid", "base"),
    ("hybrid", "base+model"),
    ("implicit-force", "none"),
    ("implicit-force", "model"),
    ("admittance", "none"),
    ("admittance", "wrist"),
    ("admittance", "wrist+model"),
)
"""Compared unless others are named."""
STEADY: Final = 0.4
"""Damping of a mass over it, and bandwidth of a torque loop, are at most this over the dead time."""
STIFF_ALONG: Final = 1e6
"""Damping with which an admittance yields along the wall: not at all, so to say [N s/m]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ForceGains:
    """Gains of force laws for one wall, pose and plant."""

    mass: float
    """Of limb and motors as the wall feels it, 1 / (n J M^-1 J^T n) [kg]."""
    damping: float
    """Into the wall: critical for that mass on the wall, but no more than the dead time allows [N s/m]."""
    torque_gain: float
    """Bandwidth of a torque loop [1/s]."""
    force_gain: float
    """Of the integral of force [1/s]: a small part of damping over mass, beyond which it is unstable (Routh)."""
    admittance_damping: float
    """So that the felt force follows with 20 per second, as fast as the joint servo [N s/m]."""


def force_gains(limb: BenchLimb, task: ForceTask, flaws: LimbFlaws) -> ForceGains:
    """Gains by the believed wall, the limb at its start, and the plant's dead time: its delay and one and a half periods."""
    jacobian = limb.chain.jacobian(limb.q0)[:2]
    into = direction(task.task_angle)
    mass = 1.0 / float(into @ jacobian @ np.linalg.solve(limb.chain.inertia(limb.q0), jacobian.T @ into))
    fastest = STEADY / ((1.5 + flaws.delay) * flaws.period)
    damping = min(2.0 * math.sqrt(task.task_stiffness * mass), fastest * mass)
    return ForceGains(
        mass=mass,
        damping=damping,
        torque_gain=fastest,
        force_gain=0.05 * damping / mass,
        admittance_damping=task.task_stiffness / 20.0,
    )


def force_settings(controller: str, compensation: str, gains: ForceGains, task: ForceTask) -> LawSettings:
    """A law of force with its way to deal with friction.

    Raises:
        UnknownNameError: If there is no such controller or compensation.
    """
    _check_names([controller], [compensation])
    common: dict[str, Any] = {"angle": task.task_angle, **_against_friction(controller, compensation, gains)}
    if controller == "hybrid":
        return LawSettings(law="hybrid", kp=200.0, kd=10.0, forced=("x",), force_damping=gains.damping, **common)
    if controller == "implicit-force":
        stiffness = task.task_stiffness
        return LawSettings(law="implicit-force", kp=200.0, kd=10.0, forced=("x",), environment=stiffness, **common)
    yielding = (gains.admittance_damping, STIFF_ALONG)
    return LawSettings(law="admittance", kp=400.0, kd=20.0, admittance_kd=yielding, **common)


def _check_names(controllers: Sequence[str], compensations: Sequence[str]) -> None:
    for kind, names, known in (
        ("controller", controllers, CONTROLLERS),
        ("compensation", compensations, COMPENSATIONS),
    ):
        for name in names:
            if name not in known:
                raise UnknownNameError(kind, name, known)


def _against_friction(controller: str, compensation: str, gains: ForceGains) -> dict[str, Any]:
    if compensation == "model":
        return {"feed_friction": 1.0, "friction_from": "last", "friction_speed": 0.008}
    # an integral alone has all the friction to learn, behind a torque loop only what that leaves
    if compensation == "integral":
        return {"force_gain": 3.0 * gains.force_gain}
    sensor, _, model = compensation.partition("+")
    if sensor in ("wrist", "base"):
        integral = {"force_gain": gains.force_gain} if controller == "hybrid" else {}
        moving = {"feed_friction": 1.0} if model else {}
        return {"torque_sensor": sensor, "torque_gain": gains.torque_gain, **integral, **moving}
    return {}


def force_entries(
    limb: BenchLimb,
    task: ForceTask,
    flaws: LimbFlaws,
    controllers: Sequence[str] = (),
    compensations: Sequence[str] = (),
) -> list[Entry]:
    """Entries of every named controller with every named compensation; the usual ones of those that are not named.

    Raises:
        UnknownNameError: If there is no such controller or compensation.
    """
    gains = force_gains(limb, task, flaws)
    _check_names(controllers, compensations)
    if compensations:
        pairs = [(law, way) for law in controllers or CONTROLLERS for way in compensations]
    else:
        pairs = [(law, way) for law, way in USUAL if not controllers or law in controllers]
    # only the hybrid law has an integral of force
    pairs = [(law, way) for law, way in pairs if law == "hybrid" or way != "integral"]
    return [Entry(f"{law} / {way}", force_settings(law, way, gains, task)) for law, way in pairs]


@dataclass(frozen=True, slots=True)
class LimbAtStart:
    """The limb on the bench."""

    robot: str
    name: str
    start: tuple[float, float]

    @classmethod
    def of(cls, limb: BenchLimb) -> "LimbAtStart":
        """Of a limb."""
        return cls(limb.robot.name, limb.name, limb.start)


@dataclass(frozen=True, slots=True, eq=False)
class ForceRow(Jsonable, Measured[ForceMeasures]):
    """One law on the wall."""

    run: LabelledRun
    measures: Annotated[ForceMeasures, INLINE]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ForceResult(Comparison):
    """Laws on the same wall, the same limb, the same command."""

    picture = "force:draw_force"
    schema: str = SCHEMA
    limb: Annotated[BenchLimb, Key(get=LimbAtStart.of, kind=LimbAtStart, after="task")]
    task: Annotated[ForceTask, Key(kind=dict[str, Any], after="schema")]
    scenario: Annotated[Scenario, HIDDEN]
    rows: Annotated[tuple[ForceRow, ...], Key("laws", after="held")]

    @in_json(after="limb", key="plant")
    def whole_plant(self) -> dict[str, Any]:
        """What is not ideal about it, with the wall."""
        return asdict(self.scenario.on(self.flaws))

    @property
    @in_json(after="plant")
    def held(self) -> bool:
        """Whether any law held the force."""
        return any(row.measures.held for row in self.rows)

    def title(self) -> str:
        """What was asked for, in a few words."""
        task = self.task
        slide = f", {1e2 * abs(task.slide):g} cm along it" if task.slide else ""
        return f"{task.force:g} N on a wall at {math.degrees(task.angle):g} deg of {task.stiffness / 1e3:g} N/mm{slide}"

    def plant_words(self) -> str:
        """The plant and what is not ideal about it, in one line."""
        wall = [f"wall friction {self.task.friction:g}"] if self.task.friction else []
        return ", ".join((plant_words(self.flaws), *wall))

    def belief_words(self) -> str:
        """What the laws are wrong about, in one line; empty if nothing."""
        task = self.task
        told = []
        if task.task_angle != task.angle:
            told.append(f"the angle is {math.degrees(task.task_angle):g} deg")
        if task.task_stiffness != task.stiffness:
            told.append(f"the stiffness is {task.task_stiffness / 1e3:g} N/mm")
        return f"the laws believe that {' and '.join(told)}" if told else ""

    def traces(self) -> Iterable[tuple[str, LimbTrace]]:
        """Of each law."""
        return ((row.entry.label, row.run.trace) for row in self.rows)


def run_force(limb: BenchLimb, task: ForceTask, entries: Sequence[Entry], flaws: LimbFlaws) -> ForceResult:
    """Run each entry alone on the wall.

    Raises:
        LawError: If settings do not fit the limb.
        ScenarioError: If the wall is out of reach.
    """
    sensing = with_sensors(flaws, entries)
    scenario = force_scenario(limb, flaws.control_rate, task)
    runs = run_contest(limb, scenario, entries, sensing)
    rows = tuple(ForceRow(run, measure_force(run, task)) for run in runs)
    return ForceResult(limb=limb, flaws=sensing, task=task, scenario=scenario, rows=rows)
