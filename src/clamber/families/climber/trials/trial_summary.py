"""What many climbs say together: how often they succeed, why they fail, how long they take, what of the noise matters."""

from dataclasses import dataclass
from statistics import median
from typing import Annotated, Final

import numpy as np

from ....json_form import HIDDEN, Count, Jsonable, Key, in_json
from ....trials.fault_trials import FaultRow, fault_rows
from ....trials.sensitivity import Effect, find_effects
from ....trials.trial_runs import wilson_interval
from ....units import INCH
from ..execution.executable_plan import ExecutablePlan, lay_course, names_of
from .noise import NOISE
from .trial import ClimbTrials

WAY: Final = 6.0 * INCH
"""A rung of the thesis's ladder, that times are told for [m]."""
SHORTEST_WAY: Final = 0.01
"""A plan whose body goes no farther has no speed [m]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Cause(Jsonable):
    """Climbs that ended in the same way."""

    outcome: str
    kind: str
    """Of the action that ended them; empty before the first."""
    limb: str
    """That acted; empty for the body."""
    n: Count
    of: Annotated[int, HIDDEN]
    """All climbs."""
    steps: tuple[int, ...]
    """At which, each once."""
    seeds: tuple[int, ...]
    reason: str
    """Of the first one."""

    @property
    def words(self) -> str:
        """Such as "fell: left grab"."""
        acted = " ".join(word for word in (self.limb, self.kind) if word)
        return f"{self.outcome}: {acted}" if acted else self.outcome

    @property
    @in_json(after="n")
    def interval(self) -> tuple[float, float]:
        """Of its share of all climbs, 95 %, Wilson's."""
        return wilson_interval(self.n, self.of)


@dataclass(frozen=True, slots=True, kw_only=True)
class Spread(Jsonable):
    """The middle and the ends of some numbers."""

    median: float
    low: float
    """5 % are less."""
    high: float
    """5 % are more."""


@dataclass(frozen=True, slots=True, kw_only=True)
class TrialSummary(Jsonable):
    """Many climbs of one plan."""

    task: str
    noise: str
    """In words."""
    asked: Count
    n: Count
    """That ended."""
    done: Count
    causes: tuple[Cause, ...]
    """The commonest first."""
    seconds: Spread | None
    """Simulated, of climbs that were carried out; None without one."""
    per_rung: Annotated[Spread | None, Key("seconds_per_6in")]
    """The same for each 6 in of the body's way in the plan; None where the body stays."""
    short: Spread | None
    """By how much their bodies truly missed the goal's box [m]."""
    speed: float | None
    """Simulated over wall-clock time of one worker."""
    pushes: Annotated[float | None, Key("pushes_per_grab")]
    """For each grab."""
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
    forced: tuple[str, ...]
    """What speaks against the plan, which was carried out all the same."""
    effects: tuple[Effect, ...]
    faults: tuple[FaultRow, ...] = ()
    """A row for each kind of fault, and one for all; none in trials without."""

    @in_json(after="done")
    def success(self) -> float | None:
        """Share that was carried out."""
        return self.done / self.n if self.n else None

    @property
    @in_json(after="success")
    def interval(self) -> tuple[float, float]:
        """Of success, 95 %, Wilson's."""
        return wilson_interval(self.done, self.n)


def sum_up(trials: ClimbTrials) -> TrialSummary:
    """What there is to say of trials, ended early or not."""
    ended = trials.ended
    times = [trial.seconds for trial in ended if trial.done]
    assert trials.setup.plan is not None
    course = lay_course(trials.setup.task, trials.setup.plan)
    way = body_way(course)
    grabs = sum(trial.grabs for trial in ended)
    simulated = sum(trial.seconds for trial in ended)
    recovering = [trial for trial in ended if trial.recovered]
    return TrialSummary(
        task=trials.setup.task.name,
        noise=trials.setup.noise.words(),
        asked=trials.asked,
        n=len(ended),
        done=trials.done,
        causes=_causes(trials),
        seconds=_spread(times),
        per_rung=_spread([time * WAY / way for time in times]) if way > SHORTEST_WAY else None,
        short=_spread([trial.short for trial in ended if trial.done]),
        speed=simulated / trials.wall_seconds if trials.wall_seconds > 0.0 else None,
        pushes=sum(trial.pushes for trial in ended) / grabs if grabs else None,
        stalled=sum(trial.stalled for trial in ended),
        replanned=sum(trial.replans > 0 for trial in ended),
        recovered=sum(trial.recovered for trial in ended),
        recovering=len(recovering),
        saved=sum(trial.done for trial in recovering),
        forced=tuple(names_of(course.objections)),
        effects=() if trials.setup.faults else tuple(find_effects(NOISE, ended)),
        faults=fault_rows(ended) if trials.setup.faults else (),
    )


def body_way(course: ExecutablePlan) -> float:
    """Length of the body's way in a plan [m]."""
    return float(np.hypot(np.diff(course.stances["x"]), np.diff(course.stances["y"])).sum())


def _causes(trials: ClimbTrials) -> tuple[Cause, ...]:
    failed = [trial for trial in trials.ended if not trial.done]
    alike: dict[tuple[str, str, str], list[int]] = {}
    for k, trial in enumerate(failed):
        alike.setdefault((trial.outcome, trial.kind, trial.limb), []).append(k)
    causes = [
        Cause(
            outcome=outcome,
            kind=kind,
            limb=limb,
            n=len(which),
            of=len(trials.ended),
            reason=failed[which[0]].reason,
            steps=tuple(sorted({failed[k].step for k in which})),
            seeds=tuple(sorted(failed[k].seed for k in which)),
        )
        for (outcome, kind, limb), which in alike.items()
    ]
    return tuple(sorted(causes, key=lambda cause: (-cause.n, cause.words)))


def _spread(values: list[float]) -> Spread | None:
    if not values:
        return None
    low, high = np.percentile(values, [5.0, 95.0])
    return Spread(median=median(values), low=float(low), high=float(high))
