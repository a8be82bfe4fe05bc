"""The verdict on a plan: carried out again action by action, every check of every step, those of other packages, the first violation."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Annotated, Literal, TypeAlias

import numpy as np

from ...extensions import ExtensionError, blamed, failure, load_outside, outside
from ...json_form import HIDDEN, INLINE, Count, Jsonable, Key, in_json
from ...shown_units import SI, ShownUnits, units_of
from ...tasks import Task
from ...types import Ints
from ...units import DEGREE, INCH, OZ_IN
from .body_pose import PoseAxis, named_pose, on_map
from .check import TOLERANCE, UNLIMITED, Check
from .plan import Plan
from .problem import Replay
from .problems import PlanFamily, PlannedAction, plan_family


@dataclass(frozen=True, slots=True, kw_only=True)
class StepVerdict(Jsonable):
    """One step of a plan and what the checks say of it."""

    step: int
    """From 1."""
    action: Annotated[PlannedAction, HIDDEN]
    asked: Annotated[int | str, Key("action")]
    """The action as its file has it: the thesis's number where there is one, else in words."""
    ok: bool
    """Whether every hard check holds."""
    check: str | None
    """The first violated hard check."""
    reason: str | None
    """The same in words, with the amount."""
    hold: int | None
    """Number of the hold that was taken."""
    nearest: int | None
    """Number of the hold that "nearest" takes here, where the plan's file asks for that and prints the hold taken."""
    max_torque: Annotated[float | None, Key("max_torque_oz_in", per=OZ_IN)]
    """Largest joint torque; None where it could not be had."""
    power: Annotated[float | None, Key("power_W")]
    """Electrical power that holding the stance takes; None where it could not be had."""
    reported: tuple[str, ...]
    """Violated checks that only report."""
    margins: dict[str, float | None]
    """Check -> signed margin in its own unit (SI); None where nothing limits it or it could not be had."""
    pose: Annotated[tuple[float, ...], HIDDEN]
    """Body afterwards, a number [m] or [rad] for each of the family's `pose_axes`."""
    holds: Annotated[dict[str, int], HIDDEN]
    """Limb -> hold afterwards, 0 if free."""


MarginOf: TypeAlias = Callable[[Task, StepVerdict], float | None]


@dataclass(frozen=True, slots=True, kw_only=True)
class OutsideCheck:
    """A check of another package, named by its entry point in the group `clamber.checks`."""

    unit: str
    """SI unit of its margin; "1" for a count."""
    meaning: str
    """What the margin says, in one line."""
    margin: MarginOf
    """Of a task and a step of a plan: the signed margin, positive holds; None where nothing limits it."""


@dataclass(frozen=True, slots=True)
class Judged:
    """What the checks of other packages say of a plan."""

    checks: tuple[Check, ...]
    rows: tuple[dict[str, float | None], ...]
    """For each step: check -> margin."""
    notes: tuple[str, ...]
    """Which of them could not be had, and why."""


def judge_outside(task: Task, steps: Sequence[StepVerdict], taken: Sequence[str]) -> Judged:
    """The margins of every check that other packages add, for each step; one that fails is a note and no error.

    Args:
        task: What is planned.
        steps: As our own checks have judged them.
        taken: Names of our own checks.
    """
    checks: list[Check] = []
    rows: list[dict[str, float | None]] = [{} for _ in steps]
    notes: list[str] = []
    for name in outside("checks"):
        try:
            if name in taken:
                raise failure("checks", name, "has the name of one of Clamber's own checks")
            check = _loaded(name)
            margins = [_margin(name, check, task, step) for step in steps]
        except ExtensionError as error:
            notes.append(f"a check was left out: {error}")
            continue
        checks.append(Check(name, check.unit, check.meaning))
        for row, margin in zip(rows, margins, strict=True):
            row[name] = margin
    return Judged(tuple(checks), tuple(rows), tuple(notes))


def _loaded(name: str) -> OutsideCheck:
    check = load_outside("checks", name)
    if not isinstance(check, OutsideCheck):
        raise failure("checks", name, f"is a {type(check).__name__}; it must be a clamber.OutsideCheck")
    return check


def _margin(name: str, check: OutsideCheck, task: Task, step: StepVerdict) -> float | None:
    with blamed("checks", name):
        margin = check.margin(task, step)
        return None if margin is None or math.isnan(margin) else float(margin)


@dataclass(frozen=True, slots=True)
class Violation:
    """The first step that violates a hard check."""

    step: int
    action: int | str
    check: str | None
    margin: float | None
    """In SI units."""
    reason: str | None


@dataclass(frozen=True, slots=True)
class PlanEnd:
    """Where the plan ends."""

    x_in: float
    y_in: float
    theta_deg: float
    """First angle of the body's pose."""
    holds: dict[str, int]
    pose: dict[str, float]
    """Each coordinate of the body's pose, in the unit at the end of its name."""


