"""The genetic search over any problem: generations of plans until one reaches the goal (thesis 2.2.3, and what makes it strong)."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from ..problem.arrays import ActionTable
from ..problem.problem import CompiledProblem, Records
from ..problem.problems import goal_step
from ..progress import Listener, Progress
from .operators import breed, random_genes, vary
from .profile import Profile, Search

Genes = npt.NDArray[np.int32]
CROSSOVERS = ("tail", "one_point", "two_point")


@dataclass(slots=True)
class Population:
    """Plans as genes, what became of each, and the entries that could follow each (count, then entries; computed for survivors)."""

    genes: Genes
    lengths: Genes
    records: Records
    follow: Genes


@dataclass(frozen=True, slots=True)
class Generation:
    """One line of a search's history."""

    generation: int
    evaluations: int
    best_fitness: float
    furthest: int
    stage: int


@dataclass(slots=True)
class Evolution:
    """The state of a search: all that is needed to go on from here, or to tell what came of it."""

    population: Population
    generation: int = 0
    evaluations: int = 0
    checks: int = 0
    history: list[Generation] = field(default_factory=list)
    best: Genes = field(default_factory=lambda: np.zeros(0, np.int32))
    """Genes of the plan that got furthest; of the shortest that reaches the goal, once one does."""
    best_fitness: float = -np.inf
    best_actions: int = 0
    stage: int = 0
    found: bool = False
    improved: int = 0
    """Generation of the last improvement, or of the last fresh start."""
    since: float = -np.inf
    """Best fitness since the last fresh start."""


def weights_for(problem: CompiledProblem, profile: Profile) -> npt.NDArray[np.float64]:
    """The profile's weights in the order of the family's features."""
    return np.array([profile.weights.get(name, 0.0) for name in problem.features])


def first_generation(problem: CompiledProblem, profile: Profile, seed: int, seeds: Sequence[Genes] = ()) -> Evolution:
    """Random plans, evaluated; the first of them are those that are given."""
    state = Evolution(_random_population(problem, profile, seed, 0, seeds))
    _count(state, state.population.records)
    _look(problem, state)
    return state


def _random_population(
    problem: CompiledProblem, profile: Profile, seed: int, generation: int, seeds: Sequence[Genes] = ()
) -> Population:
    search = profile.search
    n, longest, entries = search.population, search.longest, len(problem.actions)
    genes = np.zeros((n, longest), np.int32)
    lengths = np.full(n, min(search.first_length, longest), np.int32)
    for i in range(n):
        random_genes(genes[i], 0, lengths[i], problem.actions.runs, search.run_length, (seed, generation, i))
    for i, given in enumerate(seeds[:n]):
        lengths[i] = min(len(given), longest)
        genes[i, : lengths[i]] = given[:longest]
    records = problem.rollout(genes, lengths, weights_for(problem, profile), longest)
    return Population(genes, lengths, records, np.full((n, 1 + entries), -1, np.int32))


def next_generation(problem: CompiledProblem, profile: Profile, state: Evolution, seed: int) -> None:
    """Select, breed, evaluate, replace: one generation on, in place. A search that got stuck starts afresh."""
    search = profile.search
    if search.patience and state.generation - state.improved >= search.patience:
        state.generation += 1
        state.population = _random_population(problem, profile, seed, state.generation)
        state.improved, state.since = state.generation, -np.inf
        _count(state, state.population.records)
        _look(problem, state)
        return
    population = state.population
    scores = _scores(population, search)
    order = np.argsort(-scores, kind="stable")
    n = len(order)
    keep = n - round(search.replacement * n)
    survivors = order[:keep]
    cuts = _cuts(population.records, search)
    if search.configuration_filter:
        for i in survivors:
            if population.follow[i, 0] < 0:
                possible = np.flatnonzero(problem.possible(population.genes[i, : cuts[i]]))
                population.follow[i, 0] = len(possible)
                population.follow[i, 1 : 1 + len(possible)] = possible
                state.checks += len(problem.actions) + int(cuts[i])
    children = np.zeros((n - keep, search.longest), np.int32)
    child_lengths = np.zeros(n - keep, np.int32)
    state.generation += 1
    breed(
        (population.genes, population.lengths, cuts, _wheel(scores, search), population.follow),
        (children, child_lengths),
        problem.actions.runs,
        (CROSSOVERS.index(search.crossover), search.cut_spread),
        (search.tail_share, max(1, search.tail_length), search.run_length),
        (search.mutation, search.mutation_inserts),
        (seed, state.generation),
    )
    records = problem.rollout(children, child_lengths, weights_for(problem, profile), search.longest)
    _count(state, records)
    fresh = np.full((n - keep, population.follow.shape[1]), -1, np.int32)
    state.population = Population(
        np.concatenate([population.genes[survivors], children]),
        np.concatenate([population.lengths[survivors], child_lengths]),
        np.concatenate([population.records[survivors], records]),
        np.concatenate([population.follow[survivors], fresh]),
    )
    _look(problem, state)


def _cuts(records: Records, search: Search) -> Genes:
    """Where each plan is cut: its failure, or the end of its best prefix."""
    return np.ascontiguousarray(records["best_genes" if search.best_prefix else "genes"], np.int32)


