"""A walk, or a task or a plan of a walker, carried out as it is asked for."""

from ....errors import PlannerError
from ....planning.planners import plan_task
from ....planning.problem.plan import Plan
from ....trials.run_request import RunRequest
from ..planning.task import WalkerTask
from ..planning.walk import Walk
from .noise import named_walk_noise, read_walk_noise
from .planned import careful, lay_plan, walk_of
from .run_walk import WalkRun, run_walk, walk_flaws


def carry_out_walk(work: Walk | WalkerTask, plan: Plan | None, asked: RunRequest) -> WalkRun:
    """Walk a walk, a plan, or the plan that is found for the task.

    Raises:
        PlannerError: If there is no plan for the task that can be walked.
        ClamberError: If something speaks against the plan, or the request names what there is not.
    """
    if isinstance(work, Walk):
        walk, lay = work, None
    else:
        task = work
        if plan is None:
            task = careful(task)
            result = plan_task(task, asked.planner, seed=asked.seed, seconds=asked.plan_seconds)
            if not result.has_plan:
                raise PlannerError(asked.planner, task.name, f"no plan that can bear to be walked: {result.reason}")
            plan = result.plan
        walk, lay = walk_of(task), lay_plan(task, plan)

    def tell(step: int, way: float, whole: float) -> None:
        if asked.tell is not None:
            asked.tell(f"step {step}: {way:.2f} of {whole:.2f} m", way / whole if whole > 0.0 else None)

    widths = read_walk_noise(named_walk_noise("none"), asked.noise)
    return run_walk(walk, walk_flaws(walk, asked.plant), noise=widths, seed=asked.seed, lay=lay, progress=tell)
