"""What the commands of `limb` and `body` print."""

from typing import Any, TypeAlias

from pydantic import Field

from .base import Count, Pair, Printed

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


class TipErrors(Printed):
    """Errors of the tip; a measure that the scenario does not have is missing, one that never came is null."""

    across_max: float | None = None
    """Largest distance from the line of the step or the push [m]."""
    across_rms: float | None = None
    """The same, root of the mean square [m]."""
    along_max: float | None = None
    """Largest yielding along a push [m]."""
    radial_rms: float | None = None
    """Of the distance from a circle, last lap [m]."""
    radial_max: float | None = None
    """Largest distance from a circle, last lap [m]."""
    lag: float | None = None
    """Mean angle behind the aim on a circle, last lap [rad]."""
    overshoot: float | None = None
    """Beyond the aim of a step, over its length."""
    settling: float | None = None
    """Until the tip stays within 2 % of where it comes to rest [s]."""
    on_aim: float | None = None
    """Until it stays within 2 % of the aim [s]."""
    rest: float | None = None
    """Distance from the aim over the last tenth of the run, mean [m]."""
    iae: float | None = None
    """Integral of the distance from the aim [m s]."""
    cycle: float | None = None
    """Peak to peak of x or y after 5 s, the larger [m]."""


class Figures(Printed):
    """Mean or worst of the trials."""

    true: TipErrors
    """By the true joint angles."""
    encoder: TipErrors
    """By what the encoders told."""
    work: float | None
    """Sum of what each motor gives or brakes [J]."""
    heat: float | None
    """Lost in the windings [J]."""
    saturated: float | None
    """Share of ticks with a joint at its motor's limit."""
    tick: float | None
    """Of one call, measured on this machine [s]."""


class Measured(Figures):
    """What one run of one law gave."""

    unstable_at: float | None
    """When the run left what can be called control [s]."""


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


class Recorded(Printed):
    """A log that was written."""

    file: str
    rows: Count
    seconds: float
    columns: list[str]
    notes: dict[str, str]


class Estimate(Printed):
    """One property of a joint."""

    name: str
    unit: str
    value: float | None
    standard_error: float | None
    interval_95: Pair | None
    method: str
    needs: str | None
    """What the log would have to hold for a value."""
    stated: float | None
    """What the robot's file says."""
    difference: float | None
    """Value over stated, less 1."""


class Rough(Printed):
    """The same by moves with constant torque."""

    inertia: float | None
    damping: float | None
    friction: float | None
    episodes: Count


class Joint(Printed):
    """What a log tells of one joint."""

    joint: str
    rows: Count
    seconds: float
    torque_from: str
    lag: float | None
    """Of the torque behind the angles [s]."""
    residual_torque: float | None
    """Root mean square of what the fit leaves [N m]."""
    estimates: list[Estimate]
    constant_torque: Rough


class Identified(Printed):
    """What a log tells of a limb."""

    log: str
    """The file."""
    robot: str | None
    limb: str | None
    joints: list[Joint]
    notes: list[str]


class BenchedLimb(Printed):
    """The limb on the bench."""

    robot: str
    name: str
    start: Pair


class ForceErrors(Printed):
    """What one law did to a wall. Errors are actual less wanted force; null where it left the finite numbers."""

    mean_error: float | None
    """[N]."""
    worst_standing: float | None
    """Largest size of the error before and after the slide [N]."""
    worst_sliding: float | None
    """During the slide [N]."""
    worst: float | None
    """Of all [N]."""
    contact: float | None
    """Share of ticks with the tip on the wall."""
    held: bool
    """Whether the tip never left the wall and no error was beyond the tolerance."""
    bounces: int
    """How often the tip left the wall before that."""
    peak: float | None
    """Largest force of the whole run [N]."""
    off_line: float | None
    """Largest error of the place along the wall [m]."""
    work: float | None
    """Sum of what each motor gives or brakes [J]."""


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


class Boundary(Printed):
    """Where one law changes from steady to not, along one axis."""

    label: str
    key: str
    at: float
    """In the unit of that axis."""
    beside: float | None
    """Value of the other axis, in its unit."""
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


class Edge(Printed):
    """Where a law stops coming to rest, at one damping time."""

    damping_time: float
    """kd over kp [s]."""
    kp: float
    """Largest that was found steady, in the law's unit."""
    beyond: float
    """Smallest that was found unsteady."""
    linear_kp: float
    """Where the linear loop without play and Coulomb friction turns unstable."""
    situation: str
    overshoot: float


class TunedLaw(Printed):
    """What was found for one law."""

    law: str
    edges: list[Edge]
    damping_time: float
    """The one that was taken [s]."""
    limit_kp: float
    linear_kp: float
    kp: float
    """Recommended."""
    kd: float
    stiffness: Pair
    """Of the tip along x and y at the limb's start [N/m]."""
    peak_to_peak: float
    """Largest of the true tip after 5 s at the recommended gains [m]."""
    situation: str
    lower: float
    """The same at a half and a quarter of the gains [m]."""
    overshoot: float
    iae: float
    """Of the true tip in a step of 2 cm [m s]."""
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


class BodyErrors(Printed):
    """Of the measured part, by the truth."""

    radial_rms: float | None
    """Of a circle: how far from it [m]."""
    behind_rms: float | None
    """Distance from the aim [m]."""
    x_max: float | None
    """Largest way along x from the aim, less that at the beginning [m]."""
    y_max: float | None
    turn_max: float | None
    """[rad]."""
    rest: float | None
    """Distance from the aim at the end [m]."""
    off_max: float | None
    """Largest distance of a holding tip from its peg [m]."""
    unhooked_at: float | None
    """When a hook came off [s]; null: never."""


class BodyControl(BodyErrors):
    """One control of the body."""

    control: str
    kp: list[float]
    """Along x, y [N/m] and turning [N m/rad]."""
    kd: list[float]


class Bodies(Printed):
    """Controls compared on a body that limbs hold; exit code 1 where a hook came off."""

    kind: str
    controls: list[BodyControl]


class PushTrial(BodyErrors):
    """One push."""

    seed: int
    side: int
    """1 towards +x, -1 towards -x."""
