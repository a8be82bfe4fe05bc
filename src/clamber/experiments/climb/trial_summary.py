"""What many climbs say together: how often they succeed, why they fail, how long they take, what of the noise matters."""

from dataclasses import dataclass
from statistics import median
from typing import Final

import numpy as np

from ...execution.climb.course import Course, lay_course, names_of
from ...types import Json
from ...units import INCH
from ..fault_trials import FaultRow, fault_rows
from ..intervals import wilson_interval
from .sensitivity import Effect, find_effects
from .trials import Trials

WAY: Final = 6.0 * INCH
"""A rung of the thesis's ladder, that times are told for [m]."""
SHORTEST_WAY: Final = 0.01
"""A plan whose body goes no farther has no speed [m]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Cause:
    """Climbs that ended in the same way."""

    outcome: str
    kind: str
    """Of the action that ended them; empty before the first."""
    limb: str
    """That acted; empty for the body."""
    n: int
    of: int
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
    def interval(self) -> tuple[float, float]:
        """Of its share of all climbs, 95 %, Wilson's."""
        return wilson_interval(self.n, self.of)

    def to_json(self) -> Json:
        """Plain data."""
        told = {
            "outcome": self.outcome,
            "kind": self.kind,
            "limb": self.limb,
            "n": self.n,
            "interval": list(self.interval),
        }
        return told | {"steps": list(self.steps), "seeds": list(self.seeds), "reason": self.reason}


@dataclass(frozen=True, slots=True, kw_only=True)
class Spread:
    """The middle and the ends of some numbers."""

    median: float
    low: float
    """5 % are less."""
    high: float
    """5 % are more."""

    def to_json(self) -> Json:
        """Plain data."""
        return {"median": self.median, "low": self.low, "high": self.high}


@dataclass(frozen=True, slots=True, kw_only=True)
class TrialSummary:
    """Many climbs of one plan."""

    task: str
    noise: str
    """In words."""
    asked: int
    n: int
    """That ended."""
    done: int
    causes: tuple[Cause, ...]
    """The commonest first."""
    seconds: Spread | None
    """Simulated, of climbs that were carried out; None without one."""
    per_rung: Spread | None
    """The same for each 6 in of the body's way in the plan; None where the body stays."""
    short: Spread | None
    """By how much their bodies truly missed the goal's box [m]."""
    speed: float | None
    """Simulated over wall-clock time of one worker."""
    pushes: float | None
    """For each grab."""
    stalled: int
    """Moves of the body that did not arrive, in all climbs."""
    replanned: int
    """Climbs that took a new plan."""
    recovered: int
    """Hooks that came off and were brought back, in all climbs."""
    recovering: int
    """Climbs with such a hook."""
    saved: int
    """Those of them that succeeded."""
    forced: tuple[str, ...]
    """What speaks against the plan, which was carried out all the same."""
    effects: tuple[Effect, ...]
    faults: tuple[FaultRow, ...] = ()
    """A row for each kind of fault, and one for all; none in trials without."""

    @property
    def interval(self) -> tuple[float, float]:
        """Of success, 95 %, Wilson's."""
        return wilson_interval(self.done, self.n)

    def to_json(self) -> Json:
        """Plain data."""
        return {
            "task": self.task,
            "noise": self.noise,
            "asked": self.asked,
            "n": self.n,
            "done": self.done,
            "success": self.done / self.n if self.n else None,
            "interval": list(self.interval),
            "causes": [cause.to_json() for cause in self.causes],
            "seconds": None if self.seconds is None else self.seconds.to_json(),
            "seconds_per_6in": None if self.per_rung is None else self.per_rung.to_json(),
            "short": None if self.short is None else self.short.to_json(),
            "speed": self.speed,
            "pushes_per_grab": self.pushes,
            "stalled": self.stalled,
            "replanned": self.replanned,
            "recovered": self.recovered,
            "recovering": self.recovering,
            "saved": self.saved,
            "forced": list(self.forced),
            "effects": [effect.to_json() for effect in self.effects],
            "faults": [row.to_json() for row in self.faults],
        }


def sum_up(trials: Trials) -> TrialSummary:
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
        effects=() if trials.setup.faults else tuple(find_effects(ended)),
        faults=fault_rows(ended) if trials.setup.faults else (),
    )


def body_way(course: Course) -> float:
    """Length of the body's way in a plan [m]."""
    return float(np.hypot(np.diff(course.stances["x"]), np.diff(course.stances["y"])).sum())


def _causes(trials: Trials) -> tuple[Cause, ...]:
    failed = [trial for trial in trials.ended if not trial.done]
    alike: dict[tuple[str, str, str], list[int]] = {}
    for k, trial in enumerate(failed):
        alike.setdefault((trial.outcome, trial.kind, trial.limb), []).append(k)
    causes = [
        Cause(
            outcome=outcome, kind=kind, limb=limb, n=len(which), of=len(trials.ended), reason=failed[which[0]].reason,
            steps=tuple(sorted({failed[k].step for k in which})), seeds=tuple(sorted(failed[k].seed for k in which)),
        )
        for (outcome, kind, limb), which in alike.items()
    ]  # fmt: skip
    return tuple(sorted(causes, key=lambda cause: (-cause.n, cause.words)))


def _spread(values: list[float]) -> Spread | None:
    if not values:
        return None
    low, high = np.percentile(values, [5.0, 95.0])
    return Spread(median=median(values), low=float(low), high=float(high))
