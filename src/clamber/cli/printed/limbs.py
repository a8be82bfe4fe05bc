"""What the commands of `limb` print that compare laws."""

from typing import Any, TypeAlias

from pydantic import Field

from .base import Count, Pair, Printed
from .meanings import means_as

Properties: TypeAlias = dict[str, Any]
"""Name to value, SI units and radians; which names there are is up to the law or the plant."""


class Limb(Printed):
    """The limb on the bench."""

    robot: str
    name: str
    start: Pair
    """Place of the tip at the start, port frame [m]."""
    angles: Pair
    """Joint angles there [rad]."""


class Scenario(Printed):
    """What the tip was to do."""

    kind: str
    """step, circle or push."""
    seconds: float
    direction: Pair
    lap: float | None
    """Time of a lap of the circle [s]."""
    centre: Pair | None
    radius: float | None
    aim: Pair
    """Place of the tip that was asked for at the end [m]."""


class Matching(Printed):
    """Which gains were made alike."""

    how: str
    """yy, mean, diagonal or none."""
    reference: Properties
    """Settings of the law that the others are matched to."""
    at: list[float]
    """Joint angles at which it was done [rad]."""
    not_matched: list[str]
    """Laws that were to be matched and cannot be: those with one gain for all directions."""


@means_as("limb_bench/measures.py:TipMeasures")
class TipErrors(Printed):
    """Errors of the tip; a measure that the scenario does not have is missing, one that never came is null."""

    across_max: float | None = None
    across_rms: float | None = None
    along_max: float | None = None
    radial_rms: float | None = None
    radial_max: float | None = None
    lag: float | None = None
    overshoot: float | None = None
    settling: float | None = None
    on_aim: float | None = None
    rest: float | None = None
    iae: float | None = None
    cycle: float | None = None


@means_as("limb_bench/measures.py:Measures")
class Figures(Printed):
    """Mean or worst of the trials."""

    true: TipErrors
    encoder: TipErrors
    work: float | None
    heat: float | None
    saturated: float | None
    tick: float | None


@means_as("limb_bench/measures.py:Measures")
class Measured(Figures):
    """What one run of one law gave."""

    unstable_at: float | None


class LawRun(Printed):
    """One law."""

    label: str
    settings: Properties
    own_gains: bool
    """Whether its gains were given, rather than matched."""
    stiffness: list[list[float]]
    """Of the tip at the start [N/m]."""
    unstable_trials: Count
    mean: Figures
    worst: Figures
    trials: list[Measured]


class Contest(Printed):
    """Laws compared on a limb."""

    file_schema: str = Field(alias="schema")
    scenario: Scenario
    limb: Limb
    plant: Properties
    match: Matching
    beyond_limits: dict[str, float]
    """Joints that any stable law turned beyond the limits of the robot's file, and how far [rad]."""
    seed: int | None
    trials: Count
    laws: list[LawRun]


class Stray(Printed):
    """How far a tip strayed from the line of the force."""

    after: float
    """Way of the tip [m]."""
    stray: float | None
    """[rad]; null where the tip never got so far."""


class Transform(Printed):
    """One way from a force at the tip to torques."""

    law: str
    torques: list[float]
    """[N m]."""
    turned: float | None
    """Direction in which the tip began to move, from that of the force [rad]."""
    predicted: float | None
    """The same by the inertias alone [rad]."""
    strays: list[Stray]
    moved: float
    """Way of the tip [m]."""


class OpenLoop(Printed):
    """A constant force at the tip without feedback."""

    file_schema: str = Field(alias="schema")
    limb: Limb
    plant: Properties
    force: float
    """[N]."""
    direction: float
    """[rad]."""
    renewed: bool
    """Whether torques were computed anew at every tick."""
    first: float
    """Way over which the first direction is taken [m]."""
    transforms: list[Transform]


class BenchedLimb(Printed):
    """The limb on the bench."""

    robot: str
    name: str
    start: Pair


@means_as("limb_bench/measures.py:ForceMeasures")
class ForceErrors(Printed):
    """What one law did to a wall. Errors are actual less wanted force; null where it left the finite numbers."""

    mean_error: float | None
    worst_standing: float | None
    worst_sliding: float | None
    worst: float | None
    contact: float | None
    held: bool
    bounces: int
    peak: float | None
    off_line: float | None
    work: float | None


class ForceLaw(ForceErrors):
    """One law."""

    label: str
    settings: Properties


class Forces(Printed):
    """Laws that press on a wall; exit code 1 where none holds the force."""

    file_schema: str = Field(alias="schema")
    task: Properties
    limb: BenchedLimb
    plant: Properties
    held: bool
    """Whether any law held the force."""
    laws: list[ForceLaw]


class Portrait(Printed):
    """What one law does."""

    law: str
    settings: Properties
    stiffness: list[list[float]]
    """Of the tip at the start [N/m]."""
    figures: dict[str, dict[str, float | None]]
    """Scenario to plant (ideal, nominal) to its figure, SI units."""
    forces: dict[str, dict[str, ForceErrors]]
    """Plant to way of dealing with friction to what the law did to a wall; empty for laws without force control."""


class Portraits(Printed):
    """Laws, each with what it does."""

    file_schema: str = Field(alias="schema")
    seed: int
    laws: list[Portrait]


class SweepAxis(Printed):
    """What varies."""

    key: str
    unit: str
    values: list[str]
    numbers: list[float] | None


@means_as("limb_bench/sweep.py:Boundary")
class Boundary(Printed):
    """Where one law changes from steady to not, along one axis."""

    label: str
    key: str
    at: float
    beside: float | None
    steady_below: bool


class Cell(Printed):
    """What one law did at one point."""

    value: float | None
    """The measure, in SI; null where it never came or the run was lost."""
    peak_to_peak: float | None
    """Of the true tip in the second half of the rest [m]."""
    steady: bool


class SweepPoint(Printed):
    """One point."""

    values: dict[str, Any]
    """Key to value."""
    winner: str | None
    """The steady law with the least measure."""
    laws: dict[str, Cell]


class LimbSweep(Printed):
    """Laws compared over one or two properties."""

    file_schema: str = Field(alias="schema")
    bench: Properties
    """What is the same at every point."""
    axes: list[SweepAxis]
    laws: list[str]
    wins: dict[str, int]
    """Law to points that it wins."""
    scan: str | None
    """Axis along which boundaries were looked for."""
    boundaries: list[Boundary]
    points: list[SweepPoint]


@means_as("limb_bench/tune.py:Edge")
class Edge(Printed):
    """Where a law stops coming to rest, at one damping time."""

    damping_time: float
    kp: float
    beyond: float
    linear_kp: float
    situation: str
    overshoot: float


@means_as("limb_bench/tune.py:Tuned")
class TunedLaw(Printed):
    """What was found for one law."""

    law: str
    edges: list[Edge]
    damping_time: float
    limit_kp: float
    linear_kp: float
    kp: float
    kd: float
    stiffness: Pair
    peak_to_peak: float
    situation: str
    lower: float
    overshoot: float
    iae: float
    steady: bool


class Tuned(Printed):
    """Gains for a limb; exit code 1 where a law is not steady with them."""

    robot: str
    limb: str
    start: Pair
    plant: Properties
    margin: float
    threshold: float
    """Peak to peak below which a tip counts as steady [m]."""
    laws: list[TunedLaw]


class Recorded(Printed):
    """A log that was written."""

    file: str
    rows: Count
    seconds: float
    columns: list[str]
    notes: dict[str, str]
