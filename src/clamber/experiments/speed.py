"""How many actions a second the kernels judge: on one core, on all of them, and against plain Python."""

import os
import time
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any, Final

from clamber.actions.problem import CompiledProblem
from clamber.types import Ints

from .plain_problem import PlainProblem, plain_module
from .rows import NOTHING, Row, Say, keep_quiet
from .workload import Load, whole_load

REPEATS: Final = 15
PLAIN_PLANS: Final = 12
"""Plans of each board that the plain evaluator carries out."""
PLAIN_REPEATS: Final = 2
PLAIN_ROUNDS: Final = 50
"""How often the kernels carry those plans out in one go: once takes microseconds."""


def seconds_of(work: Callable[[], Any]) -> float:
    """Wall-clock time that some work takes [s]."""
    started = time.perf_counter()
    work()
    return time.perf_counter() - started


def best_times(works: Sequence[Callable[[], Any]], repeats: int) -> list[float]:
    """Least time of each piece of work [s]; they take turns, so that a busy machine hits all of them alike."""
    best = [float("inf")] * len(works)
    for _ in range(repeats):
        for i, work in enumerate(works):
            best[i] = min(best[i], seconds_of(work))
    return best


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
    rate_one = sum(checks) / sum(times[0::2])
    rate_all = sum(checks) / sum(times[1::2])
    busy = os.getloadavg()[0] if hasattr(os, "getloadavg") else NOTHING
    mix = f"{len(loads)} batches of evolved and printed plans, best of {repeats}"
    rows = [
        Row(f"action checks, one core ({mix})", rate_one, "checks/s", ">= 3e6"),
        Row(f"action checks, {cores} cores ({mix})", rate_all, "checks/s"),
        Row(f"share of linear speed-up on {cores} cores", rate_all / (cores * rate_one), "share", ">= 0.8"),
        Row("load of the machine at that time, this work included", busy, "processes"),
    ]
    rows += [
        Row(f"action checks, one core, {load.name}", n / taken, "checks/s")
        for load, n, taken in zip(loads, checks, times[0::2], strict=True)
    ]
    return [*rows, *plain_rows(loads, say=say)]


def plain_rows(loads: Sequence[Load], *, plans: int = PLAIN_PLANS, say: Say = keep_quiet) -> list[Row]:
    """How many times faster than the plain evaluator, on the same plans."""
    say("the plain evaluator")
    name = "action checks, compiled to plain Python, one core"
    module = plain_module()
    if module is None:
        return [Row(f"{name} (needs a checkout: the plain evaluator lies in the tests)", NOTHING, "ratio", ">= 200")]
    checks, compiled, plain = 0, 0.0, 0.0
    for load in loads:
        if not load.name.endswith("evolved"):
            continue
        few = load.few(plans)
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
        compiled += times[0] / PLAIN_ROUNDS
        plain += times[1]
    return [
        Row(f"action checks, plain Python, one core (best of {PLAIN_REPEATS})", checks / plain, "checks/s"),
        Row(name, plain / compiled, "ratio", ">= 200"),
    ]


def _again(load: Load, problem: CompiledProblem, rounds: int) -> None:
    for _ in range(rounds):
        load.run(problem)


def _plainly(problem: PlainProblem, plans: Sequence[Ints]) -> None:
    for codes in plans:
        problem.carry_out(codes)
