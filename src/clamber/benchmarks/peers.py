"""Our planner beside the genetic algorithms of other libraries: plans per second, and time until the first plan."""

import importlib.util
import math
import random
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from statistics import median
from typing import Any, Final

import numpy as np

from ..errors import how_to_install
from ..planning.genetic.evolve import Genes, first_generation, next_generation, weights_for
from ..planning.genetic.profile import load_profile
from ..planning.problem.problem import CompiledProblem
from ..planning.problem.problems import pose_problem
from ..tasks import load_task
from ..trials.measured import NOTHING, Row, Say, keep_quiet, median_or_nothing
from .speed import PlainProblem, plain_module

POPULATION: Final = 150
"""As in the default profile."""
FIRST_LENGTH: Final = 30
LIMIT: Final = 400
CROSSOVER: Final = 0.8
MUTATION: Final = 0.02
"""Chance of a gene to be drawn anew."""
TOURNAMENT: Final = 3


@dataclass(slots=True)
class Judge:
    """Gives a peer its fitness values, counts them, and says when to stop."""

    problem: CompiledProblem
    seconds: float
    length: int
    """Genes of a plan, for peers whose plans all have the same number of them."""
    evaluations: int = 0
    success: float | None = None
    """Seconds until a plan reached the goal."""
    weights: Any = None
    started: float = field(default_factory=time.perf_counter)

    def __post_init__(self) -> None:
        self.weights = weights_for(self.problem, load_profile("default"))

    @property
    def elapsed(self) -> float:
        """Seconds since the start."""
        return time.perf_counter() - self.started

    @property
    def over(self) -> bool:
        """Whether to stop: a plan reached the goal, or time is up."""
        return self.success is not None or self.elapsed >= self.seconds

    def __call__(self, genes: Genes, lengths: Genes) -> Any:
        """Fitness of many plans, the greater the better: weights times features at each plan's best prefix."""
        genes = np.ascontiguousarray(genes, np.int32)
        records = self.problem.rollout(genes, lengths, self.weights, LIMIT)
        self.evaluations += len(records)
        if self.success is None and records["done"].any():
            self.success = self.elapsed
        return records["best"].copy()

    def all_alike(self, genes: Any) -> Any:
        """Fitness of plans of equal length."""
        return self(genes, np.full(len(genes), genes.shape[1], np.int32))


def run_clamber(judge: Judge, seed: int) -> None:
    """Our own search, default profile, up to the first plan."""
    profile = load_profile("default")
    state = first_generation(judge.problem, profile, seed)
    while not state.found and judge.elapsed < judge.seconds:
        next_generation(judge.problem, profile, state, seed)
    judge.evaluations = state.evaluations
    judge.success = judge.elapsed if state.found else None


def run_deap(judge: Judge, seed: int) -> None:
    """DEAP: plans of any length, one-point crossover that changes it, uniform mutation, tournaments, the best two survive."""
    from deap import algorithms, base, tools

    class Fitness(base.Fitness):  # type: ignore[misc]
        weights = (1.0,)

    class Individual(list[int]):
        def __init__(self, genes: Any) -> None:
            super().__init__(genes)
            self.fitness = Fitness()

    entries = len(judge.problem.actions)
    toolbox = base.Toolbox()
    toolbox.register("mate", tools.cxMessyOnePoint)
    toolbox.register("mutate", tools.mutUniformInt, low=0, up=entries - 1, indpb=MUTATION)
    toolbox.register("select", tools.selTournament, tournsize=TOURNAMENT)

    def evaluate(plans: list[Individual]) -> None:
        for plan in plans:
            del plan[LIMIT:]
        genes = np.zeros((len(plans), LIMIT), np.int32)
        lengths = np.array([len(plan) for plan in plans], np.int32)
        for row, plan in zip(genes, plans, strict=True):
            row[: len(plan)] = plan
        for plan, value in zip(plans, judge(genes, lengths), strict=True):
            plan.fitness.values = (float(value),)

    before = random.getstate()  # DEAP draws from the global generator
    random.seed(seed)
    try:
        plans = [Individual(random.randrange(entries) for _ in range(FIRST_LENGTH)) for _ in range(POPULATION)]
        evaluate(plans)
        while not judge.over:
            best = tools.selBest(plans, 2)
            children = algorithms.varAnd(toolbox.select(plans, POPULATION - 2), toolbox, CROSSOVER, 1.0)
            evaluate([plan for plan in children if not plan.fitness.valid])
            plans = [*best, *children]
    finally:
        random.setstate(before)


