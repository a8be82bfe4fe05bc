"""Plans of two-frame walkers: packed codes as named actions and back."""

from collections.abc import Mapping
from typing import Final

import numpy as np

from ....errors import describe_choices
from ....planning.problem.code_limits import CodeLimits
from ....planning.problem.codes import MOVE, NONE, RELEASE, Code, pack
from ....planning.problem.problems import ActionError, PlanCost, PlanFamily, PlannedAction, Posed
from ..robot import FRAMES
from ..statics.checks import WALKER_CHECKS
from .problem import MOVES, WalkerProblem, stride_lengths, walker_limits, walker_table
from .task import WalkerTask


class WalkerPlans(PlanFamily):
    """How plans of two-frame walkers are named, replayed and reported; limbs are frames, and nothing is held."""

    checks = WALKER_CHECKS

    def posed(self, task: WalkerTask, threads: int | None, filters: bool) -> Posed:
        """The task as a problem with the hard checks alone."""
        table = walker_table(stride_lengths(task))
        return Posed(WalkerProblem(task, table, threads=threads), len(table))

    def limits(self, task: WalkerTask) -> CodeLimits:
        """See `PlanFamily`."""
        return walker_limits(task)

    def sizes(self, task: WalkerTask) -> Mapping[str, float]:
        """Half a stroke, the guarded singular distance, a tenth of the feet's circle, half of a support triangle, the legs' stroke."""
        mechanism, legs = task.robot.mechanism, task.robot.legs
        feet = min(legs.radius_delta, legs.radius_y)
        return {
            "stroke": 0.5 * mechanism.stroke,
            "singular": mechanism.guard * mechanism.singular_distance(0.0),
            "foothold": max(task.rules.clearance, 0.1 * feet),
            "balance": 0.5 * feet,  # inradius of a triangle over its circumradius
            "legs": legs.stroke,
        }

    def problem(self, task: WalkerTask) -> WalkerProblem:
        """See `PlanFamily`."""
        return WalkerProblem(task, walker_table(), every_check=True, threads=1)

    def action(self, task: WalkerTask, code: int, after: np.void, gene: str | None) -> PlannedAction:
        """A packed code as a named action; the frame that moved, or lifted in a swap, does not stand afterwards."""
        opened = Code.of(code)
        lifted = FRAMES[1 - int(after["stands"])]
        if opened.kind == "move":
            return PlannedAction(kind="move", limb=lifted, delta=self.move_delta(task, opened.argument), gene=gene)
        if opened.kind == "release":
            return PlannedAction(kind="release", limb=lifted, gene=gene)
        return PlannedAction(kind="none", gene=gene)

    def code(self, task: WalkerTask, action: PlannedAction) -> int:
        """The packed code of a named action; which frame it moves follows from the stance.

        Raises:
            ActionError: If a walker has no such action.
        """
        if action.kind == "none":
            return pack(NONE)
        if action.limb is not None and action.limb not in FRAMES:
            raise ActionError("limb", f"must be a frame: {describe_choices(action.limb, FRAMES)}")
        if action.kind == "release":
            return pack(RELEASE)
        if action.kind == "move":
            return pack(MOVE, 0, self.move_argument(task, action.delta))
        raise ActionError("kind", "a walker's actions are none, move and release")

    def module(self, task: WalkerTask, code: int) -> str:
        """Name of a code: the move, or "swap"."""
        opened = Code.of(code)
        return MOVES[opened.argument] if opened.kind == "move" else "swap"

    def pose(self, task: WalkerTask, stance: np.void) -> tuple[float, float, float]:
        """Place [m] and angle [rad] of the Delta-frame, world frame."""
        return float(stance["x"]), float(stance["y"]), float(stance["angle"])

    def costs(self, task: WalkerTask) -> Mapping[str, PlanCost]:
        """The time that a walk takes, and how near it comes to where the mechanism is singular."""
        return {
            "time": PlanCost(feature="effort", title="takes", unit="s", digits=0),
            "strain": PlanCost(feature="peak", title="nearest to a singular place", unit="of 1", digits=2),
        }


PLANS: Final = WalkerPlans()
