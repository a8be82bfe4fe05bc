"""The genetic planner as a whole: a task in, a plan or the furthest stance out."""

import json
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Final

import numpy as np

from ...interrupts import Interruptible
from ...tasks import Task
from ..problem.arrays import ActionTable
from ..problem.plan import Plan
from ..problem.problem import CompiledProblem
from ..problem.problems import last_goal_only, plan_family, pose_problem
from ..progress import Clock, Listener
from ..result import PlanResult, furthest_of
from ..shorten import Shortened, shorten
from .checkpoint import Keeper, Run, with_macros
from .evolve import (
    BATCH,
    PATIENCE,
    Evolution,
    Generation,
    Genes,
    explicit_problem,
    first_generation,
    next_generation,
    polish,
    spell_to_goal,
    tell,
)
from .learning import Macro, learn_while_searching
from .profile import Profile, load_profile

LEARN_EVERY: Final = 10
"""Generations between looks for a repeated sequence."""


@dataclass(frozen=True, slots=True)
class Budget:
    """When a search stops."""

    evaluations: int
    """Most plans to evaluate, polishing included; the first generation is always evaluated."""
    seconds: float | None = None
    """Most time [s]; a search that it ends is not repeatable."""
    checks: int | None = None
    """Most single actions to judge; a generation that has begun is finished."""

    def allows(self, state: Evolution, more: int, clock: Clock) -> bool:
        """Whether so many more plans may be evaluated in a search with a clock of its seconds."""
        judged = self.checks is not None and state.checks >= self.checks
        return state.evaluations + more <= self.evaluations and not judged and not clock.is_over


@dataclass(frozen=True, slots=True)
class Outcome:
    """What a search came to: codes (holds resolved) of the best plan, and how it got there."""

    codes: Genes
    found: bool
    interrupted: bool
    first_length: int | None
    """Actions of the first plan that reached the goal, before polishing."""
    first_evaluations: int | None
    """Plans evaluated up to it."""
    first_checks: int | None
    """Single actions judged up to it."""
    evaluations: int
    checks: int
    history: tuple[Generation, ...]
    macros: tuple[Macro, ...]
    names: tuple[str, ...]
    """What the inventory called each gene of the plan; empty after polishing, which names holds instead."""


def search(
    problem: CompiledProblem,
    profile: Profile,
    *,
    seed: int,
    budget: Budget,
    listener: Listener | None = None,
    checkpoint: Path | None = None,
    identity: str = "",
    seeds: Sequence[Genes] = (),
) -> Outcome:
    """Search for a plan, then make it shorter.

    Args:
        problem: What to plan.
        profile: The planner's settings.
        seed: Same seed, same plan, on any number of threads.
        budget: When to stop.
        listener: Called after every generation.
        checkpoint: File that the search is saved to, and resumed from if it is there.
        identity: Names task, profile, inventory and seeds; a checkpoint of another one is refused.
        seeds: Genes of plans, or beginnings of plans, that the first generation holds.

    Returns:
        The outcome; Ctrl-C ends the search with the best so far.

    Raises:
        FileError: If the checkpoint is none, or belongs to another search or release.
        SpecError: If something in it is none that this search can have.
    """
    clock = Clock(budget.seconds)
    identity = f"{identity}/seed {seed}/profile {json.dumps(asdict(profile), sort_keys=True, default=str)}"
    keeper = Keeper(checkpoint, identity)
    run = keeper.load(problem, profile.search.population, profile.search.longest)
    base = problem
    if run is None:
        run = Run(first_generation(problem, profile, seed, seeds), [])
    else:
        problem = with_macros(base, run.macros)

    def watch() -> None:
        keeper.save(run)
        tell(listener, problem, run.state)

    with Interruptible() as block:
        tell(listener, problem, run.state)
        while not run.state.found and budget.allows(run.state, profile.search.population, clock):
            if (
                profile.search.learned_macros
                and run.state.generation % LEARN_EVERY == LEARN_EVERY - 1
                and not run.macros
            ):
                run.macros = learn_while_searching(problem, run.state)
                if run.macros:
                    problem = with_macros(base, run.macros)
                    run.state.population.follow = np.full(
                        (len(run.state.population.genes), 1 + len(problem.actions)), -1, np.int32
                    )
            next_generation(problem, profile, run.state, seed)
            watch()
        _polish(problem, profile, run, seed, lambda: budget.allows(run.state, BATCH, clock), watch)
    _note_success(run)
    keeper.save(run, now=True)
    return _outcome(problem, run, block.interrupted)


def _note_success(run: Run) -> None:
    if run.state.found and run.first_length is None:
        run.first_length, run.first_evaluations = run.state.best_actions, run.state.evaluations
        run.first_checks = run.state.checks


def _polish(
    problem: CompiledProblem,
    profile: Profile,
    run: Run,
    seed: int,
    affords: Callable[[], bool],
    watch: Callable[[], None],
) -> None:
    """Turns of polishing as long as they are afforded and help; `watch` is called after each."""
    state = run.state
    if not state.found:
        return
    _note_success(run)
    most = run.first_evaluations + profile.search.polish if run.first_evaluations else 0
    named, start = explicit_problem(problem, state.best)
    genes = start if run.polished is None else _entries(named, run.polished)
    while state.evaluations + BATCH <= most and run.stale < PATIENCE and affords():
        genes, shorter = polish(named, profile, state, genes, seed, run.turn)
        run.polished = named.actions.spell(genes)
        run.turn += 1
        run.stale = 0 if shorter else run.stale + 1
        state.best_actions = len(genes)
        watch()


def _entries(problem: CompiledProblem, codes: Genes) -> Genes:
    """Table entries of single codes."""
    index = {int(code): i for i, code in enumerate(problem.actions.codes)}
    return np.array([index[int(code)] for code in codes], np.int32)


def _outcome(problem: CompiledProblem, run: Run, interrupted: bool) -> Outcome:
    state = run.state
    names: tuple[str, ...] = ()
    codes = spell_to_goal(problem, state.best) if run.polished is None else run.polished
    if run.polished is None:
        names = tuple(
            problem.actions.names[g]
            for g in state.best
            for _ in range(problem.actions.offsets[g + 1] - problem.actions.offsets[g])
        )[: len(codes)]
    return Outcome(
        codes, state.found, interrupted, run.first_length, run.first_evaluations, run.first_checks,
        state.evaluations, state.checks, tuple(state.history), tuple(run.macros), names,
    )  # fmt: skip


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
        seconds: Most time [s].
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
