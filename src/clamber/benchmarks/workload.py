"""The plans that speed is measured on: last generations of searches on the five boards, and the plans that the thesis prints."""

from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from ..families.climber.planning.problem import FEATURE_NAMES, LimbedProblem
from ..planning.genetic.evolve import Genes, first_generation, next_generation, weights_for
from ..planning.genetic.profile import load_profile
from ..planning.problem.arrays import ActionTable
from ..planning.problem.plan_source import open_plan, plan_names
from ..planning.problem.problem import CompiledProblem, Records
from ..planning.problem.problems import pose_problem
from ..tasks import load_task

BOARDS: Final = ("ladder", "modified-ladder", "h", "across", "circle")
GENERATIONS: Final = 60
COPIES: Final = 6
"""How often an evolved generation is carried out in one go: some hundredths of a second, so that the best of a few goes is undisturbed."""
PRINTED_COPIES: Final = 300
LIMIT: Final = 400


@dataclass(frozen=True, slots=True)
class Load:
    """A batch of plans for one problem."""

    name: str
    task: Any
    table: ActionTable
    genes: Genes
    lengths: Genes
    weights: Any

    def problem(self, threads: int) -> LimbedProblem:
        """The task, ready for these plans."""
        return LimbedProblem(self.task, self.table, threads=threads)

    def run(self, problem: CompiledProblem) -> Records:
        """Carry the batch out."""
        return problem.rollout(self.genes, self.lengths, self.weights, LIMIT)

    def few(self, n: int) -> "Load":
        """A batch of `n` of these plans, evenly drawn from the first copy."""
        rows = np.unique(np.linspace(0, len(self.genes) - 1, n).astype(int))
        return Load(self.name, self.task, self.table, self.genes[rows].copy(), self.lengths[rows].copy(), self.weights)


def evolved_load(board: str, *, generations: int = GENERATIONS, copies: int = COPIES, seed: int = 0) -> Load:
    """What a search has in hand when it finds its plan, or after so many generations."""
    profile = load_profile("default")
    task = load_task(board)
    problem = pose_problem(task).problem
    state = first_generation(problem, profile, seed)
    while not state.found and state.generation < generations:
        next_generation(problem, profile, state, seed)
    genes, lengths = state.population.genes, state.population.lengths
    weights = weights_for(problem, profile)
    return Load(
        f"{board}, evolved", task, problem.actions, np.tile(genes, (copies, 1)), np.tile(lengths, copies), weights
    )


def printed_load(name: str, *, copies: int = PRINTED_COPIES) -> Load:
    """A printed plan, many times, up to where it stops holding."""
    opened = open_plan(name)
    codes = opened.plan.codes(opened.task)
    table = ActionTable.build([(str(i), [int(code)], False) for i, code in enumerate(codes)])
    genes = np.tile(np.arange(len(codes), dtype=np.int32), (copies, 1))
    return Load(name, opened.task, table, genes, np.full(copies, len(codes), np.int32), np.zeros(len(FEATURE_NAMES)))


def whole_load() -> list[Load]:
    """The mix: every board's evolved plans and every printed plan."""
    return [evolved_load(board) for board in BOARDS] + [printed_load(name) for name in plan_names()]
