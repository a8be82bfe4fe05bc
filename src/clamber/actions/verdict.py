"""The verdict on a plan: carried out again action by action, every check of every step, and the first violation."""

import math
from dataclasses import dataclass, replace

import numpy as np

from ..statics.checks import Check
from ..statics.records import TOLERANCE, UNLIMITED
from ..tasks import Task
from ..types import Ints, Json
from ..units import DEGREE, INCH, OZ_IN
from .outside_checks import judge_outside
from .plan import Plan
from .plan_families import PlanFamily, plan_family
from .planned import PlannedAction
from .problem import Replay
from .step_verdict import StepVerdict


@dataclass(frozen=True, slots=True, kw_only=True)
class Verdict:
    """What came out when a plan was carried out again."""

    task: str
    planner: str
    ok: bool
    """Whether every action of the plan holds; reaching the goal is told apart (`reached`)."""
    length: int
    """Actions of the plan."""
    steps: int
    """Actions that hold: up to the first violation, or all of them where the replay went on."""
    went_on: bool
    """Whether the replay went on past violations."""
    per_step: tuple[StepVerdict, ...]
    """As far as the replay went; the violating step is the last where it did not go on."""
    goals: int
    """Goals of the task, sub-goals included."""
    goals_met: int
    max_torque: float
    """Largest joint torque of the actions that hold [N m]."""
    max_power: float
    """Largest electrical power that holding a stance takes [W]."""
    energy: float
    """Electrical energy of the actions that hold: power of each stance times the time of an action [J]."""
    pose: tuple[float, float, float]
    """Body at the end, world frame [m, m, rad]; before the violating action where the replay stopped there."""
    holds: dict[str, int]
    """Limb -> hold at the end, 0 if free."""
    checks: tuple[Check, ...]
    hard: tuple[str, ...]
    """Names of the checks that forbid an action; the others report."""
    notes: tuple[str, ...] = ()
    """What was read in a way that the reader should know of, such as a step size taken from the plan."""

    @property
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

    def to_json(self) -> Json:
        """Plain data; inches, degrees and oz-in where the key says so, margins in SI."""
        first, agree = self.first_violation, self.nearest_agree()
        x, y, theta = self.pose
        return {
            "ok": self.ok,
            "task": self.task,
            "planner": self.planner,
            "length": self.length,
            "steps": self.steps,
            "reached": self.reached,
            "goals": self.goals,
            "goals_met": self.goals_met,
            "first_violation": None if first is None else _violation(first),
            "max_torque_oz_in": self.max_torque / OZ_IN,
            "max_torque_Nm": self.max_torque,
            "max_power_W": self.max_power,
            "energy_J": self.energy,
            "final": {"x_in": x / INCH, "y_in": y / INCH, "theta_deg": theta / DEGREE, "holds": self.holds},
            "hard": list(self.hard),
            "warnings": {name: list(steps) for name, steps in self.warnings().items()},
            "nearest_rule": None if agree is None else {"agree": agree[0], "of": agree[1]},
            "notes": list(self.notes),
            "per_step": [row.to_json() for row in self.per_step],
        }


def _violation(row: StepVerdict) -> Json:
    margin = None if row.check is None else row.margins[row.check]
    return {"step": row.step, "action": row.asked, "check": row.check, "margin": margin, "reason": row.reason}


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
        max_power=max(powers, default=0.0),
        energy=family.duration(task) * sum(powers),
        pose=family.pose(last),
        holds=family.holds(task, last),
        checks=(*family.checks, *theirs.checks),
        hard=hard,
        notes=(*notes, *theirs.notes),
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
        pose=family.pose(after),
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
