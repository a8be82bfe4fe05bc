"""Several populations of the genetic planner at once, each an item of a batch; what they found seeds their neighbours' next round."""

from collections.abc import Callable
from dataclasses import asdict, replace
from typing import Any, Final

from ..errors import PlannerError
from ..files import Document
from ..jobs import Executor, Outcome, map_items
from ..kernel_cache import is_compiled
from ..specs import build_spec
from ..tasks import Task, task_from_document
from ..types import Json
from .genetic.planner import plan_genetic
from .genetic.profile import Profile, load_profile
from .problem.plan import Plan
from .problem.problems import pose_problem
from .progress import Clock
from .result import PlanResult

ROUNDS: Final = 2
"""Rounds at most; a round in which an island finds a plan is the last."""


def plan_islands(
    task: Task,
    *,
    islands: int,
    executor: Executor,
    seed: int = 0,
    profile: str | Profile = "default",
    max_evaluations: int = 50_000,
    progress: Callable[[int, int, Outcome], None] | None = None,
) -> PlanResult:
    """Plan with several populations, each on one thread of a worker.

    An island's seed is `seed` plus its number. Islands that found nothing in a round begin the next one with what they and the island
    before them came furthest with. The answer doesn't depend on the number of workers.

    Args:
        task: What to plan.
        islands: Number of populations.
        executor: Local processes or a cluster.
        seed: Of the first island.
        profile: Name or file of a profile, or a profile.
        max_evaluations: Most plans that one island evaluates in one round.
        progress: Told of each island's end.

    Returns:
        The shortest plan of the round that found one (of equals the first island's), or the furthest stance of all.

    Raises:
        PlannerError: If an island's worker died every time.
        ClusterError: If there is no cluster to run on, or it is lost.
    """
    clock = Clock()
    settings = load_profile(profile) if isinstance(profile, str) else profile
    if executor.here and not is_compiled("rollout"):
        plan_genetic(
            task, max_evaluations=1, threads=1
        )  # compiles here, once, and not in every worker at the same time
    plans: list[list[Json]] = [[] for _ in range(islands)]
    evaluations = checks = 0
    best: Json | None = None
    for turn in range(ROUNDS):
        items = [
            {
                "document": task.document,
                "profile": asdict(settings),
                "max_evaluations": max_evaluations,
                "seed": seed + island + turn * islands,
                "plans": plans[island],
            }
            for island in range(islands)
        ]
        told = [_answer(task, outcome) for outcome in map_items(live, items, executor=executor, progress=progress)]
        evaluations += sum(one["evaluations"] for one in told)
        checks += sum(one["checks"] for one in told)
        best = min(told if best is None else [best, *told], key=lambda one: one["rank"])
        if best["rank"][0] == 0:
            break
        plans = [[told[island]["plan"], told[island - 1]["plan"]] for island in range(islands)]
    assert best is not None
    winner = Plan.from_json(best["plan"])
    result = plan_genetic(task, seed=best["seed"], profile=settings, max_evaluations=1, threads=1, seeds=(winner,))
    found = best["rank"][0] == 0
    return replace(
        result,
        status="found" if found else "stopped",
        plan=replace(winner, planner="genetic/islands"),
        reason=f"the shortest of {islands} islands' plans" if found else f"none of {islands} islands found a plan",
        max_torque=best["max_torque"],
        evaluations=evaluations,
        checks=checks,
        seconds=clock.spent,
        seed=best["seed"],
        furthest=None if found else result.furthest,
    )


def live(item: Json) -> Json:
    """One island's round; runs in a worker.

    Args:
        item: `document` of the task, `profile` as plain data, `max_evaluations`, `seed`, `plans` to begin with.

    Returns:
        The plan, what it cost, and its rank: plans before beginnings, then actions or the way left.
    """
    task = task_from_document(item["document"])
    result = plan_genetic(
        task,
        seed=item["seed"],
        profile=build_spec(Profile, Document("profile", item["profile"])),
        max_evaluations=item["max_evaluations"],
        threads=1,
        seeds=tuple(Plan.from_json(plan) for plan in item["plans"]),
    )
    problem = pose_problem(task, threads=1).problem
    end = problem.replay(result.plan.codes(task)).stances[-1:]
    rank = [0, result.length] if result.has_plan else [1, problem.way_left(end)]
    return {
        "plan": result.plan.to_json(),
        "rank": [*rank, item["seed"]],
        "seed": item["seed"],
        "max_torque": result.max_torque,
        "evaluations": result.evaluations,
        "checks": result.checks,
    }


def _answer(task: Task, outcome: Outcome) -> dict[str, Any]:
    if outcome.result is None:
        raise PlannerError("islands", task.name, outcome.error or "its worker died")
    return outcome.result
