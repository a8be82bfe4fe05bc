"""What can be played back: a robot at any moment of a plan or a run, the steps on the way, and what is to be said of each."""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Final, Generic

import numpy as np

from ...planning.problem.problems import NOTHING_LIMITS
from ...types import Floats
from ..margins import Limiting, grade
from ..panel import Gauges
from ..style import STRIP_WORDS
from ..view import EVEN, FRAMES, PAUSE, Moment, Part, View

BEFORE: Final = 0.01
"""So much before the next step a step is over, where none rests between them [s]."""
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


class Film(ABC, Generic[Moment]):
    """A robot at any moment between 0 and `seconds`, with a step for each."""

    title: str
    seconds: float
    """How long it takes at speed 1 [s]."""
    speed: float = 1.0
    """At which it is played unless asked otherwise [-]."""
    gauges: tuple[Gauges, ...]
    """Blocks of bars, of what is limited."""
    steps: tuple[str, ...]
    """In words; the first is the start."""
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
    def facts(self, step: int, at: Moment) -> tuple[tuple[str, str], ...]:
        """Names and words of what is to be said of a moment."""

    @abstractmethod
    def margins(self, step: int) -> list[MarginRow]:
        """The checks of a step; none where nothing judged it."""

    def step_at(self, time: float) -> int:
        """Number of the step that is under way at a time; 0 is the start."""
        return max(0, int(np.searchsorted(self.starts, time, side="right")) - 1)

    def planned_time(self, time: float, plan: "Film[Moment]") -> float | None:
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


class PlanFilm(Film[Moment]):
    """A plan carried out on paper, in the time that its pictures take.

    Args:
        view: Of its replay.
    """

    def __init__(self, view: View[Moment]) -> None:
        self._view = view
        self.title, self.gauges = view.title, (view.gauges,)
        n = len(view.replay.reasons)
        self.steps = ("start", *(view.action(step) for step in range(1, n + 1)))
        self.grades = (3, *(grade(limit) for limit in view.limiting))
        self._stretches: list[_Stretch[Moment]] = []
        now, starts, ends = 2.0 * PAUSE / RATE, [0.0], [0.0]
        for step in range(1, n + 1):
            starts.append(now)
            parts = view.motion(step)
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

    def at(self, time: float) -> Moment:
        """The robot at a time [s]: moving, or resting in the stance after a step."""
        k = int(np.searchsorted(self._begins, time, side="right")) - 1
        if k < 0:
            return self._view.settled(0)
        stretch = self._stretches[k]
        if time >= stretch.end:
            step = self.step_at(time)
            return self._view.settled(step) if time >= self.ends[step] else stretch.part.at(1.0, stretch.last)
        share = (time - stretch.start) / (stretch.end - stretch.start)
        ease = share if stretch.part.kind in EVEN else share * share * (3.0 - 2.0 * share)
        return stretch.part.at(ease, stretch.first + share * (stretch.last - stretch.first))

    def values(self, at: Moment) -> tuple[Floats, ...]:
        """See `Film`."""
        return (self._view.values(at),)

    def facts(self, step: int, at: Moment) -> tuple[tuple[str, str], ...]:
        """See `Film`."""
        return tuple(zip(self._view.rows, self._view.facts(step, at), strict=True))

    def margins(self, step: int) -> list[MarginRow]:
        """See `Film`."""
        if step == 0:
            return []
        yardsticks, row = self._view.yardsticks, self._view.replay.margins[step - 1]
        worst, rows = self._view.limit(step), []
        for check, margin in zip(yardsticks.checks, row.tolist(), strict=True):
            size = yardsticks.sizes.get(check.name, 0.0)
            if not abs(margin) < NOTHING_LIMITS or (size <= 0.0 and margin >= 0.0):
                continue
            share = margin / size if size > 0.0 else min(margin, 0.0)
            shown = Limiting(check, margin, share)
            at_worst = worst is not None and worst.check.name == check.name
            rows.append(
                MarginRow(check.name, shown.value, share, check.name in yardsticks.hard, at_worst, check.meaning)
            )
        return rows

    @property
    def worst(self) -> int | None:
        """See `Film`."""
        limits = self._view.limiting
        judged = [k for k, limit in enumerate(limits) if limit is not None]
        return 1 + min(judged, key=lambda k: limits[k].share) if judged else None  # type: ignore[union-attr]
