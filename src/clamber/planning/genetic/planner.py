"""The genetic planner as a whole: a task in, a plan or the furthest stance out."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from ...tasks import Task
from ..problem.arrays import ActionTable
from ..problem.plan import Plan
from ..problem.problems import last_goal_only, plan_family, pose_problem
from ..progress import Clock, Listener
from ..result import PlanResult, furthest_of
from ..shorten import Shortened, shorten
from .evolve import Genes
from .learning import Macro
from .profile import Profile, load_profile
from .search import Budget, Outcome, search


def with_seeds(table: ActionTable, plans: Sequence[Genes]) -> tuple[ActionTable, list[Genes]]:
    """An inventory that can spell the given plans, and the plans in its entries.

    Args:
        table: The inventory.
        plans: Packed codes, every hold named.

    Returns:
        The inventory, longer by the actions that it lacks (grabs of a hold by its name, mostly), and genes of each plan.
    """
    single = {
        int(table.codes[table.offsets[entry]]): entry
        for entry in range(len(table))
        if table.offsets[entry + 1] - table.offsets[entry] == 1
    }
    lacking = sorted({int(code) for codes in plans for code in codes} - set(single))
    longer = table.extended([(f"code {code}", (code,), False) for code in lacking])
    single |= {code: len(table) + i for i, code in enumerate(lacking)}
    return longer, [np.array([single[int(code)] for code in codes], np.int32) for codes in plans]


def plan_genetic(
    task: Task,
    *,
    seed: int = 0,
    profile: str | Profile = "default",
    max_evaluations: int = 50_000,
    max_checks: int | None = None,
    seconds: float | None = None,
    threads: int | None = None,
    filters: bool = True,
    macros: Sequence[Macro] = (),
    progress: Listener | None = None,
    checkpoint: Path | None = None,
    seeds: Sequence[Plan] = (),
) -> PlanResult:
    """Plan by genetic search (thesis 2.2.3; page "The model", section 10).

    Args:
        task: What to plan.
        seed: Same seed, same plan, on any number of threads.
        profile: Name or file of a profile, or a profile.
        max_evaluations: Most plans to evaluate, polishing included.
        max_checks: Most single actions to judge, polishing included; a generation that has begun is finished.
        seconds: Most wall-clock time [s].
        threads: Threads; None for one a core.
        filters: Whether the inventory's filters are applied.
        macros: Learned modules to add to the inventory.
        progress: Called after every generation.
        checkpoint: File to save the search to, and to resume it from.
        seeds: Plans, or beginnings of plans, of this robot on this world, that the first generation holds.

    Returns:
        The plan ("found"), or the furthest stance and what stopped it ("stopped").
    """
    clock = Clock(seconds)
    settings = load_profile(profile) if isinstance(profile, str) else profile
    aim = task if settings.search.subgoals else last_goal_only(task)
    posed = pose_problem(aim, threads=threads, filters=filters)
    table = posed.problem.actions.extended([(macro.name, macro.codes, False) for macro in macros])
    table, beginnings = with_seeds(table, [seeded.codes(task) for seeded in seeds])
    problem = posed.problem.rebind(table)
    identity = f"genetic/{dict(task.hashes)}/{table.names}"
    if seeds:
        identity += f"/{[genes.tolist() for genes in beginnings]}"
    outcome = search(
        problem,
        settings,
        seed=seed,
        budget=Budget(max_evaluations, seconds, max_checks),
        listener=progress,
        checkpoint=checkpoint,
        identity=identity,
        seeds=beginnings,
    )
    shortened = Shortened(outcome.codes, 0, 0, complete=False)
    if outcome.found and not outcome.interrupted and (settings.search.beam or settings.search.windows):
        left = clock.left
        shortened = shorten(
            problem, outcome.codes, width=settings.search.beam, effort=settings.search.windows, seconds=left
        )
    codes = shortened.codes
    names = outcome.names if len(codes) == len(outcome.codes) and np.array_equal(codes, outcome.codes) else ()
    replayed = problem.replay(codes)
    family = plan_family(task)
    plan = Plan.of_codes(task, codes, seed=seed, planner=f"genetic/{settings.name}", genes=names or None)
    return PlanResult(
        status="found" if outcome.found else "stopped",
        plan=plan,
        task=task,
        reason=_reason(outcome, shortened),
        evaluations=outcome.evaluations,
        checks=outcome.checks + shortened.checks,
        seconds=clock.spent,
        seed=seed,
        planner=f"genetic/{settings.name}",
        max_torque=max((family.torque(stance) for stance in replayed.stances[1:]), default=0.0),
        furthest=None if outcome.found else furthest_of(task, problem, outcome.codes),
        first_length=outcome.first_length,
        first_evaluations=outcome.first_evaluations,
        first_checks=outcome.first_checks,
        history=outcome.history,
        macros=outcome.macros,
    )


def _reason(outcome: Outcome, shortened: Shortened) -> str:
    if outcome.found and not len(outcome.codes):
        return "the start meets every goal already"
    if outcome.found and (outcome.interrupted or shortened.interrupted):
        return f"interrupted while polishing; the plan of {len(shortened.codes)} actions works"
    if outcome.found:
        cut = len(outcome.codes) - len(shortened.codes)
        then = f"; a search about the plan made it {cut} shorter" if cut else ""
        return f"reached every goal after {outcome.first_evaluations} evaluations{then}"
    how = "interrupted" if outcome.interrupted else "the budget ran out"
    return f"{how} after {outcome.evaluations} evaluations without reaching the goal; this search proves nothing"
