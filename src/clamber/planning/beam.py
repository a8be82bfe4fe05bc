"""The beam planner as a whole: a task in, a plan or the furthest stance out."""

from dataclasses import replace
from typing import Any, Final

from ..tasks import Task
from .beam_layers import Reached, search_layers
from .problem.plan import Plan
from .problem.problems import listed_problem, plan_family
from .progress import Clock, Layers, Listener
from .result import PlanResult, furthest_of
from .shorten import Shortened, shorten

WIDER: Final = 4
"""A beam's width as a multiple of the one before that found nothing."""
WIDENINGS: Final = 2
"""How often a beam that finds nothing is made wider, unless its width was asked for."""


def plan_beam(
    task: Task,
    *,
    seed: int = 0,
    width: int | None = None,
    longest: int | None = None,
    polish: int | None = None,
    seconds: float | None = None,
    threads: int | None = None,
    progress: Listener | None = None,
) -> PlanResult:
    """Plan by beam search, with or without hangs: quick and near the shortest plan; it proves nothing.

    Layer by layer, of all plans with equally many actions the best are kept: new stances only, and few of one niche. A beam that ends
    without a plan is made four times as wide, twice, unless its width was asked for.

    Args:
        task: What to plan.
        seed: Only written down: nothing here is drawn at random.
        width: Stances kept of each layer at first; None: as many as the family of the robot says.
        longest: Most actions of a plan; None: as for `width`.
        polish: Most stances that windows about the plan may see afterwards (`planning.shorten`); 0 for none, None: as for `width`.
        seconds: Most wall-clock time [s].
        threads: Threads; None for one a core. The plan does not depend on them.
        progress: Called after every layer.

    Returns:
        The plan ("found"), or the stance with the best score and what stops it there ("stopped").

    Raises:
        PlannerError: If the task allows actions that can't be listed one by one.
    """
    clock = Clock(seconds)
    problem = listed_problem(task, "beam", threads=threads)

    def tell(layer: int, stances: int, score: float) -> None:
        if progress is not None:
            progress(Layers(layer, stances, score))

    asked: dict[str, Any] = {"width": width, "longest": longest, "polish": polish}
    beam = replace(problem.beam, **{name: value for name, value in asked.items() if value is not None})
    checks = 0
    for _ in range(1 + WIDENINGS if width is None else 1):
        reached = search_layers(problem, beam, seconds=clock.left, tell=tell)
        checks += reached.checks
        if reached.found or reached.interrupted or clock.is_over:
            break
        beam = replace(beam, width=WIDER * beam.width)
    shortened = Shortened(reached.codes, 0, 0, complete=False)
    if reached.found and beam.polish:
        shortened = shorten(problem, reached.codes, width=0, effort=beam.polish, seconds=clock.left)
    family = plan_family(task)
    stances = problem.replay(shortened.codes).stances
    return PlanResult(
        status="found" if reached.found else "stopped",
        plan=Plan.of_codes(task, shortened.codes, seed=seed, planner="beam"),
        task=task,
        reason=_reason(reached, shortened, beam.width),
        evaluations=0,
        checks=checks + shortened.checks,
        seconds=clock.spent,
        seed=seed,
        planner="beam",
        max_torque=max((family.torque(stance) for stance in stances[1:]), default=0.0),
        furthest=None if reached.found else furthest_of(task, problem, reached.codes),
        stances=reached.stances,
        first_length=len(reached.codes) if reached.found else None,
    )


def _reason(reached: Reached, shortened: Shortened, width: int) -> str:
    if not reached.found:
        how = "interrupted" if reached.interrupted else f"no plan in {reached.layers} layers of up to {width} stances"
        return f"{how}; this search proves nothing"
    cut = len(reached.codes) - len(shortened.codes)
    then = f"; windows made it {cut} shorter" if cut else ""
    return f"reached every goal in layer {len(reached.codes)}, {width} stances wide{then}"