def run_pymoo(judge: Judge, seed: int) -> None:
    """Pymoo: plans of one length, two-point crossover, uniform mutation, tournaments, the better half survives."""
    from pymoo.algorithms.soo.nonconvex.ga import GA
    from pymoo.core.mutation import Mutation
    from pymoo.core.problem import Problem
    from pymoo.operators.crossover.pntx import TwoPointCrossover
    from pymoo.operators.sampling.rnd import IntegerRandomSampling
    from pymoo.termination import get_termination

    class Plans(Problem):  # type: ignore[misc]
        def __init__(self) -> None:
            super().__init__(n_var=judge.length, n_obj=1, xl=0, xu=len(judge.problem.actions) - 1, vtype=int)

        def _evaluate(self, x: Any, out: Any, *args: Any, **kwargs: Any) -> None:
            out["F"] = -judge.all_alike(x)

    class UniformMutation(Mutation):  # type: ignore[misc]
        def _do(self, problem: Any, X: Any, *args: Any, random_state: Any = None, **kwargs: Any) -> Any:
            fresh = random_state.integers(problem.xl, problem.xu + 1, size=X.shape)
            return np.where(random_state.random(X.shape) < MUTATION, fresh, X)

    algorithm = GA(
        pop_size=POPULATION,
        sampling=IntegerRandomSampling(),
        crossover=TwoPointCrossover(prob=CROSSOVER),
        mutation=UniformMutation(),
    )
    algorithm.setup(Plans(), termination=get_termination("n_gen", 10**9), seed=seed, verbose=False)
    while not judge.over and algorithm.has_next():
        algorithm.next()


def run_pygad(judge: Judge, seed: int) -> None:
    """Pygad: plans of one length, two-point crossover, random mutation, tournaments, the best two survive."""
    import pygad

    search = pygad.GA(
        num_generations=10**6,
        num_parents_mating=POPULATION // 2,
        fitness_func=lambda _search, plans, _places: judge.all_alike(np.asarray(plans)).tolist(),
        fitness_batch_size=POPULATION,
        sol_per_pop=POPULATION,
        num_genes=judge.length,
        gene_type=int,
        gene_space=list(range(len(judge.problem.actions))),
        parent_selection_type="tournament",
        K_tournament=TOURNAMENT,
        crossover_type="two_points",
        crossover_probability=CROSSOVER,
        mutation_type="random",
        mutation_probability=MUTATION,
        keep_elitism=2,
        on_generation=lambda _search: "stop" if judge.over else None,
        random_seed=seed,
        suppress_warnings=True,
    )
    search.run()


PEERS: Final[dict[str, Callable[[Judge, int], None]]] = {
    "clamber": run_clamber,
    "DEAP": run_deap,
    "pymoo": run_pymoo,
    "pygad": run_pygad,
}
"""Library -> its search; ours is one of them."""
OPTIONAL: Final = {"DEAP": "deap", "pymoo": "pymoo", "pygad": "pygad"}
"""Library -> what is imported; they come with the extra `bench`."""


@dataclass(frozen=True, slots=True)
class Race:
    """What one search came to."""

    evaluations: int
    seconds: float
    success: float | None

    @property
    def rate(self) -> float:
        """Whole plans per second."""
        return self.evaluations / self.seconds if self.seconds > 0.0 else math.nan


