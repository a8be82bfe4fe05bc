"""How many actions a second the kernels judge: on one core, on all of them, and against plain Python."""

import os
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, Final

import numpy as np

from ..planning.problem.problem import CompiledProblem
from ..types import Ints
from .plain_problem import PlainProblem, plain_module
from .rows import NOTHING, Row, Say, keep_quiet
from .workload import Load, whole_load

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


def plain_rows(loads: Sequence[Load], *, plans: int = PLAIN_PLANS, say: Say = keep_quiet) -> list[Row]:
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