def _scores(population: Population, search: Search) -> npt.NDArray[np.float64]:
    """Fitness, less a toll for every better plan in the same niche."""
    fitness = np.array(population.records["best" if search.best_prefix else "fitness"])
    if search.niching == 0.0:
        return fitness
    order = np.lexsort((-fitness, population.records["cell"]))
    cells = population.records["cell"][order]
    first = np.concatenate([[True], cells[1:] != cells[:-1]])
    start = np.maximum.accumulate(np.where(first, np.arange(len(order)), 0))
    fitness[order] -= search.niching * (np.arange(len(order)) - start)
    return fitness


def _wheel(scores: npt.NDArray[np.float64], search: Search) -> npt.NDArray[np.float64]:
    """Cumulative weights of selection: by score (shifted, since fitness can be negative), or by rank, linearly."""
    if search.selection == "rank":
        weights = np.empty(len(scores))
        weights[np.argsort(scores, kind="stable")] = np.arange(1, len(scores) + 1)
    else:
        weights = scores - scores.min() + 1e-9
    return np.cumsum(weights)


def _count(state: Evolution, records: Records) -> None:
    state.evaluations += len(records)
    state.checks += int(records["checks"].sum())


def _look(problem: CompiledProblem, state: Evolution) -> None:
    """Keep the best plan seen, and write the history."""
    records = state.population.records
    stages = records["features"][:, problem.features.index("stages")]
    done = np.flatnonzero(records["done"])
    if len(done):
        i = int(done[np.argmin(records["actions"][done])])
        if not state.found or records["actions"][i] < state.best_actions:
            state.found = True
            _keep(state, i, int(records["genes"][i]))
    elif not state.found:
        fitness = records["best"]
        i = int(np.argmax(fitness))
        if fitness[i] > state.best_fitness:
            _keep(state, i, int(records["best_genes"][i]))
    top = float(records["best"].max())
    if top > state.since + 1e-6:
        state.since, state.improved = top, state.generation
    state.stage = max(state.stage, int(stages.max()))
    state.best_fitness = max(state.best_fitness, float(records["best"].max()))
    state.history.append(
        Generation(
            state.generation,
            state.evaluations,
            float(records["best"].max()),
            int(records["actions"][np.argmax(records["best"])]),
            int(stages.max()),
        )
    )


def _keep(state: Evolution, i: int, genes: int) -> None:
    records = state.population.records
    state.best = state.population.genes[i, :genes].copy()
    state.best_actions = int(records["actions"][i])
    state.best_fitness = float(records["best"][i])


def tell(listener: Listener | None, problem: CompiledProblem, state: Evolution) -> None:
    """Report the state of a search."""
    if listener is not None:
        last = state.history[-1]
        listener(
            Progress(
                state.generation,
                state.evaluations,
                last.best_fitness,
                last.furthest,
                last.stage,
                problem.goals,
                state.best_actions if state.found else None,
            )
        )


BATCH = 600
PATIENCE = 6
"""Turns without a shorter plan before polishing stops."""


def spell_to_goal(problem: CompiledProblem, genes: Genes) -> Genes:
    """The codes of a plan up to the goal, holds named; a macro may go on past it."""
    codes = problem.actions.spell(genes)
    stances = problem.replay(codes).stances
    return problem.resolve(codes[: goal_step(problem, codes, stances)], stances)


def explicit_problem(problem: CompiledProblem, genes: Genes) -> tuple[CompiledProblem, Genes]:
    """The problem with an inventory in which every hold is named, and the plan in it.

    "Nearest" changes its meaning when an earlier gene changes; a named hold does not, so a plan survives small cuts.
    """
    named = spell_to_goal(problem, genes)
    plain = [
        int(problem.actions.codes[problem.actions.offsets[g]])
        for g in range(len(problem.actions))
        if problem.actions.runs[g]
    ]
    entries = sorted({*(int(code) for code in named), *plain})
    table = ActionTable.build([(str(code), (code,), code in plain) for code in entries])
    index = {code: i for i, code in enumerate(entries)}
    return problem.rebind(table), np.array([index[int(code)] for code in named], np.int32)


def polish(
    problem: CompiledProblem, profile: Profile, state: Evolution, genes: Genes, seed: int, turn: int
) -> tuple[Genes, bool]:
    """One turn of polishing: returns the plan to go on from, and whether it got shorter.

    A variant as long as the plan may take its place (the first, by number), so that the search drifts over plateaus.
    """
    children = np.zeros((BATCH, len(genes) + 1), np.int32)
    lengths = np.zeros(BATCH, np.int32)
    vary(genes, children, lengths, problem.actions.runs, profile.search.run_length, seed, turn)
    weights = np.zeros(len(problem.features))
    records = problem.rollout(children, lengths, weights, profile.search.longest)
    state.evaluations += BATCH
    state.checks += int(records["checks"].sum())
    done = np.flatnonzero(records["done"])
    if not len(done):
        return genes, False
    actions = records["actions"][done]
    shortest = int(actions.min())
    if shortest > len(genes):
        return genes, False
    effort = records["features"][done, problem.features.index("effort")]
    ranked = done[np.lexsort((effort, actions))]
    pick = ranked[0] if shortest < len(genes) else ranked[turn % int((actions == shortest).sum())]
    better = children[pick, : records["genes"][pick]].copy()
    return better, shortest < len(genes)
