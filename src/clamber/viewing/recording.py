"""What can be drawn and played back: a robot at any moment of a plan or a run, the steps on the way, and what is to be said of each."""

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, Final, Generic, TypeAlias, TypeVar

import numpy as np

from ..planning.problem.problem import Replay
from ..planning.problem.problems import NOTHING_LIMITS, normalisation_of
from ..types import Floats
from .margins import Limiting, all_limiting, grade
from .panel import Gauges
from .scene import Bounds
from .style import STRIP_WORDS

if TYPE_CHECKING:
    from .view import Picture, Robot

Moment = TypeVar("Moment")
Facts: TypeAlias = tuple[tuple[str, str], ...]
"""What a family's robot looks like at one moment."""
BEFORE: Final = 0.01
"""So much before the next step a step is over, where none rests between them [s]."""
FRAMES: Final = {
    "move": 5, "swing": 10, "reach": 8, "release": 2, "still": 1, "slide": 3, "land": 4, "both": 3, "lift": 4,
}  # fmt: skip
"""Frames of a phase where there is room for all."""
EVEN: Final = frozenset({"move", "slide"})
"""Phases that often follow each other: they neither speed up nor slow down, and are not paused after."""
PAUSE: Final = 2.5
"""Frames' worth of time that a settled stance is shown."""
RATE: Final = 15.0
"""Frames of `view.FRAMES` in a second of a plan's film."""


@dataclass(frozen=True, slots=True)
class MarginRow:
    """One check of a step."""

    name: str
    value: str
    """The margin with its unit."""
    share: float
    """Of what is limited [-]; negative is violated; NaN where it is a count."""
    hard: bool
    """Whether the check forbids."""
    worst: bool
    """Whether it is the nearest to failing."""
    meaning: str


@dataclass(frozen=True, slots=True)
class Part(Generic[Moment]):
    """Part of an action's motion."""

    kind: str
    """One of `FRAMES`."""
    at: Callable[[float, float], Moment]
    """The moment at a share of the part and at a share of the whole action, both in [0, 1], ends included."""


class Recording(ABC, Generic[Moment]):
    """A robot at any moment between 0 and `seconds`, with a step for each."""

    title: str
    seconds: float
    """Its length at speed 1 [s]."""
    speed: float = 1.0
    """At which it is played unless asked otherwise [-]."""
    gauges: tuple[Gauges, ...]
    """Blocks of bars, of limits."""
    steps: tuple[str, ...]
    """In words, the start first."""
    grades: tuple[int, ...]
    """Of the steps, as colours of `style.STRIP`; the start's does not count."""
    noun: str = "Step"
    """What is counted."""
    words: tuple[str, str, str, str] = STRIP_WORDS
    """What the grades mean."""
    starts: Floats
    """When the step begins that leads to each stance; the start's is 0, shape (n_steps + 1,) [s]."""
    ends: Floats
    """When each has been carried out, likewise."""

    @abstractmethod
    def at(self, time: float) -> Moment:
        """The robot at a time [s]."""

    @abstractmethod
    def values(self, at: Moment) -> tuple[Floats, ...]:
        """What the bars of each block show at a moment, SI units, shape (n,) each; NaN where nothing is told."""

    @abstractmethod
    def facts(self, step: int, at: Moment) -> Facts:
        """Names and words of what is to be said of a moment."""

    def margins(self, step: int) -> list[MarginRow]:
        """The checks of a step; none where nothing judged it."""
        return []

    def step_at(self, time: float) -> int:
        """Number of the step that is under way at a time; 0 is the start."""
        return max(0, int(np.searchsorted(self.starts, time, side="right")) - 1)

    def times(self, rate: float, most: int) -> Floats:
        """When so many pictures are taken in a second of playing it, `most` or one more at most, from its start to its end [s]."""
        count = int(min(most, np.ceil(self.seconds / self.speed * rate)))
        return np.linspace(0.0, self.seconds, max(count, 1) + 1)

    def planned_time(self, time: float, plan: "Recording[Moment]") -> float | None:
        """The time of its plan's film that a time of a run belongs to; None where there is none, as in a plan itself."""
        return None

    def rest(self, step: int) -> float:
        """A time at which a step has been carried out and the next has not begun [s]."""
        end = float(self.ends[step])
        if step + 1 < len(self.starts):
            end = min(end, max(float(self.starts[step + 1]) - BEFORE, float(self.starts[step])))
        return end

    @property
    def worst(self) -> int | None:
        """The step that was the nearest to failing; None if none is told."""
        return None


