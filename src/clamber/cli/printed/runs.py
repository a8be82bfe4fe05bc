"""What `run`, `rehearse` and `press` print."""

from typing import Literal

from .base import Count, Pair, Pose, Printed
from .meanings import means_as
from .plans import Action


@means_as("execution/climb/climb_report.py:ActionReport")
class ActionDone(Printed):
    """What became of an action of a climb, or of like moves of the body that were carried out in one go."""

    first: int
    last: int
    kind: str
    """none, move, release or grab."""
    title: str
    outcome: Literal["ok", "stalled", "missed", "fell", "fault", "interrupted", "stopped", "not supported"]
    start: float
    seconds: float
    tries: int
    off: float
    body_error: float | None
    tip_error: float | None
    reason: str
    recovered: Count


class NewPlan(Printed):
    """Where a new plan was made on the way."""

    after: Count
    """Actions reported before."""
    without: list[int]
    """Numbers of the holds that could not be had."""
    length: Count
    """Actions of the new plan."""


@means_as("execution/plant.py:HoldBreak")
class BrokenHold(Printed):
    """A hold that truly gave way, for good."""

    time: float
    hold: int
    force: float
    why: str
    """Above its strength, or pulled outside its direction."""


@means_as("execution/findings.py:Finding")
class Noticed(Printed):
    """A fault that the robot noticed in itself."""

    kind: str
    where: str
    time: float
    why: str
    """In words, with its numbers."""


@means_as("execution/log_stream.py:LogGap")
class Unwritten(Printed):
    """What the log lacks that grew during the run."""

    since: float
    file: str
    problem: str


@means_as("execution/run_report.py:RunReport")
@means_as("execution/climb/climb_report.py:ClimbReport")
class Climbed(Printed):
    """A climb that was carried out; exit code 1 where it is not done."""

    done: bool
    reason: str
    seconds: float
    pose: Pose
    """Body at the end, as believed: x, y [m], angle [rad]."""
    true_pose: Pose | None
    short: float
    forced: list[str]
    replans: list[NewPlan]
    broken: list[BrokenHold]
    findings: list[Noticed]
    ending: Literal["", "held", "stopped safely", "fell"]
    actions: list[ActionDone]
    task: str
    wall_seconds: float
    """That it took."""
    log_gap: Unwritten | None = None
    """There only if the log could not be written to its end."""


@means_as("experiments/climb/lessons.py:Lesson")
class LessonLearned(Printed):
    """One change of a plan that was tried in rehearsal."""

    step: int
    what: str
    length: Count
    climbed: Count
    tried: Count
    """Climbs by it."""
    taken: bool


class Fault(Printed):
    """A grab with which climbs went wrong."""

    step: int
    """0 where no grab led to where they ended."""
    seeds: list[int]
    """Of those climbs."""


class Rehearsed(Printed):
    """What a plan learned in rehearsals."""

    climbs: Count
    """Of each rehearsal."""
    climbed_before: Count
    """Of them, carried out whole by the plan as it was."""
    climbed: Count
    """Likewise by the best plan found."""
    actions: list[Action]
    """Of that plan."""
    faults: list[Fault]
    """Where it still fails, the most frequent first."""
    lessons: list[LessonLearned]
    """Changes in the order in which they were tried."""


class PhaseTimes(Printed):
    """Times of one frame's turn to be lifted [s]."""

    lift: float
    slide: float
    lower: float
    settle: float


@means_as("execution/walk/walk_report.py:StepReport")
class StepDone(Printed):
    """What became of a step of a walk."""

    number: int
    frame: Literal["Delta", "Y"]
    way: float
    outcome: Literal["ok", "moved", "no ground", "refused", "fell", "fault", "stopped", "interrupted"]
    start: float
    times: PhaseTimes
    balance: float | None
    """Least support margin that was reckoned with on the way [m]; null with fewer than three feet on the ground."""
    off: float | None
    """The frame from where it was to come down, as believed [m]; null where it never came down."""
    tries: Count
    tilt: float
    pose_error: float | None
    reason: str


@means_as("execution/walk/tool_hold.py:HeldPart")
class Held(Printed):
    """Where the tool was held at a point of the world, or led along a line, and how well."""

    points: list[Pose]
    first: float
    """Way of the Delta-frame from which on the tool is held [m]."""
    last: float
    """Until where [m]."""
    reach: list[Pair]
    began: float | None
    ended: float | None
    missed: float
    room: float
    speed: float
    measures: Pair
    raised: Pair
    true_point: Pose
    """Where the tool was to be at first, as it truly lies [m]."""
    held_seconds: float
    largest_error: float | None
    """Largest true distance of the tool from where it was to be while it was held [m]."""
    mean_error: float | None


@means_as("execution/run_report.py:RunReport")
class Walked(Printed):
    """A walk that was carried out; exit code 1 where it is not done."""

    done: bool
    """Whether it came to the end of its way, truly."""
    reason: str
    seconds: float
    """Simulated."""
    prepared: float
    """When the first step began [s]."""
    pose: list[float]
    """Plate at the end, as believed: x, y, z [m], alpha, beta, gamma [rad]; empty if it never stood."""
    true_pose: list[float] | None
    goal: list[float]
    """Where the way ends: x, y [m], heading [rad]; empty if it was never laid."""
    missed: Pair | None
    """How far the plate ends from there [m], [rad]."""
    offsets: Pair
    """Of the inclinometers, as calibrated [rad]."""
    kicks: Count
    """How often the plate tilted without its legs telling."""
    findings: list[Noticed]
    ending: Literal["", "held", "stopped safely", "fell"]
    steps: list[StepDone]
    walk: str
    tilt: float
    """Largest angle of the plate from level while it walked [rad]."""
    margin: float | None
    """Least margin of balance while it walked [m]; null where fewer than three feet were on the ground at a time."""
    wall_seconds: float
    hold: Held | None = None
    """There only if the walk has a point to hold and its way was laid."""
    log_gap: Unwritten | None = None
    """There only if the log could not be written to its end."""


class Pressed(Printed):
    """A force held on a wall while the body moved."""

    wanted: float
    """[N]."""
    ripple: float
    """Largest difference from the wanted force, over it."""
    steady_ripple: float
    """The same of the mean over 20 ms."""
    spread: float
    """Root mean square of that difference, over the wanted force."""
    within: float
    """Part of the time in which the force is within a tenth."""
    way: Pair
    """What the body truly went [m]."""
    moves: Pair
    """When its way began and ended [s]."""
    reason: str
    """Why it ended early; empty if it did not."""
