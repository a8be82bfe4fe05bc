"""Plans climbed in simulation before anything moves, pegs a little off: no check of single stances sees all of a climb."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np

from ....interrupts import passed_on
from ....planning.problem.plan import Plan
from ....sim.limb_flaws import LimbFlaws
from ....trials.dynamics import RunEvents
from ..execution.climb_report import ClimbReport
from ..planning.task import LimbedTask
from .noise import NO_NOISE, Noise, read_noise
from .run_plan import action_told, run_plan

VALIDATION_NOISE: Final = read_noise(NO_NOISE, ("peg_error=3mm",))
"""What deviates in a rehearsal."""
SEEDS: Final = (900_001, 900_002, 900_003)
"""Of its climbs: none that trials begin with."""


@dataclass(frozen=True, slots=True, order=True)
class PlanValidation:
    """What came of a plan's rehearsal; more is better."""

    climbed: int
    """Climbs that were carried out whole."""
    share: float
    """Actions carried out, of all, in the mean [-]."""
    failed: int | None = field(default=None, compare=False)
    """Step of the grab that the first climb that failed did not come beyond; None where there is none."""

    @property
    def flawless(self) -> bool:
        """Whether every climb was carried out whole."""
        return self.climbed == len(SEEDS)


def validations(
    flaws: LimbFlaws, events: RunEvents, noise: Noise = VALIDATION_NOISE
) -> Callable[[LimbedTask, Plan], PlanValidation]:
    """What climbs by a plan a few times, without asking for another on the way; after a fall only as often as it could still be flawless.

    Args:
        flaws: Of the plant, as the controller believes them.
        events: Told of each climb how far it is.
        noise: By how much pegs and plant differ from that.
    """

    def validate_plan(task: LimbedTask, plan: Plan) -> PlanValidation:
        climbed, shares, failed = 0, [], None
        what = f"rehearsing a plan of {len(plan.actions)} actions in simulation"
        for climb, seed in enumerate(SEEDS):

            def tell(*action: Any, climb: int = climb) -> None:
                share = (climb + action_told(*action)[1]) / len(SEEDS)
                events.step(f"{what}, climb {climb + 1} of {len(SEEDS)}", share)

            with passed_on():
                report = run_plan(task, plan, flaws, noise=noise, seed=seed, progress=tell).report
            climbed += report.done
            shares.append(sum(action.outcome == "ok" for action in report.actions) / max(1, len(plan.actions)))
            if not report.done:
                failed = grab_at_fault(plan, report)
                break
        return PlanValidation(climbed, float(np.mean(shares)), failed)

    return validate_plan


def grab_at_fault(plan: Plan, report: ClimbReport) -> int | None:
    """Step of the grab with which a climb went wrong, see `grab_before`; None where no action was carried out."""
    return grab_before(plan, report.actions[-1].first) if report.actions else None


def grab_before(plan: Plan, ended: int) -> int | None:
    """Step of the grab with which a climb went wrong that ended with a step: that one, that of the hook that stays wedged, else the latest.

    None where no grab has led to where it ended.
    """
    last = plan.actions[ended - 1]
    for step in range(ended, 0, -1):
        action = plan.actions[step - 1]
        if action.kind == "grab" and (last.kind != "release" or action.limb == last.limb):
            return step
    return None