def race(peer: str, problem: CompiledProblem, seed: int, *, seconds: float, length: int) -> Race:
    """Let one library search until its first plan, or until time is up."""
    judge = Judge(problem, seconds, length)
    PEERS[peer](judge, seed)
    return Race(judge.evaluations, judge.elapsed, judge.success)


SEEDS: Final = (0, 1, 2)
SECONDS: Final = 4.0
"""Most time of one search [s]."""
PLAIN_SECONDS: Final = 4.0
PLAIN_TASK: Final = "ladder"


@dataclass(frozen=True, slots=True)
class RaceTask:
    """A task to race on."""

    task: str
    label: str
    length: int
    """Genes per plan for libraries whose plans all have the same length: half as many again as our first plans need."""


RACE_TASKS: Final = (
    RaceTask("ladder", "ladder, 3 in", 80),
    RaceTask("modified-ladder", "modified-ladder", 150),
    RaceTask("h", "h", 200),
)


def installed(peer: str) -> bool:
    """Whether a library is there."""
    return peer not in OPTIONAL or importlib.util.find_spec(OPTIONAL[peer]) is not None


def race_rows(
    *,
    courses: Iterable[RaceTask] = RACE_TASKS,
    seeds: tuple[int, ...] = SEEDS,
    seconds: float = SECONDS,
    plain_seconds: float = PLAIN_SECONDS,
    say: Say = keep_quiet,
) -> list[Row]:
    """Every library on every course, with our compiled evaluator on one core, then once each with the plain one."""
    rows = []
    for course in courses:
        problem = pose_problem(load_task(course.task), threads=1).problem
        runs: dict[str, list[Race]] = {peer: [] for peer in PEERS}
        for seed in seeds:  # libraries take turns
            for peer in PEERS:
                if installed(peer):
                    say(f"{peer} on {course.label}, seed {seed}")
                    runs[peer].append(race(peer, problem, seed, seconds=seconds, length=course.length))
        for peer, done in runs.items():
            rows += _rows(f"{course.label}, {peer}, compiled evaluator, one core", done, len(seeds), seconds)
    return rows + _plain_rows(plain_seconds, say)


def _rows(name: str, runs: list[Race], seeds: int, seconds: float) -> list[Row]:
    if not runs:
        return [Row(f"{name} (not installed: {how_to_install('bench')})", NOTHING, "plans/s")]
    found = sum(run.success is not None for run in runs)
    return [
        Row(f"{name}: plans per second, median of {seeds} seeds", median(run.rate for run in runs), "plans/s"),
        Row(f"{name}: seeds of {seeds} with a plan within {seconds:g} s", found, "seeds"),
        Row(
            f"{name}: time to the first plan, median of {seeds} seeds",
            median_or_nothing([run.success for run in runs]),
            "s",
        ),
    ]


def _plain_rows(seconds: float, say: Say) -> list[Row]:
    module = plain_module()
    if module is None:
        return [Row(f"{PLAIN_TASK}, plain evaluator (needs a checkout: it lies in the tests)", NOTHING, "plans/s")]
    course = next(course for course in RACE_TASKS if course.task == PLAIN_TASK)
    task: Any = load_task(course.task)
    problem: CompiledProblem = PlainProblem(task, pose_problem(task, threads=1).problem.actions, module)
    rows = []
    for peer in PEERS:
        if not installed(peer):
            continue
        say(f"{peer} on {course.label} with the plain evaluator")
        run = race(peer, problem, 0, seconds=seconds, length=course.length)
        name = f"{course.label}, {peer}, plain evaluator"
        rows.append(Row(f"{name}: plans per second, one seed", run.rate, "plans/s"))
        rows.append(
            Row(f"{name}: time to the first plan", NOTHING, f"s (none within {seconds:g} s)")
            if run.success is None
            else Row(f"{name}: time to the first plan, one seed", run.success, "s")
        )
    return rows
