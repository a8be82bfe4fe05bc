"""A plan made ready to be carried out: its stances, the side of every elbow, and what forbids it before anything moves."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from ...actions.plan import Plan
from ...actions.plan_families import plan_family
from ...actions.planned import PlannedAction
from ...errors import ClamberError
from ...tasks.library import change_task
from ...tasks.limbed import LimbedTask
from ...types import Floats, Ints, Records

PARTS: Final = ("robot", "board")
"""Of a task, what a plan is bound to."""
GRAB_Y: Final = 5
"""Place of the grab direction's y in a stance's solution of a limb, for branch 0."""
SOLVED: Final = 5
"""Numbers of one branch there."""
CHANGE: Final = 0.4
"""What a change of side counts, where 1 is a hook that pulls sideways instead of down [-]."""
SIDEWAYS: Final = 0.15
"""A hook whose pull is less downwards than this holds no weight that hangs straight down [-]."""
BARRED, POOR = 1e3, 10.0
"""What counts a side that the plan's checks forbid, and one that holds no such weight."""
HANGING: Final = 1e-9
"""A body that turns by more than this in an action which is no turn swings to hang [rad]."""


class PlanRefusedError(ClamberError):
    """A plan is not carried out: names the plan, the step and the reason."""

    def __init__(self, plan: str, step: int | None, reason: str) -> None:
        super().__init__(plan, step, reason)
        self.plan, self.step, self.reason = plan, step, reason

    def __str__(self) -> str:
        where = "" if self.step is None else f", step {self.step}"
        return f"{self.plan}{where}: {self.reason}; nothing has moved (--force carries it out all the same)"


@dataclass(frozen=True, slots=True, eq=False)
class Course:
    """A plan, carried out on paper."""

    task: LimbedTask
    actions: tuple[PlannedAction, ...]
    stances: Records
    """The start, and the stance after every action, shape (n + 1,)."""
    elbows: Ints
    """Side of each limb's elbow that serves until it leaves its hold, +1, -1, or 0 where it is free, shape (n + 1, limbs)."""
    objections: tuple[PlanRefusedError, ...] = ()
    """What speaks against it, the first step first."""

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
    """The task under the rules that can be carried out: hooks only pull, elbows keep their side while they hold, no swings.

    Raises:
        SpecError: If the task cannot have them.
    """
    hard = task.rules.hard if "hook" in task.rules.hard else (*task.rules.hard, "hook")
    names = ", ".join(f'"{name}"' for name in hard)
    changed = change_task(task, [f"rules.hard=[{names}]", "rules.branch=kept", "rules.max_hangs=0"])
    assert isinstance(changed, LimbedTask)  # rules never change the family
    return changed


def lay_course(task: LimbedTask, plan: Plan, label: str = "plan") -> Course:
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
    objections = [
        PlanRefusedError(label, None, f"the plan is for another {part} than that of task '{task.name}'")
        for part in PARTS
        if plan.hashes.get(part) != task.hashes[part]
    ]
    family = plan_family(strict)
    replay = family.problem(strict).replay(plan.codes(strict, label), go_on=True)
    for step, reason in enumerate(replay.reasons, 1):
        if reason >= 0:
            check = family.checks[int(reason)]
            margin = float(replay.margins[step - 1, int(reason)])
            unit = "" if check.unit == "1" else f" {check.unit}"
            words = f"{plan.actions[step - 1].title}: {check.name} is {margin:.4g}{unit} ({check.meaning})"
            objections.append(PlanRefusedError(label, step, words))
    elbows = _elbows(replay.stances, [limb.end.kind for limb in task.robot.limbs])
    return Course(strict, plan.actions, replay.stances, elbows, tuple(objections))


def _elbows(stances: Records, kinds: Sequence[str]) -> Ints:
    """A side for each stay on a hold that serves all of it: as few changes as can be, then what suits the end effector.

    An elbow that passes to the other side throws the body about, so a limb changes only where it must, or gains much by it.
    """
    sides: Ints = np.zeros((len(stances), len(kinds)), np.int32)
    for i, kind in enumerate(kinds):
        runs = _runs(stances["hold"][:, i])
        best = np.zeros((len(runs) + 1, 2))
        taken = np.zeros((len(runs), 2), np.int32)
        for k in range(len(runs) - 1, -1, -1):  # from the last stay back
            for branch in (0, 1):
                onward = [best[k + 1, after] + (CHANGE if after != branch else 0.0) for after in (0, 1)]
                taken[k, branch] = int(np.argmin(onward))
                best[k, branch] = _drawback(stances, i, runs[k], branch, kind) + min(onward)
        branch = int(np.argmin(best[0]))
        for k, (first, last) in enumerate(runs):
            sides[first : last + 1, i] = 1 if branch == 0 else -1
            branch = int(taken[k, branch])
    return sides


def _drawback(stances: Records, i: int, run: tuple[int, int], branch: int, kind: str) -> float:
    """What speaks against a side for a stay: that it is not open to the end, or what its end effector has against it."""
    first, last = run
    if not int(stances["open"][last, i]) >> branch & 1:
        return BARRED
    return DRAWBACKS[kind](stances[first : last + 1], i, branch)


def _off_top(stay: Records, i: int, branch: int) -> float:
    """How little a hook is on top at the worst."""
    down = -float(np.max(stay["solved"][:, i, GRAB_Y + SOLVED * branch]))
    return 1.0 - down + (POOR if down < SIDEWAYS else 0.0)


def _off_plan(stay: Records, i: int, branch: int) -> float:
    """In how much of the stay the plan has taken, and judged, the other side: a gripper may hold from anywhere."""
    return float(np.mean(stay["branch"][:, i] != branch))


DRAWBACKS: Final[dict[str, Callable[[Records, int, int], float]]] = {
    "hook": _off_top,
    "foot": _off_top,
    "gripper": _off_plan,
}
"""Kind of end effector -> what it has against a side of the elbow for a stay on a hold."""


def _runs(holds: Ints) -> list[tuple[int, int]]:
    """First and last stance of each stay on one hold."""
    runs: list[tuple[int, int]] = []
    for step, hold in enumerate(holds):
        if hold < 0:
            continue
        if step and runs and holds[step - 1] == hold:
            runs[-1] = runs[-1][0], step
        else:
            runs.append((step, step))
    return runs


def swings(course: Course, step: int) -> bool:
    """Whether an action lets the body swing to hang on one limb."""
    return abs(float(course.stances[step]["turned"])) > HANGING


def names_of(objections: Sequence[PlanRefusedError]) -> list[str]:
    """Objections in short, for a log."""
    return [f"{'plan' if one.step is None else f'step {one.step}'}: {one.reason}" for one in objections]
