"""What `run`, `trials` and `press` print."""

from typing import Literal

from .base import Count, Interval, Pair, Pose, Printed


class ActionDone(Printed):
    """What became of an action of a climb, or of like moves of the body that were carried out in one go."""

    first: int
    """Step of the plan, from 1."""
    last: int
    kind: str
    """none, move, release or grab."""
    title: str
    outcome: Literal["ok", "stalled", "missed", "fell", "interrupted", "stopped", "not supported"]
    start: float
    """When it began [s]."""
    seconds: float
    tries: int
    """Pushes of the hook of a grab; ways of the body; 1 for the rest."""
    off: float
    """Body from its aim at the end, as believed [m]."""
    body_error: float | None
    """Body, believed from true, at the end [m]; null where nobody tells."""
    tip_error: float | None
    """The same of the tip of the limb that acted [m]."""
    reason: str
    recovered: Count
    """Hooks that came off meanwhile and were brought back."""


class NewPlan(Printed):
    """Where a new plan was made on the way."""

    after: Count
    """Actions reported before."""
    without: list[int]
    """Numbers of the holds that could not be had."""
    length: Count
    """Actions of the new plan."""


class Climbed(Printed):
    """A climb that was carried out; exit code 1 where it is not done."""

    done: bool
    """Whether every action was carried out, and the body came to the goal with it."""
    reason: str
    """Why it ended, where it is not done."""
    seconds: float
    """Simulated, or on the robot's clock."""
    pose: Pose
    """Body at the end, as believed: x, y [m], angle [rad]."""
    true_pose: Pose | None
    short: float
    """By how much the body misses the last goal's box [m]."""
    forced: list[str]
    """Objections to the plan that were overridden."""
    replans: list[NewPlan]
    actions: list[ActionDone]
    task: str
    wall_seconds: float
    """That it took."""


class PhaseTimes(Printed):
    """Times of one frame's turn to be lifted [s]."""

    lift: float
    slide: float
    lower: float
    settle: float


class StepDone(Printed):
    """What became of a step of a walk."""

    number: int
    """From 1."""
    frame: Literal["Delta", "Y"]
    way: float
    """Where on the way the frame was to come down [m]."""
    outcome: Literal["ok", "moved", "no ground", "refused", "fell", "stopped", "interrupted"]
    start: float
    """When it began [s]."""
    times: PhaseTimes
    balance: float | None
    """Least support margin that was reckoned with on the way [m]; null with fewer than three feet on the ground."""
    off: float | None
    """The frame from where it was to come down, as believed [m]; null where it never came down."""
    tries: Count
    """How often its feet were lowered."""
    tilt: float
    """The plate's angle from the horizontal at the end, as believed [rad]."""
    pose_error: float | None
    """Plate, believed from true, seen from above, at the end [m]."""
    reason: str


class Held(Printed):
    """Where the tool was held at a point of the world, or led along a line, and how well."""

    points: list[Pose]
    """The point, or those that the tool was to go through: world, as believed [m]."""
    first: float
    """Way of the Delta-frame from which on the tool is held [m]."""
    last: float
    """Until where [m]."""
    reach: list[Pair]
    """Parts of the way, of what was asked for, where the arm can reach the point [m]."""
    began: float | None
    """When it was there [s]; null: the walk did not come so far."""
    ended: float | None
    """When it left [s]; null: it was held to the end."""
    missed: float
    """Farthest that the commanded tool was from the point by the believed pose [m]."""
    room: float
    """Least distance of a joint from an end of its range [rad]."""
    speed: float
    """Largest share of its speed that a joint had [-]."""
    true_point: Pose
    """Where the tool was to be at first, as it truly lies [m]."""
    held_seconds: float
    largest_error: float | None
    """Largest true distance of the tool from where it was to be while it was held [m]."""
    mean_error: float | None


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
    steps: list[StepDone]
    walk: str
    tilt: float
    """Largest angle of the plate from level while it walked [rad]."""
    margin: float | None
    """Least margin of balance while it walked [m]; null where fewer than three feet were on the ground at a time."""
    wall_seconds: float
    hold: Held | None = None
    """There only if the walk has a point to hold and its way was laid."""


