"""Make a plan that works shorter: many small variants at once, the best taken, until none is better for a while."""

import numpy as np

from ..problem.arrays import ActionTable
from ..problem.problem import CompiledProblem
from .evolve import Evolution, Genes
from .operators import vary
from .profile import Profile

BATCH = 600
PATIENCE = 6
"""Turns without a shorter plan before polishing stops."""


def spell_to_goal(problem: CompiledProblem, genes: Genes) -> Genes:
    """The codes of a plan up to the goal, holds named; a macro may go on past it."""
    codes = problem.actions.spell(genes)
    stances = problem.replay(codes).stances
    done = next((i for i in range(len(stances)) if problem.is_done(stances[i : i + 1])), len(codes))
    return problem.resolve(codes[:done], stances)


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
    vary(
        genes, len(genes), children, lengths, len(problem.actions), problem.actions.runs,
        profile.search.run_length, seed, turn,
    )  # fmt: skip
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
