"""Which single change of an infeasible task would make it feasible, and the smallest of each kind; each proved by exact search."""

import os
from dataclasses import dataclass
from typing import Annotated, Final

from ...errors import PlannerError
from ...family import NotOfFamilyError, family_of
from ...interrupts import Interruptible
from ...json_form import Count, Jsonable, Key, in_json
from ...tasks import Task
from ..problem.problems import plan_family
from ..progress import Clock, Listener, Relaxing
from .trial import Trial

Value = float | str | None


@dataclass(frozen=True, slots=True, kw_only=True)
class FeasibleRelaxation(Jsonable):
    """One change of a task that makes it feasible."""

    key: str
    """What changes: a key as overrides have it, or words where several keys change together."""
    before: Annotated[Value, Key("from")]
    """The value that the task has, in `unit`; None where there is none."""
    after: Annotated[Value, Key("to")]
    """As it would have to be, in `unit`."""
    shut_at: Annotated[float | None, Key("infeasible_at")] = None
    """The value one step before, at which the task is proved infeasible, in `unit`; None where the values are names."""
    unit: str
    """Empty where the values are names or have none."""
    overrides: tuple[str, ...]
    """The change as texts "key=value", for `--set`."""
    length: Count
    """Actions of the plan that it opens."""
    shortest: bool
    """Whether that plan is proved to be the shortest."""
    least: bool
    """Whether it is proved that no smaller change of this kind does; False where values in between were not all tried, or where
    time ran out, so that `infeasible_at` is farther away than a step."""

    @property
    @in_json()
    def text(self) -> str:
        """The change in words."""
        return f"{self.key}: {shown(self.before, self.unit)} -> {shown(self.after, self.unit)}"


@dataclass(frozen=True, slots=True, kw_only=True)
class FailedRelaxation(Jsonable):
    """One kind of change that was not found to open the task."""

    key: str
    tried: str
    """How far it was changed."""
    proved: bool
    """Whether the task is proved infeasible even then; False where time or memory ran out."""

    @property
    def text(self) -> str:
        """The change in words."""
        return f"{self.key} ({self.tried})"


@dataclass(frozen=True, slots=True, kw_only=True)
class Places(Jsonable):
    """Where one hold more opens the task."""

    spacing: Annotated[float, Key("spacing_m")]
    """Of the lattice of places [m]."""
    places: Count
    """Places of the lattice that a limb could ever grab from where the robot can get to."""
    tried: Count
    """Of those, how many were settled by the exact planner: each opens the task or is proved not to."""
    openings: tuple[FeasibleRelaxation, ...]
    """One for each place that does: those with the shortest plan first, of these the one with most others about it."""

    @property
    @in_json(after="tried")
    def complete(self) -> bool:
        """Whether all of them were settled."""
        return self.tried == self.places


@dataclass(frozen=True, slots=True, kw_only=True)
class InfeasibilityExplanation(Jsonable):
    """Every single change that was tried on an infeasible task, and what came of it."""

    openings: tuple[FeasibleRelaxation, ...]
    """The smallest change of each kind that makes it feasible."""
    shut: tuple[FailedRelaxation, ...]
    """The kinds of which none was found."""
    places: Annotated[Places | None, Key("one_hold_more")]
    """One hold more; None where the family has no holds, or the places were not settled one by one."""
    searches: Count
    """Exact searches made."""
    seconds: float
    ended: str
    """Empty if all was tried; else why not: "interrupted", "time"."""

    @property
    def found(self) -> bool:
        """Whether any change opens the task."""
        return bool(self.openings or (self.places is not None and self.places.openings))


def shown(value: Value, unit: str) -> str:
    """A value with its unit."""
    if value is None:
        return "-"
    return value if isinstance(value, str) else f"{value:.10g} {unit}".rstrip()