class Cause(Printed):
    """Climbs that ended in the same way."""

    outcome: str
    kind: str
    """Of the action that ended them; empty before the first."""
    limb: str
    """That acted; empty for the body."""
    n: Count
    interval: Interval
    """95 % interval of their share of all climbs."""
    steps: list[int]
    seeds: list[int]
    reason: str
    """Of the first one."""


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


class Effect(Printed):
    """What one key of the noise did to success."""

    key: str
    thirds: list[Third]
    share: float | None
    """Chance that a failed climb drew more than one that was carried out; 0.5 if it makes no difference."""
    p: float | None
    """Of the clearer of two rank tests, corrected for all tests of all keys."""
    verdict: str
    """In words."""


class ClimbTrial(Printed):
    """How one climb ended."""

    seed: Count
    done: bool
    outcome: str
    """Of the last action: ok, or why the climb ended there; error where it raised."""
    step: Count
    """Number of the last action in its plan, from 1; 0: none began."""
    kind: str
    limb: str
    reason: str
    seconds: float
    """Simulated."""
    short: float
    """By how much the body truly misses the goal's box [m]."""
    pushes: Count
    """Of all grabs."""
    grabs: Count
    stalled: Count
    """Moves of the body that did not arrive."""
    replans: Count
    recovered: Count
    """Hooks that came off and were brought back."""
    drawn: dict[str, float]
    """Deviation of each key of the noise, SI units."""


class ClimbTrials(Printed):
    """Many climbs of one plan."""

    task: str
    noise: str
    """In words."""
    asked: Count
    n: Count
    """That ended."""
    done: Count
    success: float | None
    """Share that was carried out."""
    interval: Interval
    """Its 95 % interval (Wilson)."""
    causes: list[Cause]
    """Why the others ended, the commonest first."""
    seconds: Spread | None
    """Simulated, of climbs that were carried out."""
    seconds_per_6in: Spread | None
    """The same for each 6 in of the body's way."""
    short: Spread | None
    """By how much bodies truly missed the goal's box [m]."""
    speed: float | None
    """Simulated over wall-clock time of one worker."""
    pushes_per_grab: float | None
    stalled: Count
    """Moves of the body that did not arrive, in all climbs."""
    replanned: Count
    """Climbs that took a new plan."""
    recovered: Count
    """Hooks that came off and were brought back, in all climbs."""
    recovering: Count
    """Climbs with such a hook."""
    saved: Count
    """Those of them that succeeded."""
    forced: list[str]
    effects: list[Effect]
    trials: list[ClimbTrial]


class ReplayedTrial(Climbed):
    """`--replay SEED`: one climb of the trials again."""

    trial: ClimbTrial


class WalkTrial(Printed):
    """How one walk ended."""

    seed: Count
    done: bool
    reason: str
    seconds: float
    steps: Count
    tilt: float
    """Largest angle of the plate from level while it walked [rad]."""
    margin: float | None
    """Least margin of balance while it walked [m]."""
    off: float | None
    """From where the way ends [m]."""
    turned: float | None
    """Heading from that at the end of the way [rad]."""
    kicks: Count
    held_way: float | None
    """Way over which the tool was to be held at a point [m]."""
    held_error: float | None
    """Largest distance of the tool from that point while it was held [m]."""


class WalkCause(Printed):
    """Walks that ended early in the same way."""

    words: str
    n: Count
    interval: Interval
    """Of their share of all walks, 95 % (Wilson)."""
    steps: list[Count]
    """At which they ended, each once."""
    seeds: list[Count]
    reason: str
    """Of the first one."""


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
    trials: list[WalkTrial]


class TriedWalk(Printed):
    """A walk with one value of a setting."""

    value: str
    borne: bool
    """Whether it came to its end in balance."""
    reason: str
    """Why not; empty where it did."""
    margin: float | None
    """Least margin of balance [m]; null where fewer than three feet were on the ground at a time, or it did not begin."""
    tilt: float
    """Largest angle of the plate from level [rad]."""


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
