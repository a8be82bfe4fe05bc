"""The two kinds of single relaxations: a number that is turned step by step, and a rule that is switched."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from .find import FailedRelaxation, FeasibleRelaxation, shown
from .trial import Answer, Trial


class Relaxation(Protocol):
    """One kind of change of a task."""

    @property
    def key(self) -> str:
        """What changes."""
        ...

    @property
    def larger(self) -> bool:
        """Whether a change of the same key that comes before it makes it needless, if that opens the task."""
        ...

    def seek(self, trial: Trial) -> FeasibleRelaxation | FailedRelaxation:
        """The smallest change of this kind that makes the task feasible."""
        ...


@dataclass(frozen=True, slots=True, kw_only=True)
class Switch:
    """A rule that is switched, or left out."""

    key: str
    before: str
    after: str
    overrides: tuple[str, ...]
    larger: bool = False
    """Whether it contains switches of the same key that come before it; where one of those opens the task, it isn't tried."""

    def seek(self, trial: Trial) -> FeasibleRelaxation | FailedRelaxation:
        """The switch, if it makes the task feasible."""
        answer = trial.settle(self.overrides)
        if answer.status != "open":
            return FailedRelaxation(
                key=self.key, tried=f"{self.before} -> {self.after}", proved=answer.status == "shut"
            )
        return FeasibleRelaxation(
            key=self.key,
            before=self.before,
            after=self.after,
            unit="",
            overrides=self.overrides,
            length=len(answer.codes),
            shortest=answer.shortest,
            least=True,
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Dial:
    """A number that is relaxed step by step, from the present value to the most that is tried."""

    key: str
    present: float
    """In `unit`."""
    most: float
    """The most relaxed value that is tried, in `unit`."""
    unit: str
    per_unit: int
    """Values that are tried are multiples of the unit over this."""
    overrides: Callable[[float], tuple[str, ...]]
    """The change to a value in `unit`, for `--set`."""
    nested: bool
    """Whether every plan stays a plan as the value is relaxed further; then the values that open the task have one edge."""
    larger: bool = False
    guess: Callable[[Trial, Answer], float | None] | None = None
    """From the answer at `most`, the value at which the edge is likely, in `unit`; the edge is proved all the same."""

    @property
    def _sign(self) -> int:
        return 1 if self.most > self.present else -1

    @property
    def _first(self) -> int:
        """The multiple at the present value, or next to it on its far side."""
        exact = self.present * self.per_unit
        return math.floor(exact + 1e-6) if self._sign > 0 else math.ceil(exact - 1e-6)

    @property
    def steps(self) -> int:
        """Steps from the present value to the most."""
        return self._sign * (round(self.most * self.per_unit) - self._first)

    def value(self, step: int) -> float:
        """The value after some steps, in `unit`."""
        return round((self._first + self._sign * step) / self.per_unit, 9)

    def step_of(self, value: float) -> int:
        """The first step whose value is at least as relaxed as a value, from 1 to `steps`."""
        exact = value * self.per_unit
        multiple = math.ceil(exact - 1e-9) if self._sign > 0 else math.floor(exact + 1e-9)
        return min(max(1, self._sign * (multiple - self._first)), self.steps)

    def seek(self, trial: Trial) -> FeasibleRelaxation | FailedRelaxation:
        """The smallest step that makes the task feasible, by bisection: feasible there, infeasible one step before."""
        high, best = self.steps, trial.settle(self.overrides(self.value(self.steps)))
        if best.status != "open":
            reached = shown(self.value(high), self.unit)
            return FailedRelaxation(key=self.key, tried=reached, proved=best.status == "shut")
        low, settled = 0, True
        tries = [] if self.guess is None else self._about(self.guess(trial, best))
        while high - low > 1 and settled:
            inside = [step for step in tries if low < step < high]
            step = inside[0] if inside else (low + high) // 2
            answer = trial.settle(self.overrides(self.value(step)))
            if answer.status == "open":
                high, best = step, answer
            elif answer.status == "shut":
                low = step
            settled = answer.status != "unsettled"
        return FeasibleRelaxation(
            key=self.key,
            before=round(self.present, 9),
            after=self.value(high),
            shut_at=self.value(low) if low else round(self.present, 9),
            unit=self.unit,
            overrides=self.overrides(self.value(high)),
            length=len(best.codes),
            shortest=best.shortest,
            least=self.nested and settled,
        )

    def _about(self, guess: float | None) -> list[int]:
        """The steps that settle a good guess."""
        if guess is None:
            return []
        step = self.step_of(guess)
        return [step, step - 1, step + 1]


def key_dial(
    key: str,
    present: float,
    *,
    most: float,
    unit: str,
    per_unit: int,
    nested: bool,
    guess: Callable[[Trial, Answer], float | None] | None = None,
) -> Dial:
    """A dial of a single key of the task; see `Dial`."""
    return Dial(
        key=key,
        present=present,
        most=most,
        unit=unit,
        per_unit=per_unit,
        overrides=lambda value: (f"{key}={value:.10g} {unit}".rstrip(),),
        nested=nested,
        guess=guess,
    )
