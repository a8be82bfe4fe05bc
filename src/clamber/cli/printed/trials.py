"""What `trials` and `most` print."""

from typing import Literal

from .base import Count, Interval, Printed
from .meanings import means_as
from .runs import Climbed, Noticed


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
