"""A plan made ready to be carried out: its stances, the side of every elbow, and what forbids it before anything moves."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from ....errors import ClamberError
from ....planning.problem.plan import Plan
from ....planning.problem.problem import Replay
from ....planning.problem.problems import PlannedAction, plan_family
from ....shown_units import units_of
from ....tasks.library import change_task, name_to_type
from ....types import Floats, Ints, Records
from ..planning.task import LimbedTask
from ..statics.elbows import open_branches
from .body_gains import USUAL_WEIGHT
from .elbows import choose_elbows, load_capacity

PARTS: Final = ("robot", "board")
"""Of a task, what a plan is bound to."""
HANGING: Final = 1e-9
"""A body that turns by more than this in an action which is no turn swings to hang [rad]."""

WEAKER: Final = 3.0
"""By how much the worst of carrying limbs may be worse off with an elbow on the other side [N]."""


class PlanRefusedError(ClamberError):
    """A plan is not carried out: names the plan, the step and the reason."""

    def __init__(self, plan: str, step: int | None, reason: str, task: str = "TASK") -> None:
        super().__init__(plan, step, reason, task)
        self.plan, self.step, self.reason, self.task = plan, step, reason, task

    @property
    def in_words(self) -> str:
        """What speaks against the plan, without its name."""
        return self.reason if self.step is None else f"step {self.step}: {self.reason}"

    def __str__(self) -> str:
        where = ": " if self.step is None else ", "
        return (
            f"{self.plan}{where}{self.in_words}; nothing has moved (`clamber plan {self.task} --to-run` makes a plan "
            "that can be carried out; --force carries this one out all the same)"
        )


@dataclass(frozen=True, slots=True, eq=False)
class ExecutablePlan:
    """A plan, carried out on paper."""

    task: LimbedTask
    actions: tuple[PlannedAction, ...]
    stances: Records
    """The start, and the stance after every action, shape (n + 1,)."""
    elbows: Ints
    """Side of each limb's elbow that serves until it leaves its hold, +1, -1, or 0 where it is free, shape (n + 1, limbs)."""
    elbow_costs: Floats
    """What counts against each stance: hooks and motors that lack newtons, links that touch holds, shape (n + 1,); see `elbows`."""
    objections: tuple[PlanRefusedError, ...] = ()
    """What speaks against it, the first step first."""

    def refusal(self) -> PlanRefusedError:
        """The first objection, with the name of the task as commands take it."""
        first = self.objections[0]
        return PlanRefusedError(first.plan, first.step, first.reason, name_to_type(self.task, climbable))

    def pose(self, step: int) -> Floats:
        """Body x, y [m], theta [rad] after a step, shape (3,)."""
        stance = self.stances[step]
        return np.array((stance["x"], stance["y"], stance["angle"]))

    def holds(self, step: int) -> dict[str, int]:
        """Limb -> number of its hold after a step, 0 if free."""
        return plan_family(self.task).holds(self.task, self.stances[step])

    def idle(self, step: int) -> str | None:
        """The limb on a hold that carries nothing after a step."""
        stance = self.stances[step]
        for i, limb in enumerate(self.task.robot.limbs):
            if stance["hold"][i] >= 0 and not int(stance["carriers"]) >> i & 1:
                return limb.name
        return None

    def stays(self, i: int, step: int) -> range:
        """The steps, from one after which a limb is on a hold, until it leaves that hold."""
        holds = self.stances["hold"][:, i]
        end = step
        while end < len(holds) and holds[end] == holds[step]:
            end += 1
        return range(step, end)

    def serves(self, legs: Records, i: int, step: int, elbow: int) -> bool:
        """Whether a limb that takes a hold at a step could keep its elbow on a side (+1, -1) until it leaves.

        By the plan's checks, and by what hooks and motors of the robot's `legs`, at `USUAL_WEIGHT`, bear: a hook that is taken from the
        wrong side may pull up where it is to carry.
        """
        n, bit = len(self.task.robot.limbs), 1 if elbow > 0 else 2
        return all(
            open_branches(self.stances[k]["elbows"], n, i) & bit and self._bears(legs, i, k, elbow)
            for k in self.stays(i, step)
        )

    def _bears(self, legs: Records, i: int, step: int, elbow: int) -> bool:
        """Whether carriers would hold after a step, hardly worse than as chosen, with one limb's elbow on a side."""
        robot, places, chosen = self.task.robot.at_weight(USUAL_WEIGHT), self.task.world.positions(), self.elbows[step]
        other = np.where(np.arange(len(chosen)) == i, elbow, chosen)
        least = min(0.0, load_capacity(robot, legs, places, self.stances[step], chosen)) - WEAKER
        return load_capacity(robot, legs, places, self.stances[step], other) >= least

    def groups(self) -> list[tuple[int, int]]:
        """First and last step, from 1, of what is carried out in one go: like moves of the body in a row, else one action."""
        made: list[tuple[int, int]] = []
        for step, action in enumerate(self.actions, 1):
            before = self.actions[step - 2] if step > 1 else None
            if made and before is not None and action.kind == "move" == before.kind and action.delta == before.delta:
                made[-1] = made[-1][0], step
            else:
                made.append((step, step))
        return made


