"""The limbed climber's `CompiledProblem`, and the stance that its task starts from."""

import copy
import math
from collections.abc import Callable
from functools import cached_property
from typing import Final, Self

import numpy as np
import numpy.typing as npt

from ....errors import StartError
from ....planning.problem.arrays import ActionTable, CostToGoMap, Params
from ....planning.problem.code_limits import CodeLimits
from ....planning.problem.codes import ARGUMENT_MASK, MOVE, NEAREST, NONE, RANDOM, RELEASE, Code, pack
from ....planning.problem.codes import HOLD as HOLD_KIND
from ....planning.problem.family_kernels import family_kernels
from ....planning.problem.loops import replay
from ....planning.problem.problem import FEATURE_NAMES, CompiledProblem, Records
from ....shown_units import units_of
from ....types import Floats
from ..statics.checks import LIMBED_CHECKS
from ..statics.elbows import EVERY
from ..statics.records import PARAMS, STANCE
from .arrays import CHECKS, limbed_params
from .cost_to_go import STANCE_COSTS, body_pose, satisfies_goal, stance_cost
from .goals import FEATURES, done, measure
from .inventory import most_in_reach, whole_kinds
from .keys import bound, candidates, cell, key, key_length, restore
from .place_costs import way_fields
from .relaxed import with_bound
from .stance_pairs import dominating, heuristic_between, reflect
from .step import step
from .symmetry import mirrored_code, with_mirror
from .task import LimbedTask

FOOT_CHECKS: Final = ("limb_limb", "limb_body", "limb_peg")

family_kernels(
    PARAMS,
    step=step,
    candidates=candidates,
    key=key,
    restore=restore,
    measure=measure,
    bound=bound,
    dominating=dominating,
    reflect=reflect,
    done=done,
    cell=cell,
    body_pose=body_pose,
    satisfies_goal=satisfies_goal,
    stance_cost=stance_cost,
    heuristic_between=heuristic_between,
)


class LimbedProblem(CompiledProblem):
    """A limbed climber's task, ready for planners."""

    stance_costs = STANCE_COSTS

    def __init__(
        self, task: LimbedTask, actions: ActionTable, *, every_check: bool = False, threads: int | None = None
    ) -> None:
        """Bind a task.

        Args:
            task: The task.
            actions: The inventory's table.
            every_check: Evaluate the checks that only report, too; planners leave them out.
            threads: Threads for batches; None for one a core.

        Raises:
            StartError: If the start stance violates a hard check.
        """
        params = limbed_params(task, every_check=every_check)
        start = start_stance(task, params)
        self.task = task
        super().__init__(params, start, actions, CHECKS, FEATURE_NAMES, threads)
        assert len(FEATURE_NAMES) == FEATURES

    @cached_property
    def limits(self) -> CodeLimits:
        """The codes, and the indices in stances, that there are here."""
        return limbed_limits(self.task)

    def informed(self, is_late: Callable[[], bool] = lambda: False) -> Self:
        """The same problem whose `bound` is the fewest actions of the relaxed problem, and which knows its own symmetry."""
        other = copy.copy(self)
        other.params = with_bound(with_mirror(self.params), is_late)
        return other

    def mirrored(self, code: int) -> int:
        """The mirror image of an action, in a problem that is its own mirror image."""
        return mirrored_code(self.params, code)

    @property
    def incomplete(self) -> str | None:
        """`rules.allowed` may name single grabs; exact search knows grabs as a whole only."""
        _, whole = whole_kinds(self.task)
        return (
            None
            if whole
            else "rules.allowed names single grabs or releases; exact search takes them as kinds: grab, release"
        )

    def ways(self) -> CostToGoMap:
        """The map of the wall."""
        return way_fields(self.task)

    @property
    def landmarks(self) -> int:
        """Holds of the board."""
        return len(self.task.world.holds)

    @property
    def estimated_stances(self) -> float:
        """Lattice places about the holds, times angles, times what the limbs may hold there on average; infinite with hangs."""
        rules, step = self.task.rules, self.task.step
        if rules.max_hangs != 0 or "hangs" not in rules.hard:
            return math.inf
        points = self.task.world.positions()
        reach = max(limb.length for limb in self.task.robot.limbs)
        width, height = np.ptp(points, axis=0) + reach
        stances = width * height / step.length**2 * round(math.tau / step.angle)
        for limb in self.task.robot.limbs:
            stances *= 1.0 + min(len(points), len(points) * math.pi * limb.length**2 / (width * height))
        return float(stances)

    @property
    def key_words(self) -> int:
        """Integers of a stance's key: more where checks that read free feet are hard."""
        fenced = "keep_out" in self.task.rules.hard and bool(self.task.world.keep_out)
        reads_feet = fenced or any(name in self.task.rules.hard for name in FOOT_CHECKS)
        return key_length(len(self.task.robot.limbs), self.task.rules.branch == "kept", reads_feet)

    @cached_property
    def branching(self) -> int:
        """Most actions from one stance: six moves, and per limb a release and every hold that can be in reach at once."""
        return 6 + sum(1 + most for most in most_in_reach(self.task))

    def without_more_hangs(self, stance: Records) -> Self:
        """The same problem where no way may hang more often than the way to `stance` did, so that bodies stay on its lattice."""
        if "hangs" not in self.task.rules.hard:
            return self
        return self.with_rules(max_hangs=int(stance["hangs"][0]))

    def without_goals(self) -> tuple[Params, Records]:
        """As in every family; laps aren't counted, or a ring would have no last stance."""
        params, start = super().without_goals()
        params.record["circles"] = 0
        start["laps"], start["bearing"] = 0, 0.0
        return params, start

    @property
    def pose_words(self) -> int:
        """The body's pose and a hold for each limb."""
        return 3 + len(self.task.robot.limbs)

    def resolve(self, codes: npt.NDArray[np.int32], stances: Records) -> npt.NDArray[np.int32]:
        """Codes with "nearest" and "random" replaced by the hold that each took."""
        named = codes.copy()
        for i, code in enumerate(codes):
            opened = Code.of(int(code))
            taken = int(stances["resolved"][i + 1])
            if opened.kind in ("nearest", "random") and taken >= 0:
                named[i] = pack(HOLD_KIND, opened.limb, taken)
        return named

    def relative(self, codes: npt.NDArray[np.int32], stances: Records) -> npt.NDArray[np.int32]:
        """Codes with every named hold replaced by its rank among those in reach where it was taken; others stay."""
        ranked = codes.copy()
        for i, code in enumerate(codes):
            opened = Code.of(int(code))
            if opened.kind != "hold":
                continue
            here = self.rebind(self.actions, stances[i : i + 1])
            before = None
            for rank in range(1, len(self.task.world.holds) + 1):
                nearest = pack(NEAREST, opened.limb, rank)
                taken = int(here.replay(np.array([nearest], np.int32), go_on=True).stances["resolved"][-1])
                if taken == opened.argument:
                    ranked[i] = nearest
                if taken in (opened.argument, before, -1):
                    break
                before = taken
        return ranked


