"""How many actions a second the kernels judge: on one core, on all of them, and against plain Python."""

import importlib
import importlib.util
import os
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from types import ModuleType
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from ..families.climber.planning.problem import LimbedProblem
from ..families.climber.planning.task import LimbedTask
from ..planning.genetic.evolve import Genes, first_generation, next_generation, weights_for
from ..planning.genetic.profile import load_profile
from ..planning.problem.arrays import ActionTable
from ..planning.problem.codes import Code
from ..planning.problem.plan_source import open_plan, plan_names
from ..planning.problem.problem import FEATURE_NAMES, CompiledProblem, Records
from ..planning.problem.problems import pose_problem
from ..tasks import load_task
from ..trials.measured import NOTHING, Row, Say, keep_quiet
from ..types import Ints
from .contest import THESIS

CHECKOUT: Final = Path(__file__).resolve().parents[3]
PACKAGE: Final = "clamber_tests_plain"


def plain_module(checkout: Path = CHECKOUT) -> ModuleType | None:
    """The tests' plain evaluator, loaded by its path; None where there is no checkout around this package."""
    init = checkout / "tests" / "plain" / "__init__.py"
    if not init.is_file():
        return None
    if PACKAGE not in sys.modules:
        spec = importlib.util.spec_from_file_location(PACKAGE, init, submodule_search_locations=[str(init.parent)])
        assert spec is not None and spec.loader is not None
        module = importlib.util.module_from_spec(spec)
        sys.modules[PACKAGE] = module
        spec.loader.exec_module(module)
    return importlib.import_module(f"{PACKAGE}.evaluator")


