"""How well a batch of items uses the cores: efficiency, cost of an item, rows of the store, and the law that follows."""

import json
import os
import tempfile
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache, partial
from pathlib import Path
from statistics import fmean
from typing import Final

from ..jobs import Executor, LocalProcesses, map_items
from ..jobs.store import Store
from ..planning.sweep import plan_point
from ..tasks import load_task
from ..trials.measured import Crew, Row, Say, keep_quiet
from ..types import Json

GOOD = 0.8
"""Efficiency from which a number of cores counts as worth it."""


@dataclass(frozen=True, slots=True)
class ScalingLaw:
    """Time of a batch of equal items: start + items * max(driver, (item + overhead) / cores) + one last item.

    The driver hands out items and stores results one after another: however many cores there are, a batch takes no less
    than that. Cores work side by side otherwise, and the last item ends alone. A bottleneck law: it says nothing of
    contention inside a machine (memory, shared caches), which the measured efficiency of this machine's cores shows.
    """

    start: float
    """From the call until the workers are ready, kernels loaded [s]; once a batch."""
    driver: float
    """Of the driver for each item: hand out, take back, store [s]."""
    overhead: float
    """Of a worker for each item, beside the item itself [s]."""

    def seconds(self, item: float, items: int, cores: int) -> float:
        """Predicted wall-clock time of a batch [s].

        Args:
            item: Time that one item takes on one core [s].
            items: How many there are.
            cores: Workers, each on a core of its own.
        """
        return self.start + items * max(self.driver, (item + self.overhead) / cores) + (item if cores > 1 else 0.0)

    def efficiency(self, item: float, items: int, cores: int) -> float:
        """Share of linear speed-up, the start included: one core's bare work over what all cores were there for [-]."""
        return item * items / (cores * self.seconds(item, items, cores))

    def shortest_item(self, items: int, cores: int) -> float:
        """Least time of an item [s] at which so many cores are `GOOD`; infinite where no item is long enough."""
        low, high = 1e-6, 1e6
        if self.efficiency(high, items, cores) < GOOD:
            return float("inf")
        while high / low > 1.001:
            middle = (low * high) ** 0.5
            low, high = (low, middle) if self.efficiency(middle, items, cores) >= GOOD else (middle, high)
        return high


@cache
def _ready(text: str) -> float:
    """The moment at which this process has its kernels loaded: it plans once, for nothing."""
    plan_point(json.loads(text))
    return time.monotonic()


def timed_point(item: Json) -> Json:
    """Plan a point of a sweep, in a process that has planned before.

    Args:
        item: `point` as a sweep has it, and `warm`, another one as JSON text, to load the kernels with.
    """
    return timed(_ready(item["warm"]), partial(plan_point, item["point"]))


def timed(ready: float, work: Callable[[], object]) -> Json:
    """This process, when it was ready, and what some work took by the clock and by the processor [s]."""
    started, worked = time.monotonic(), time.process_time()
    work()
    ended = time.monotonic() - started
    return {"process": os.getpid(), "ready": ready, "seconds": ended, "cpu": time.process_time() - worked}


def nothing(item: Json) -> Json:
    """An item that takes no time: what is left is the cost of handing it out."""
    return {"n": item["n"]}


ITEMS: Final = 1000
WORKERS: Final = (1, 2, 4)
PREDICTED: Final = (10, 100, 1000)
"""Cores that the law is asked about; no such machine was measured."""
LENGTHS: Final = (0.01, 0.1, 1.0, 10.0)
"""Times of an item that it is asked about [s]."""
PER_CORE: Final = 100
"""Items for each core in what is predicted."""


@dataclass(frozen=True, slots=True)
class Batch:
    """One measured batch."""

    start: float
    """Until the workers were ready, mean of all [s]."""
    work: float
    """Of the items themselves, all together [s]."""
    cpu: float
    """Processor time of the same [s]."""
    held: float
    """From ready to the end of the batch, all workers together [s]."""


def points(n: int) -> list[Json]:
    """Points of a sweep that take some ten milliseconds each: the ladder under many torque limits."""
    made = []
    for k in range(n):
        limits = ("rules.max_hangs=0", "goal.y_min=9in", f"motor.torque_limit={6.0 + 3.0 * k / n} Nm")
        document = load_task("ladder", limits).document
        made.append({"document": document, "planner": "exact", "options": {"max_stances": 5000}})
    warm = json.dumps(made[0])
    return [{"point": point, "warm": warm} for point in made]


