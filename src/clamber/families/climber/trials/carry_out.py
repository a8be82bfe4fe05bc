"""A task or a plan of a climber carried out as it is asked for: planned with room for the dynamics, rehearsed, climbed."""

from ....errors import PlannerError
from ....planning.problem.plan import Plan
from ....trials.run_request import RunRequest
from ..planning.task import LimbedTask
from .noise import NO_NOISE, read_noise
from .planning import plan_to_climb, replanner
from .rehearsal import rehearse
from .run_plan import ClimbRun, climbing_flaws, climbing_task, run_plan


def carry_out_climb(task: LimbedTask, plan: Plan | None, asked: RunRequest) -> ClimbRun:
    """Climb a plan, or the one that is found for the task.

    Raises:
        PlannerError: If there is no plan for the task that can be carried out.
        ClamberError: If something speaks against the plan, or the request names what there is not.
    """
    climb = climbing_task(task)
    flaws = climbing_flaws(climb, asked.plant)
    widths = read_noise(NO_NOISE, asked.noise)
    if plan is None:
        plan = plan_to_climb(
            climb,
            asked.planner,
            seconds=asked.plan_seconds,
            seed=asked.seed,
            rehearse=lambda task, plan: rehearse(task, plan, flaws),
        )
    if plan is None:
        raise PlannerError(asked.planner, climb.name, "it found no plan that can be carried out; nothing has moved")

    def tell(step: int, steps: int, title: str, clock: float) -> None:
        if asked.tell is not None:
            words = f"action {step} of {steps}: {title}, {clock:.0f} s on the robot's clock"
            asked.tell(words, (step - 1) / max(steps, 1))

    again = replanner(asked.planner, seconds=asked.plan_seconds, seed=asked.seed) if asked.replan else None
    return run_plan(climb, plan, flaws, noise=widths, seed=asked.seed, replan=again, log=asked.log, progress=tell)
