"""What `run`, `trials`, `rehearse` and `press` print."""

from typing import Literal

from .base import Count, Interval, Pair, Pose, Printed
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


@means_as("experiments/climb/trial_summary.py:Cause")
class Cause(Printed):
    """Climbs that ended in the same way."""

    outcome: str
    kind: str
    limb: str
    n: Count
    interval: Interval
    """95 % interval of their share of all climbs."""
    steps: list[int]
    seeds: list[int]
    reason: str


class Spread(Printed):
    """The middle and the ends of some numbers."""

    median: float
    low: float
    """5 % are less."""
    high: float
    """5 % are more."""


class Third(Printed):
    """Climbs in a third of what was drawn of one key."""

    low: float
    high: float
    done: Count
    n: Count
    interval: Interval


@means_as("experiments/climb/sensitivity.py:Effect")
class Effect(Printed):
    """What one key of the noise did to success."""

    key: str
    thirds: list[Third]
    share: float | None
    p: float | None
    verdict: str
    """In words."""


class EarlyFinding(Noticed):
    """A fault that the robot noticed before there was one: a false alarm."""


class TriedFault(Printed):
    """The fault that a trial's robot had, and how that ended."""

    kind: str
    start: float
    """From when on [s]."""
    size: float
    """How much, in SI units: of spikes and drift what the sensor is off, of packets the part or number of them, of a hold [N]."""
    channel: Count
    """Index of the sensor or motor; number of the hold."""
    where: str
    """Its name; empty for the link."""
    seed: Count
    """Of what it leaves to chance."""
    noticed: float | None
    """When the robot noticed it first [s]; null if it never did."""
    noticed_as: str
    """As what, such as "no answer"."""
    at: str
    """Where, as the robot has it."""
    early: list[EarlyFinding]
    """False alarms before it began."""
    ending: Literal["recovered", "held", "stopped safely", "fell", "error"]


@means_as("experiments/fault_trials.py:FaultRow")
class FaultKindTried(Printed):
    """Trials with one kind of fault, or all of them."""

    kind: str
    n: Count
    noticed: Count
    located: Count
    delay: float | None
    early: Count
    endings: dict[str, Count]
    intervals: dict[str, Interval]
    """95 % interval of each ending's share."""


@means_as("experiments/climb/trial.py:ClimbTrial")
class ClimbTrial(Printed):
    """How one climb ended."""

    seed: Count
    done: bool
    outcome: str
    """Of the last action: ok, or why the climb ended there; error where it raised."""
    step: Count
    kind: str
    limb: str
    reason: str
    seconds: float
    short: float
    pushes: Count
    grabs: Count
    stalled: Count
    replans: Count
    recovered: Count
    drawn: dict[str, float]
    fault: TriedFault | None


@means_as("experiments/climb/trial_summary.py:TrialSummary")
class ClimbTrials(Printed):
    """Many climbs of one plan."""

    task: str
    noise: str
    asked: Count
    n: Count
    done: Count
    success: float | None
    """Share that was carried out."""
    interval: Interval
    """Its 95 % interval (Wilson)."""
    causes: list[Cause]
    """Why the others ended, the commonest first."""
    seconds: Spread | None
    seconds_per_6in: Spread | None
    """The same for each 6 in of the body's way."""
    short: Spread | None
    speed: float | None
    pushes_per_grab: float | None
    stalled: Count
    replanned: Count
    recovered: Count
    recovering: Count
    saved: Count
    forced: list[str]
    effects: list[Effect]
    faults: list[FaultKindTried]
    """By kind; none in trials without."""
    held_out: bool
    """Whether all seeds are held out: none that any tuning may use."""
    trials: list[ClimbTrial]


class ReplayedTrial(Climbed):
    """`--replay SEED`: one climb of the trials again."""

    trial: ClimbTrial


@means_as("experiments/walk/trials.py:WalkTrial")
class WalkTrial(Printed):
    """How one walk ended."""

    seed: Count
    done: bool
    reason: str
    seconds: float
    steps: Count
    tilt: float
    margin: float | None
    off: float | None
    turned: float | None
    kicks: Count
    held_way: float | None
    held_error: float | None
    fault: TriedFault | None


@means_as("experiments/walk/trials.py:WalkCause")
class WalkCause(Printed):
    """Walks that ended early in the same way."""

    words: str
    n: Count
    interval: Interval
    steps: list[Count]
    seeds: list[Count]
    reason: str


class WalkTrials(Printed):
    """Many walks, of a walk or of a walker's plan."""

    walk: str
    noise: dict[str, float]
    """Key to its width, SI units."""
    asked: Count
    n: Count
    done: Count
    interval: Interval
    """95 % interval (Wilson) of the share that came to the end."""
    balanced: Count
    """Walks whose margin of balance was positive throughout, done or not."""
    level: Count
    """Walks that came to their end with the plate never more than 0.1 deg from level."""
    balanced_interval: Interval
    """Of the share of those that were balanced, 95 % (Wilson)."""
    causes: list[WalkCause]
    """Why walks ended early, the commonest first."""
    faults: list[FaultKindTried]
    """By kind; none in trials without."""
    held_out: bool
    """Whether all seeds are held out: none that any tuning may use."""
    trials: list[WalkTrial]


@means_as("experiments/walk/most.py:Tried")
class TriedWalk(Printed):
    """A walk with one value of a setting."""

    value: str
    borne: bool
    reason: str
    margin: float | None
    tilt: float


class Most(Printed):
    """The most that a walk bears; exit code 1 where it does not bear even the least."""

    walk: str
    key: str
    tried: list[TriedWalk]
    """In the order of their values."""
    borne: str | None
    """The largest value found to be borne."""
    refused: str | None
    """The next one, which is not; null where the largest asked for is borne."""


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