SECONDS: Final = 60.0
"""Most time unless told otherwise [s]."""
MOST_STANCES: Final = 2_000_000
"""Stances that the searches keep at once, unless told otherwise: about half a GB for the climber."""
PLACES_WEIGH: Final = 4
"""The search for a place of one hold more gets as much of the time as so many other kinds of changes."""
FIRST_SHARE: Final = 0.1
"""Of the time, what the task as it is may take: it is known to be infeasible, only its furthest stance is asked for [-]."""


def explain_infeasibility(
    task: Task,
    *,
    seconds: float | None = SECONDS,
    max_stances: int = MOST_STANCES,
    spacing: float | None = None,
    threads: int | None = None,
    progress: Listener | None = None,
) -> InfeasibilityExplanation:
    """For every kind of single relaxation, the smallest that makes an infeasible task feasible.

    A number is relaxed as far as it goes, and then bisected: the task is proved feasible at the value told, and infeasible one step
    (0.1 mm, 0.1 deg, 0.1 oz-in) before it. A start stance that is forbidden counts as infeasible.

    Args:
        task: A task that is proved infeasible, or whose start is forbidden.
        seconds: Most time [s]; each kind of change gets its share of it. None: any.
        max_stances: Memory: most stances that the searches keep at once.
        spacing: Of the lattice of places for one hold more [m]; None: a quarter of the shortest limb, in whole steps.
        threads: Places tried at once; one a core unless given.
        progress: Called now and then.

    Returns:
        The openings; Ctrl-C ends it with what was found so far.

    Raises:
        PlannerError: If the task has a plan, or allows actions that exact search can't list one by one.
    """
    clock = Clock(seconds)
    family = family_of(task)
    relaxations, one_hold_more = family.relaxations, family.one_hold_more
    if relaxations is None:
        raise NotOfFamilyError(family.title, "rules or limits that can be relaxed")
    opened: list[FeasibleRelaxation] = []
    shut: list[FailedRelaxation] = []
    places: Places | None = None
    ended = ""

    def tell(searches: int) -> None:
        if progress is not None:
            progress(Relaxing(searches, key))

    trial = Trial(task, max_stances=max_stances, seconds=seconds, tell=tell)
    key = "as it is"
    with Interruptible() as block:
        trial.grant(FIRST_SHARE)
        near = _furthest(trial)
        kinds = list(relaxations(task))
        more = PLACES_WEIGH if near is not None and one_hold_more is not None else 0
        for k, relaxation in enumerate(kinds):
            key = relaxation.key
            if relaxation.larger and any(opening.key == key for opening in opened):
                continue
            trial.grant(1.0 / (len(kinds) - k + more))
            outcome = relaxation.seek(trial)
            (opened if isinstance(outcome, FeasibleRelaxation) else shut).append(outcome)  # type: ignore[arg-type]
        if near is not None and one_hold_more is not None:
            key = "one hold more"
            crew = max(1, threads if threads is not None else (os.cpu_count() or 1))
            places, interrupted = one_hold_more(trial, near, spacing=spacing, threads=crew)
            ended = "interrupted" if interrupted else ""
            if places is None:
                shut.append(
                    FailedRelaxation(key=key, tried="where the robot can get to was not seen whole", proved=False)
                )
    if block.interrupted:
        ended = "interrupted"
    if not ended and trial.left() == 0.0:
        ended = "time"
    return InfeasibilityExplanation(
        openings=tuple(opened),
        shut=tuple(shut),
        places=places,
        searches=trial.searches,
        seconds=clock.spent,
        ended=ended,
    )


def _furthest(trial: Trial) -> tuple[float, float] | None:
    """Where the body is in the furthest stance seen [m]; None if not even the start is allowed."""
    answer = trial.settle(())
    if answer.status == "open":
        raise PlannerError("openings", trial.task.name, "it has a plan, so nothing needs to be opened")
    if answer.problem is None:
        return None
    x, y, *_ = plan_family(trial.task).pose(trial.task, answer.problem.replay(answer.codes).stances[-1])
    return x, y
