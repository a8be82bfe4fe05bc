"""Polish a plan as a value: whoever made it, out comes a plan that is never longer."""

import time
from dataclasses import replace

from ..errors import SpecError
from ..tasks import Task
from .problem.plan import Plan
from .problem.problems import plan_family, pose_problem
from .progress import Listener, Shortening
from .result import PlanResult
from .shorten import EFFORT, WIDTH, is_plan, shorten


def polish_plan(
    task: Task,
    plan: Plan,
    *,
    width: int = WIDTH,
    effort: int = EFFORT,
    seconds: float | None = None,
    progress: Listener | None = None,
    label: str = "plan",
) -> PlanResult:
    """Make a plan shorter (`planning.shorten`).

    Args:
        task: The task to carry it out in.
        plan: A plan that holds and reaches the goal; what comes after the goal is left out.
        width, effort, seconds: As in `shorten`.
        progress: Called now and then.
        label: What errors call the plan.

    Returns:
        The plan ("found"; "optimal" where every shorter one was ruled out).

    Raises:
        SpecError: If the plan breaks a hard check on its way to the goal, or does not get there.
    """
    started = time.monotonic()
    problem = pose_problem(task).problem
    codes = plan.codes(task, label)
    stances = problem.replay(codes).stances
    end = next((i for i in range(len(stances)) if problem.is_done(stances[i : i + 1])), len(codes))
    if not is_plan(problem, codes[:end]):
        allowed = "must hold up to the goal and reach it; `clamber check` says where it does not"
        raise SpecError(label, "actions", f"{len(codes)} actions", allowed)

    def tell(length: int) -> None:
        if progress is not None:
            progress(Shortening(length))

    done = shorten(problem, codes[:end], width=width, effort=effort, seconds=seconds, tell=tell)
    family = plan_family(task)
    after = problem.replay(done.codes).stances[1:]
    cut = len(codes) - len(done.codes)
    reason = f"{len(codes)} actions before, {cut} fewer now" if cut else "no shorter plan was found about it"
    made = Plan.of_codes(task, done.codes, seed=plan.seed, planner=f"{plan.planner}, polished" if cut else plan.planner)
    return PlanResult(
        status="optimal" if done.complete else "found",
        plan=made if cut else replace(plan),
        task=task,
        reason=reason,
        evaluations=0,
        checks=done.checks,
        seconds=time.monotonic() - started,
        seed=plan.seed or 0,
        planner=made.planner,
        max_torque=max((family.torque(stance) for stance in after), default=0.0),
        lower_bound=len(done.codes) if done.complete else None,
        stances=done.stances,
        model=family.model(task) if done.complete else "",
        first_length=len(codes),
    )