def limbed_limits(task: LimbedTask) -> CodeLimits:
    """The codes and indices of a climber's task. A rank may be any, for "nearest" clips it."""
    limbs, holds = len(task.robot.limbs), len(task.world.holds)
    return CodeLimits(
        label=f"task '{task.name}'",
        kinds={
            NONE: (1, 0, 0),
            MOVE: (1, 0, 5),
            RELEASE: (limbs, 0, 0),
            NEAREST: (limbs, 1, ARGUMENT_MASK),
            HOLD_KIND: (limbs, 0, holds - 1),
            RANDOM: (limbs, 0, 0),
        },
        fields={
            "hold": (-1, holds - 1, limbs),
            "left": (-1, holds - 1, limbs),
            "in_use": (-1, limbs - 1, 1),
            "stage": (0, len(task.goals), 1),
            "resolved": (-1, holds - 1, 1),
        },
    )


def start_stance(task: LimbedTask, params: Params) -> Records:
    """The task's start as an array of one stance record."""
    start = np.zeros(1, STANCE)
    start["hold"] = -1
    start["left"] = -1
    start["resolved"] = -1
    number_index = {int(number): index for index, number in enumerate(task.world.numbers())}
    names = task.robot.limb_names
    last = 0
    for i, limb in enumerate(task.robot.limbs):
        number = task.start.holds.get(limb.name, 0)
        if number:
            start["hold"][0, i] = number_index[number]
            last = i
        else:
            start["foot"][0, i] = task.start.feet[limb.name]
    start["in_use"] = last if task.start.in_use is None else names.index(task.start.in_use)
    start["elbows"] = EVERY
    start["x"], start["y"] = task.start.x, task.start.y
    start["bearing"] = params.record["centre_angle"] if params.record["circles"] else 0.0
    stance, margins, reason = judge_stance(params.record, start)
    if reason >= 0:
        check, margin = LIMBED_CHECKS[reason], float(margins[reason])
        short = units_of(task.document).signed(-margin, check.unit).removeprefix("+")
        raise StartError(task.name, CHECKS[reason], margin, check.meaning, short)
    stance["count"] = 0
    return stance


def judge_stance(record: np.void, start: Records) -> tuple[Records, Floats, int]:
    """A stance as the action that changes nothing leaves it, its margins, shape (checks,), and the hard check it violates, -1 for none.

    It stands beside the family's kernels, so that they are registered for whoever asks this first.
    """
    stances = np.zeros(2, STANCE)
    margins = np.zeros((1, len(CHECKS)))
    reasons = np.zeros(1, np.int32)
    replay(record, start, np.array([pack(0)], np.int32), True, stances, margins, reasons)
    return stances[1:], margins[0], int(reasons[0])