def climbable(task: LimbedTask) -> LimbedTask:
    """The task under the rules that can be carried out: hooks only pull, elbows keep their side while they hold.

    The body may hang on one limb only as often as the task says in so many words: any number of hangs, the usual rule, becomes none.

    Raises:
        SpecError: If the task cannot have them.
    """
    hard = task.rules.hard if "hook" in task.rules.hard else (*task.rules.hard, "hook")
    names = ", ".join(f'"{name}"' for name in hard)
    changed = change_task(
        task, [f"rules.hard=[{names}]", "rules.branch=kept", f"rules.max_hangs={max(task.rules.max_hangs, 0)}"]
    )
    assert isinstance(changed, LimbedTask)  # rules never change the family
    return changed


def lay_course(task: LimbedTask, plan: Plan, label: str = "plan") -> ExecutablePlan:
    """A plan replayed in a task under the rules that can be carried out.

    Args:
        task: Robot, board and start as they are.
        plan: The plan.
        label: What errors call it.

    Raises:
        PlanRefusedError: If the plan is for another robot or another board.
        SpecError: If an action is none that the task's robot and board have.
        StartError: If the start violates a hard check.
    """
    strict = climbable(task)
    replay = _replayed(strict, plan, label)
    elbows, elbow_costs = choose_elbows(task.robot, task.world, replay.stances)
    return ExecutablePlan(
        strict, plan.actions, replay.stances, elbows, elbow_costs, _objections(strict, plan, replay, label)
    )


def objections_to(task: LimbedTask, plan: Plan, label: str = "plan") -> tuple[PlanRefusedError, ...]:
    """What speaks against carrying a plan out, the first step first.

    Args:
        task: Under the rules that can be carried out.
        plan: The plan.
        label: What errors call it.

    Raises:
        SpecError: If an action is none that the task's robot and board have.
        StartError: If the start violates a hard check.
    """
    return _objections(task, plan, _replayed(task, plan, label), label)


def _replayed(task: LimbedTask, plan: Plan, label: str) -> Replay:
    return plan_family(task).problem(task).replay(plan.codes(task, label), go_on=True)


def _objections(task: LimbedTask, plan: Plan, replay: Replay, label: str) -> tuple[PlanRefusedError, ...]:
    objections = [
        PlanRefusedError(label, None, f"the plan is for another {part} than that of task '{task.name}'")
        for part in PARTS
        if plan.hashes.get(part) != task.hashes[part]
    ]
    family, units = plan_family(task), units_of(task.document)
    for step, reason in enumerate(replay.reasons, 1):
        if reason >= 0:
            check = family.checks[int(reason)]
            margin = units.signed(float(replay.margins[step - 1, int(reason)]), check.unit)
            words = f"{plan.actions[step - 1].title}: {check.name} is {margin} ({check.meaning})"
            objections.append(PlanRefusedError(label, step, words))
    return tuple(objections)


def swings(course: ExecutablePlan, step: int) -> bool:
    """Whether an action leaves the body to one limb, or moves it while it hangs."""
    before, after = course.stances[step - 1], course.stances[step]
    # a grab from another hold may hang on the way with no turn at all: where the weight is below the hold that stays
    return bool(
        abs(float(after["turned"])) > HANGING or after["hangs"] > before["hangs"] or alone(course, step) is not None
    )


def alone(course: ExecutablePlan, step: int) -> int | None:
    """Index of the limb that alone holds after a step; None where there are more."""
    held = [i for i in range(len(course.task.robot.limbs)) if course.stances[step]["hold"][i] >= 0]
    return held[0] if len(held) == 1 else None


def names_of(objections: Sequence[PlanRefusedError]) -> list[str]:
    """Objections in short, for a log."""
    return [f"{'plan' if one.step is None else f'step {one.step}'}: {one.reason}" for one in objections]