@dataclass(frozen=True, slots=True)
class NearestRule:
    """How many printed holds the rule "nearest" would have taken too."""

    agree: Count
    of: Count


@dataclass(frozen=True, slots=True, kw_only=True)
class Verdict(Jsonable):
    """What came out when a plan was carried out again."""

    ok: bool
    """Whether every action of the plan holds; reaching the goal is told apart (`reached`)."""
    task: str
    planner: str
    length: Count
    """Actions of the plan."""
    steps: Count
    """Actions that hold: up to the first violation, or all of them where the replay went on."""
    went_on: Annotated[bool, HIDDEN]
    """Whether the replay went on past violations."""
    goals: Count
    """Goals of the task, sub-goals included."""
    goals_met: Count
    max_torque: Annotated[float, Key("max_torque_oz_in", per=OZ_IN), Key("max_torque_Nm")]
    """Largest joint torque of the actions that hold."""
    max_power: Annotated[float | None, Key("max_power_W")]
    """Largest electrical power that holding a stance takes; None where the family's model has none."""
    energy: Annotated[float | None, Key("energy_J")]
    """Electrical energy of the actions that hold: power of each stance times the time of an action; None likewise."""
    pose: Annotated[tuple[float, ...], HIDDEN]
    """Body at the end, as `pose_axes` have it [m] or [rad]; before the violating action where the replay stopped there."""
    pose_axes: Annotated[tuple[PoseAxis, ...], HIDDEN]
    holds: Annotated[dict[str, int], HIDDEN]
    """Limb -> hold at the end, 0 if free."""
    checks: Annotated[tuple[Check, ...], HIDDEN]
    hard: tuple[str, ...]
    """Names of the checks that forbid an action; the others report."""
    notes: tuple[str, ...] = ()
    """What was read in a way that the reader should know of, such as a step size taken from the plan."""
    units: Annotated[ShownUnits, HIDDEN] = SI
    """In which it is printed."""
    per_step: tuple[StepVerdict, ...]
    """As far as the replay went; the violating step is the last where it did not go on."""

    def __repr__(self) -> str:
        goal = "goal reached" if self.reached else "goal not reached"
        word = "holds" if self.ok else "VIOLATED"
        return f"<Verdict {word}: {self.steps} of {self.length} actions of {self.task!r}, {goal}>"

    @property
    @in_json(after="steps")
    def reached(self) -> bool:
        """Whether the goal was reached on the way."""
        return self.goals_met >= self.goals

    @property
    def first_violation(self) -> StepVerdict | None:
        """The first step that violates a hard check."""
        return next((row for row in self.per_step if not row.ok), None)

    def tightest(self) -> dict[str, tuple[float, int]]:
        """Check -> its smallest margin [its unit] and the step of it; checks that nothing limits are left out."""
        found: dict[str, tuple[float, int]] = {}
        for row in self.per_step:
            for name, margin in row.margins.items():
                if margin is not None and (name not in found or margin < found[name][0]):
                    found[name] = margin, row.step
        return found

    @in_json(after="hard")
    def warnings(self) -> dict[str, tuple[int, ...]]:
        """Check that only reports -> steps that violate it."""
        found: dict[str, list[int]] = {}
        for row in self.per_step:
            for name in row.reported:
                found.setdefault(name, []).append(row.step)
        return {check.name: tuple(found[check.name]) for check in self.checks if check.name in found}

    def nearest_agree(self) -> tuple[int, int] | None:
        """How many printed pegs "nearest" would have taken too, and of how many; None where none are printed."""
        asked = [row for row in self.per_step if row.nearest is not None]
        return (sum(row.nearest == row.hold for row in asked), len(asked)) if asked else None

    def why(self, row: StepVerdict) -> str:
        """What a violated check is short of, in the units of the task."""
        check = next((check for check in self.checks if check.name == row.check), None)
        margin = None if check is None else row.margins[check.name]
        if check is None or margin is None:
            return row.reason or "it is not allowed"
        return f"{check.name} is short by {self.units.signed(-margin, check.unit).removeprefix('+')} ({check.meaning})"

    @in_json(key="first_violation", after="goals_met")
    def violation(self) -> Violation | None:
        """The first step that violates a hard check."""
        row = self.first_violation
        if row is None:
            return None
        margin = None if row.check is None else row.margins[row.check]
        return Violation(row.step, row.asked, row.check, margin, row.reason)

    @in_json(after="energy_J")
    def final(self) -> PlanEnd:
        """Where the plan ends."""
        x, y, theta = on_map(self.pose_axes, self.pose)
        return PlanEnd(x / INCH, y / INCH, theta / DEGREE, self.holds, named_pose(self.pose_axes, self.pose))

    @in_json(after="warnings")
    def nearest_rule(self) -> NearestRule | None:
        """How many printed holds the rule "nearest" would have taken too."""
        agree = self.nearest_agree()
        return None if agree is None else NearestRule(*agree)