class StillFilm(Recording[Moment]):
    """A robot that stands still, or a world without one, with its facts.

    Args:
        at: The only moment.
        step: The only one, in words.
        facts: Names and words.
        title: Above all.
        bars: Blocks of them, each with its values.
    """

    def __init__(
        self, at: Moment, step: str, facts: Facts, title: str, bars: tuple[tuple[Gauges, Floats], ...] = ()
    ) -> None:
        self._at, self._facts, self._values = at, facts, tuple(values for _, values in bars)
        self.title, self.steps, self.gauges = title, (step,), tuple(gauges for gauges, _ in bars)
        self.seconds, self.grades = 0.0, (3,)
        self.starts = self.ends = np.zeros(1)

    def at(self, time: float) -> Moment:
        """See `Recording`."""
        return self._at

    def values(self, at: Moment) -> tuple[Floats, ...]:
        """See `Recording`."""
        return self._values

    def facts(self, step: int, at: Moment) -> Facts:
        """See `Recording`."""
        return self._facts


@dataclass(frozen=True, slots=True)
class _Stretch(Generic[Moment]):
    """A part of a step in a film."""

    start: float
    """[s]."""
    end: float
    part: Part[Moment]
    first: float
    """Share of the whole action at its start [-]."""
    last: float


class View(Recording[Moment]):
    """A film that can be drawn as a `Picture`, too; bars are the first block of its gauges."""

    task: Any
    bounds: Bounds
    """The part of the world shown."""
    rows: ClassVar[tuple[str, ...]]
    """Names of the facts in the picture's panel; the verdict comes after them."""
    verdict_row: ClassVar[str] = "Nearest limit"
    strip_title: ClassVar[str] = "Smallest margin of every step"

    @abstractmethod
    def draw(self, picture: "Picture[Moment]") -> "Robot[Moment]":
        """Draw the world on a picture's `wall`, what marks mean at the `key` of its `panel`, and make the robot's artists."""

    @abstractmethod
    def settled(self, step: int) -> Moment:
        """The stance after a step; 0 is the start."""

    @abstractmethod
    def motion(self, step: int) -> list[Part[Moment]]:
        """The parts of a step's motion, in order; at least one."""

    @abstractmethod
    def lines(self, step: int, at: Moment) -> tuple[str, ...]:
        """A moment in words, one for each of `rows`."""

    def facts(self, step: int, at: Moment) -> Facts:
        """See `Recording`."""
        return tuple(zip(self.rows, self.lines(step, at), strict=True))

    @abstractmethod
    def verdict(self, step: int) -> str:
        """What is to be thought of a step, in words; 0 is the start."""

    @abstractmethod
    def failed(self, step: int) -> bool:
        """Whether a step went wrong."""


