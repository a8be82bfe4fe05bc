"""What the workers of `clamber bench climb` do, and when they did it."""

import os
import time
from functools import cache

from ..families.climber.planning.plans import thesis_code
from ..families.climber.planning.task import LimbedTask
from ..families.climber.trials.noise import NO_NOISE, read_noise
from ..families.climber.trials.run_plan import climbing_flaws, climbing_task, run_plan
from ..families.climber.trials.warm_up import warm_up
from ..planning.problem.plan import Plan
from ..tasks import load_task
from ..types import Json

RUNGS = (106, 301, 205, 300, 3, 3, 304, 108, 303, 207, 300, 3, 3)
"""Two rungs of the ladder by the gait of the thesis, its numbers of actions."""
NOISE = "peg_error=3mm"
"""Of the trials."""


@cache
def two_rungs() -> tuple[LimbedTask, Plan]:
    """The climb that is timed."""
    task = climbing_task(load_task("ladder"))
    return task, Plan.of_codes(task, [thesis_code(task, number) for number in RUNGS])


@cache
def _ready() -> float:
    """The moment at which this process has its kernels loaded."""
    warm_up()
    return time.monotonic()


def timed_trial(item: Json) -> Json:
    """Two rungs with pegs off the map by a seed, in a process that has climbed before.

    Args:
        item: `seed`.

    Returns:
        The process, when it was ready, and what the trial took by the clock and by the processor [s].
    """
    ready = _ready()
    task, plan = two_rungs()
    started, worked = time.monotonic(), time.process_time()
    run_plan(task, plan, climbing_flaws(task, ()), noise=read_noise(NO_NOISE, [NOISE]), seed=item["seed"])
    ended = time.monotonic() - started
    return {"process": os.getpid(), "ready": ready, "seconds": ended, "cpu": time.process_time() - worked}