@dataclass(frozen=True, slots=True)
class ToRun:
    """Whether `clamber run` would carry a plan out: it asks for more than a task's checks may."""

    ok: bool
    objection: str | None
    """Why it would not: the first step and its limit."""
    command: str | None
    """What makes a plan that can be carried out, None where nothing does; TASK stands for the task's file where it has no name."""


@dataclass(frozen=True, slots=True, kw_only=True)
class CheckedPlan:
    """What came out when a plan was carried out again."""

    kind: Literal["plan"] = "plan"
    verdict: Annotated[Verdict, INLINE]
    to_run: ToRun | None
    """None where its robots have no contact dynamics."""


def check_plan(
    task: Task,
    plan: Plan,
    *,
    go_on: bool = False,
    asked: Ints | None = None,
    notes: tuple[str, ...] = (),
    label: str = "plan",
) -> Verdict:
    """Carry a plan out again, without whoever planned it, and judge every step.

    Args:
        task: The task to carry it out in, the plan's own or another.
        plan: The plan.
        go_on: Whether to go on past a violation.
        asked: Packed codes that the plan's grabs came from, shape (n,); where one says "nearest", the verdict
            tells what that would have taken in the same stance.
        notes: Handed through to the verdict.
        label: What errors call the plan.

    Raises:
        SpecError: If an action is none that the task's robot and board have.
        StartError: If the task's start violates a hard check.
    """
    family = plan_family(task)
    problem = family.problem(task)
    replay = problem.replay(plan.codes(task, label), go_on=go_on)
    nearest = [None] * len(plan.actions) if asked is None else family.nearest(task, problem, replay.stances, asked)
    hard = family.hard(task)
    rows = tuple(_judge(family, task, plan.actions[i], replay, i, hard, nearest[i]) for i in range(len(replay.reasons)))
    theirs = judge_outside(task, rows, [check.name for check in family.checks])
    rows = tuple(_with_outside(row, margins) for row, margins in zip(rows, theirs.rows, strict=True))
    held = [row for row in rows if row.ok]
    powers = [row.power for row in held if row.power is not None]
    last = replay.stances[-1] if go_on or replay.ok else replay.stances[-2]
    return Verdict(
        task=task.name,
        planner=plan.planner,
        ok=len(held) == len(plan.actions),
        length=len(plan.actions),
        steps=len(held),
        went_on=go_on,
        per_step=rows,
        goals=len(task.goals),
        goals_met=family.goals_met(last),
        max_torque=max((row.max_torque for row in held if row.max_torque is not None), default=0.0),
        max_power=max(powers, default=None),
        energy=family.duration(task) * sum(powers) if powers else None,
        pose=family.pose(task, last),
        pose_axes=family.pose_axes,
        holds=family.holds(task, last),
        checks=(*family.checks, *theirs.checks),
        hard=hard,
        notes=(*notes, *theirs.notes),
        units=units_of(task.document),
    )


def _with_outside(row: StepVerdict, margins: dict[str, float | None]) -> StepVerdict:
    """A step with what other packages' checks say of it."""
    if not margins:
        return row
    violated = (name for name, margin in margins.items() if margin is not None and margin < -TOLERANCE)
    return replace(row, margins=row.margins | margins, reported=(*row.reported, *violated))


def _judge(
    family: PlanFamily,
    task: Task,
    action: PlannedAction,
    replay: Replay,
    index: int,
    hard: tuple[str, ...],
    nearest: int | None,
) -> StepVerdict:
    after, row, reason = replay.stances[index + 1], replay.margins[index], int(replay.reasons[index])
    names = [check.name for check in family.checks]
    margins = {name: _limited(float(margin)) for name, margin in zip(names, row, strict=True)}
    violated = None if reason < 0 else family.checks[reason]
    whole = not np.isnan(row).any()
    return StepVerdict(
        step=index + 1,
        action=action,
        asked=_asked(action),
        ok=violated is None,
        check=None if violated is None else violated.name,
        reason=None if violated is None else _words(violated, float(row[reason])),
        hold=family.taken(task, after),
        nearest=nearest,
        max_torque=family.torque(after) if whole else None,
        power=family.power(after) if whole else None,
        margins=margins,
        reported=tuple(
            name for name, margin in zip(names, row, strict=True) if margin < -TOLERANCE and name not in hard
        ),
        pose=family.pose(task, after),
        holds=family.holds(task, after),
    )


def _asked(action: PlannedAction) -> int | str:
    if action.code is not None and action.gene is not None and action.gene.isdecimal():
        return int(action.gene)
    return action.title if action.code is None else action.code


def _limited(margin: float) -> float | None:
    return None if math.isnan(margin) or abs(margin) >= UNLIMITED else margin


def _words(check: Check, margin: float) -> str:
    unit = "" if check.unit == "1" else f" {check.unit}"
    if abs(margin) >= UNLIMITED:
        return f"{check.name}: there is no hold that the limb may take"
    return f"{check.name} is short by {-margin:.4g}{unit} ({check.meaning})"