class PlanView(View[Moment]):
    """A plan carried out on paper, in the time that its pictures take.

    Args:
        task: What it is a plan for.
        replay: Of the plan.
        bounds: The part of the world that is shown.
        gauges: Of what a moment bears.
    """

    def __init__(self, task: Any, replay: Replay, bounds: Bounds, gauges: Gauges) -> None:
        self.task, self.replay, self.bounds, self.gauges = task, replay, bounds, (gauges,)
        self.title, self.normalisation = task.title or task.name, normalisation_of(task)
        self.limiting: list[Limiting | None] = all_limiting(self.normalisation, replay)
        self.grades = (3, *(grade(limit) for limit in self.limiting))
        n = len(replay.reasons)
        self.steps = ("start", *(self.action(step) for step in range(1, n + 1)))
        self._stretches: list[_Stretch[Moment]] = []
        now, starts, ends = 2.0 * PAUSE / RATE, [0.0], [0.0]
        for step in range(1, n + 1):
            starts.append(now)
            parts = self.motion(step)
            frames = np.array([FRAMES[part.kind] for part in parts], dtype=np.float64)
            ways = np.concatenate([(0.0,), np.cumsum(frames) / frames.sum()])
            for k, part in enumerate(parts):
                end = now + frames[k] / RATE
                self._stretches.append(_Stretch(now, end, part, ways[k], ways[k + 1]))
                now = end
            ends.append(now)
            now += 0.0 if parts[-1].kind in EVEN else PAUSE / RATE
        self.starts, self.ends = np.array(starts), np.array(ends)
        self.seconds = now + 2.0 * PAUSE / RATE if n else 0.0
        self._begins = np.array([stretch.start for stretch in self._stretches])

    @abstractmethod
    def action(self, step: int) -> str:
        """A step in words."""

    def at(self, time: float) -> Moment:
        """The robot at a time [s]: moving, or resting in the stance after a step."""
        k = int(np.searchsorted(self._begins, time, side="right")) - 1
        if k < 0:
            return self.settled(0)
        stretch = self._stretches[k]
        if time >= stretch.end:
            step = self.step_at(time)
            return self.settled(step) if time >= self.ends[step] else stretch.part.at(1.0, stretch.last)
        share = (time - stretch.start) / (stretch.end - stretch.start)
        ease = share if stretch.part.kind in EVEN else share * share * (3.0 - 2.0 * share)
        return stretch.part.at(ease, stretch.first + share * (stretch.last - stretch.first))

    def reason(self, step: int) -> int:
        """Number of the check that a step violates; -1: none."""
        return int(self.replay.reasons[step - 1]) if step else -1

    def limit(self, step: int) -> Limiting | None:
        """What limits the stance after a step; None if nothing has judged it."""
        return self.limiting[step - 1] if step else None

    def verdict(self, step: int) -> str:
        """See `View`."""
        limit = self.limit(step)
        return "not judged" if limit is None else str(limit)

    def failed(self, step: int) -> bool:
        """See `View`."""
        return self.reason(step) >= 0

    def margins(self, step: int) -> list[MarginRow]:
        """See `Recording`."""
        if step == 0:
            return []
        normalisation, row = self.normalisation, self.replay.margins[step - 1]
        worst, rows = self.limit(step), []
        for check, margin in zip(normalisation.checks, row.tolist(), strict=True):
            size = normalisation.sizes.get(check.name, 0.0)
            if not abs(margin) < NOTHING_LIMITS or (size <= 0.0 and margin >= 0.0):
                continue
            share = margin / size if size > 0.0 else min(margin, 0.0)
            shown = Limiting(check, margin, share, normalisation.units)
            at_worst = worst is not None and worst.check.name == check.name
            rows.append(
                MarginRow(check.name, shown.value, share, check.name in normalisation.hard, at_worst, check.meaning)
            )
        return rows

    @property
    def worst(self) -> int | None:
        """See `Recording`."""
        limits = self.limiting
        judged = [k for k, limit in enumerate(limits) if limit is not None]
        return 1 + min(judged, key=lambda k: limits[k].share) if judged else None  # type: ignore[union-attr]


@dataclass(frozen=True, slots=True)
class Frame(Generic[Moment]):
    """One frame of an animation."""

    step: int
    """Number of the action it belongs to, from 1; 0 is the start."""
    moment: Moment
    length: float
    """How long it is shown, in frame times [-]."""


def make_frames(view: View[Moment], most: int) -> list[Frame[Moment]]:
    """The frames of a plan, at most `most` of them: long plans get fewer per action, then not every action."""
    steps = len(view.steps) - 1
    motions = [view.motion(step) for step in range(1, steps + 1)]
    wanted = sum(FRAMES[part.kind] for parts in motions for part in parts)
    thin = min(1.0, most / max(wanted + 1, 1))
    frames = [Frame(0, view.settled(0), 3 * PAUSE)]
    for step, parts in enumerate(motions, start=1):
        frames += _step_frames(step, parts, thin)
    frames[-1] = Frame(frames[-1].step, frames[-1].moment, 6 * PAUSE)
    if len(frames) > most:
        frames = [frames[k] for k in np.linspace(0, len(frames) - 1, most).round().astype(int)]
    return frames


def _step_frames(step: int, parts: list[Part[Moment]], thin: float) -> list[Frame[Moment]]:
    counts = [max(1 if k == len(parts) - 1 else 0, round(thin * FRAMES[p.kind])) for k, p in enumerate(parts)]
    total, done = sum(counts), 0
    frames = []
    for part, count in zip(parts, counts, strict=True):
        for k in range(1, count + 1):
            done += 1
            share = k / count
            ease = share if part.kind in EVEN else share * share * (3.0 - 2.0 * share)
            pause = 1.0 if done < total or part.kind in EVEN else PAUSE
            frames.append(Frame(step, part.at(ease, done / total), pause))
    return frames