class PlainProblem(LimbedProblem):
    """A limbed task whose plans the plain evaluator carries out.

    The kernels then carry them out once more for the records (a few hundredths of the time), so searches go the same way with both.
    """

    def __init__(self, task: LimbedTask, actions: ActionTable, module: ModuleType) -> None:
        super().__init__(task, actions, threads=1)
        self.plain: Any = module.PlainEvaluator(task)

    def rollout(
        self, genes: npt.NDArray[np.int32], lengths: npt.NDArray[np.int32], weights: npt.NDArray[np.float64], limit: int
    ) -> Records:
        """Carry out many plans, each up to its goal or its first failure; see `CompiledProblem.rollout`."""
        for row, length in zip(genes, lengths, strict=True):
            self.carry_out(self.actions.spell(row[:length])[:limit])
        return super().rollout(genes, lengths, weights, limit)

    def carry_out(self, codes: npt.NDArray[np.int32]) -> int:
        """Carry out one plan, plainly; the number of actions tried."""
        now = self.plain.start()
        goals = len(self.task.goals)
        for tried, code in enumerate(codes.tolist()):
            if now.stage >= goals:
                return tried
            result = self.plain.step(now, self._action(code))
            if result.reason is not None:
                return tried + 1
            now = result.stance
        return len(codes)

    def _action(self, code: int) -> tuple[Any, ...]:
        opened = Code.of(code)
        if opened.kind == "none":
            return ("none",)
        if opened.kind == "move":
            return ("move", opened.argument // 2, -1 if opened.argument % 2 else 1)
        if opened.kind == "release":
            return ("release", opened.limb)
        if opened.kind == "hold":
            return ("hold", opened.limb, self.task.world.holds[opened.argument].number)
        assert opened.kind == "nearest", "the filtered inventory draws no holds at random"
        return ("nearest", opened.limb, opened.argument)


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
        """The task, ready for them."""
        return LimbedProblem(self.task, self.table, threads=threads)

    def run(self, problem: CompiledProblem) -> Records:
        """Carry the batch out."""
        return problem.rollout(self.genes, self.lengths, self.weights, LIMIT)

    def few(self, n: int) -> "Load":
        """A batch of `n` of these plans, evenly drawn from the first copy."""
        rows = np.unique(np.linspace(0, len(self.genes) - 1, n).astype(int))
        return Load(self.name, self.task, self.table, self.genes[rows].copy(), self.lengths[rows].copy(), self.weights)


def evolved_load(board: str, *, generations: int = GENERATIONS, copies: int = COPIES) -> Load:
    """What a search has in hand when it finds its plan, or after so many generations."""
    profile = load_profile("default")
    task = load_task(board)
    problem = pose_problem(task).problem
    state = first_generation(problem, profile, 0)
    while not state.found and state.generation < generations:
        next_generation(problem, profile, state, 0)
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
    return [evolved_load(board) for board in THESIS] + [printed_load(name) for name in plan_names()]


REPEATS: Final = 25
IN_A_ROW: Final = 5
PLAIN_PLANS: Final = 12
"""Plans of each board that the plain evaluator carries out."""
PLAIN_REPEATS: Final = 2
PLAIN_ROUNDS: Final = 50
"""How often the kernels carry those plans out in one go: once takes microseconds."""


@dataclass(frozen=True, slots=True)
class Timing:
    """Least times of some work [s]."""

    wall: float
    cpu: float
    """Of all threads of this process: what the work costs, however busy the machine is with other things."""


def best_times(works: Sequence[Callable[[], Any]], repeats: int) -> list[Timing]:
    """Least times of each piece of work; they take turns, so that a busy machine hits all of them alike.

    A turn is a few goes in a row, as the generations of a search are: cores that lay idle take milliseconds to wake.
    """
    best = np.full((len(works), 2), np.inf)
    for _ in range(-(-repeats // IN_A_ROW)):
        for i, work in enumerate(works):
            for _ in range(min(IN_A_ROW, repeats)):
                wall, cpu = time.perf_counter(), time.process_time()
                work()
                best[i] = np.minimum(best[i], (time.perf_counter() - wall, time.process_time() - cpu))
    return [Timing(float(wall), float(cpu)) for wall, cpu in best]


def speed_rows(*, loads: Sequence[Load] | None = None, repeats: int = REPEATS, say: Say = keep_quiet) -> list[Row]:
    """Checks per second on one core and on all, how well the cores add up, and the ratio to the plain evaluator."""
    say("actions judged per second")
    loads = whole_load() if loads is None else loads
    cores = os.cpu_count() or 1
    ones = [load.problem(1) for load in loads]
    alls = [load.problem(cores) for load in loads]
    checks = [int(load.run(problem)["checks"].sum()) for load, problem in zip(loads, ones, strict=True)]
    works = [
        partial(load.run, problem)
        for load, one, every in zip(loads, ones, alls, strict=True)
        for problem in (one, every)
    ]
    times = best_times(works, repeats)
    one, every = times[0::2], times[1::2]
    total = sum(checks)
    rate_one, rate_all = (total / sum(timing.wall for timing in timings) for timings in (one, every))
    cpu_one, cpu_all = (sum(timing.cpu for timing in timings) for timings in (one, every))
    busy = os.getloadavg()[0] if hasattr(os, "getloadavg") else NOTHING
    mix = f"{len(loads)} batches of evolved and printed plans, best of {repeats}"
    rows = [
        Row(f"action checks, one core ({mix})", rate_one, "checks/s", ">= 3e6"),
        Row(f"action checks, one core, by CPU time ({mix})", total / cpu_one, "checks/s"),
        Row(f"action checks, {cores} cores ({mix})", rate_all, "checks/s"),
        Row(f"share of linear speed-up on {cores} cores", rate_all / (cores * rate_one), "share", ">= 0.8"),
        Row(f"CPU time on one core to CPU time on {cores} cores, same work", cpu_one / cpu_all, "ratio"),
        Row("load of the machine at that time, this work included", busy, "processes"),
    ]
    rows += [
        Row(f"action checks, one core, by CPU time, {load.name}", n / timing.cpu, "checks/s")
        for load, n, timing in zip(loads, checks, one, strict=True)
    ]
    return [*rows, *plain_rows(loads, say=say)]


def plain_rows(loads: Sequence[Load], *, say: Say = keep_quiet) -> list[Row]:
    """How many times faster than the plain evaluator, on the same plans."""
    say("the plain evaluator")
    name = "action checks, compiled to plain Python, one core, by CPU time"
    module = plain_module()
    if module is None:
        return [Row(f"{name} (needs a checkout: the plain evaluator lies in the tests)", NOTHING, "ratio", ">= 200")]
    checks, compiled, plain = 0, 0.0, 0.0
    for load in loads:
        if not load.name.endswith("evolved"):
            continue
        few = load.few(PLAIN_PLANS)
        fast, slow = few.problem(1), PlainProblem(load.task, load.table, module)
        codes = [few.table.spell(row[:n]) for row, n in zip(few.genes, few.lengths, strict=True)]
        checks += int(few.run(fast)["checks"].sum())
        times = best_times(
            [
                partial(_again, few, fast, PLAIN_ROUNDS),
                partial(_plainly, slow, codes),
            ],
            PLAIN_REPEATS,
        )
        compiled += times[0].cpu / PLAIN_ROUNDS
        plain += times[1].cpu
    return [
        Row(
            f"action checks, plain Python, one core, by CPU time (best of {PLAIN_REPEATS})", checks / plain, "checks/s"
        ),
        Row(name, plain / compiled, "ratio", ">= 200"),
    ]


def _again(load: Load, problem: CompiledProblem, rounds: int) -> None:
    for _ in range(rounds):
        load.run(problem)


def _plainly(problem: PlainProblem, plans: Sequence[Ints]) -> None:
    for codes in plans:
        problem.carry_out(codes)
