"""One trial: a planner, a board, a seed. Runs in a worker."""

from functools import cache

from ..errors import ClamberError
from ..planning.budgets import Allowance, Contender
from ..planning.planners import PLANNERS
from ..tasks import load_task, task_from_document
from ..types import Json

TINY: Json = {"seed": 0, "threads": 1}
REFUSED = "refused"
"""Status of a trial whose planner can't take the task."""


def run_trial(item: Json) -> Json:
    """Plan once, and check the plan.

    Args:
        item: `document` of the task, `planner`, `options`.

    Returns:
        What the planner answered: `status`, `reason`, `length` (None without a plan that holds up to the goal), `first_length`,
        `cost` (actions judged up to the first plan, or in all), `checks`, `seconds`, `lower_bound`.
    """
    load_machine_code(item["planner"])
    task = task_from_document(item["document"])
    try:
        result = PLANNERS[item["planner"]](task, threads=1, **item["options"])
    except ClamberError as error:
        return {"status": REFUSED, "reason": str(error), "length": None, "first_length": None, "cost": 0, "checks": 0,
                "seconds": 0.0, "lower_bound": None}  # fmt: skip
    planned = result.status in ("found", "optimal")
    if planned:
        verdict = result.check()
        assert verdict.ok and verdict.reached, f"{item['planner']} gave a plan that does not hold on {task.name}"
    first = result.first_checks
    return {
        "status": result.status,
        "reason": result.reason,
        "length": result.length if planned else None,
        "first_length": result.first_length if planned else None,
        "cost": first if planned and first is not None else result.checks,
        "checks": result.checks,
        "seconds": result.seconds,
        "lower_bound": result.lower_bound,
    }


@cache
def load_machine_code(planner: str) -> None:
    """Plan something tiny, once a process, so that no trial's time counts what loading the kernels takes, or compiling them."""
    tiny = load_task("ladder", ("rules.max_hangs=0", "goal.y_min=12in"))
    limits = Contender(name=planner, planner=planner).limits(Allowance(checks=2000, seconds=0.1, patience=1.0))
    PLANNERS[planner](tiny, threads=1, **limits)