def run_batch(
    items: Sequence[Json], executor: Executor, store: Path, do: Callable[[Json], Json] = timed_point
) -> Batch:
    """Run items and see when the workers were ready, what they worked, and when all of it had ended.

    The moments of all processes are compared, so they must be on one machine. What `do` returns is as `timed_point` has it.
    """
    called = time.monotonic()
    told = [one.result for one in map_items(do, items, executor=executor, store=store) if one.result]
    ended = time.monotonic()
    ready = {one["process"]: one["ready"] for one in told}
    held = sum(ended - moment for moment in ready.values())
    work, cpu = (sum(one[clock] for one in told) for clock in ("seconds", "cpu"))
    return Batch(fmean(ready.values()) - called, work, cpu, held)


def item_cost(executor: Executor, n: int, store: Path | None) -> float:
    """Time for each item that takes none [s]: between the first end and the last, so without the start."""
    moments: list[float] = []
    map_items(
        nothing,
        [{"n": k} for k in range(n)],
        executor=executor,
        store=store,
        progress=lambda *_: moments.append(time.monotonic()),
    )
    return (moments[-1] - moments[0]) / (n - 1)


def store_rate(n: int, store: Path) -> float:
    """Results that the store takes in a second, each on its own [1/s]."""
    result = "{" + '"reason": "' + "x" * 400 + '"}'
    with Store(store, "bench", "the benchmark", resume=False) as kept:
        started = time.perf_counter()
        for k in range(n):
            kept.keep(f"{k:064d}", "{" + "x" * 4000 + "}", result, 0.1, None, 1)
        return n / (time.perf_counter() - started)


def batch_rows(
    *, items: int = ITEMS, workers: Sequence[int] = WORKERS, crew: Crew | None = None, say: Say = keep_quiet
) -> list[Row]:
    """Efficiency on 1, 2 and 4 local workers, what an item and a stored row cost, and the law's predictions.

    Args:
        items: Points of the batch.
        workers: Numbers of local workers.
        crew: Its executor is a cluster on this machine, measured and predicted with, too; local processes are anyway.
        say: Told on the way.
    """
    rows: list[Row] = []
    plan_point((made := points(items))[0]["point"])  # compiles here, and not in every worker
    with tempfile.TemporaryDirectory() as folder:
        measured: dict[int, Batch] = {}
        for n in workers:
            say(f"{items} points on {n} workers")
            measured[n] = run_batch(made, LocalProcesses(n), Path(folder) / f"{n}.db")
        one = measured[workers[0]]
        point = one.work / items
        rows.append(Row(f"a point of the sweep, {workers[0]} worker", point * 1e3, "ms"))
        for n, batch in measured.items():
            aim = ">= 0.85" if n <= (os.cpu_count() or 1) else None
            rows += [
                Row(f"efficiency, {items} points on {n} workers, start apart", one.work / batch.held, "share", aim),
                Row(f"time of {n} ready workers that the points took", batch.work / batch.held, "share"),
                Row(f"processor time of the points, one worker to {n}", one.cpu / batch.cpu, "ratio"),
                Row(f"start of {n} workers, kernels loaded", batch.start, "s"),
            ]
        say("items that take no time")
        most = max(workers)
        alone = item_cost(LocalProcesses(1), items, None)
        driver = item_cost(LocalProcesses(most), 5 * items, Path(folder) / "nothing.db")
        rows += [
            Row("an item that takes no time, one worker, no store", alone * 1e6, "us"),
            Row(f"an item that takes no time, {most} workers, stored", driver * 1e6, "us"),
            Row("rows that the store takes", store_rate(5 * items, Path(folder) / "rows.db"), "rows/s"),
        ]
        laws = {"processes": ScalingLaw(one.start, driver, max(0.0, (one.held - one.work) / items))}
        if crew is not None and not crew.executor.here:
            say("the cluster")
            executor = crew.executor
            there = run_batch(made, executor, Path(folder) / "cluster.db")
            driver = item_cost(executor, items, Path(folder) / "cluster-nothing.db")
            laws["cluster"] = ScalingLaw(there.start, driver, max(0.0, (one.held - one.work) / items))
            rows += [
                Row(f"efficiency, {items} points on the cluster, start apart", one.work / there.held, "share"),
                Row("start of the cluster's workers, kernels loaded", there.start, "s"),
                Row("an item that takes no time, cluster, stored", driver * 1e6, "us"),
            ]
    rows.append(Row("load of the machine at that time, this work included", os.getloadavg()[0], "processes"))
    for name, law in laws.items():
        rows += prediction_rows(name, law)
    return rows


def prediction_rows(name: str, law: ScalingLaw) -> list[Row]:
    """What a law predicts for machines that nobody measured."""
    rows = []
    for cores in PREDICTED:
        for item in LENGTHS:
            share = law.efficiency(item, PER_CORE * cores, cores)
            rows.append(Row(f"predicted, {name}: efficiency on {cores} cores, items of {item:g} s", share, "share"))
        least = law.shortest_item(PER_CORE * cores, cores)
        rows.append(Row(f"predicted, {name}: items for {GOOD:g} on {cores} cores take at least", least, "s"))
    return rows
