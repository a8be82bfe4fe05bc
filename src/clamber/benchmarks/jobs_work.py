"""What the workers of `clamber bench jobs` do, and when they did it."""

import json
import os
import time
from functools import cache

from ..planning.sweep import plan_point
from ..types import Json


@cache
def _ready(text: str) -> float:
    """The moment at which this process has its kernels loaded: it plans once, for nothing."""
    plan_point(json.loads(text))
    return time.monotonic()


def timed_point(item: Json) -> Json:
    """Plan a point of a sweep, in a process that has planned before.

    Args:
        item: `point` as a sweep has it, and `warm`, another one as JSON text, to load the kernels with.

    Returns:
        The process, when it was ready, and what the point took by the clock and by the processor [s].
    """
    ready = _ready(item["warm"])
    started, worked = time.monotonic(), time.process_time()
    plan_point(item["point"])
    ended = time.monotonic() - started
    return {"process": os.getpid(), "ready": ready, "seconds": ended, "cpu": time.process_time() - worked}


def nothing(item: Json) -> Json:
    """An item that takes no time: what is left is the cost of handing it out."""
    return {"n": item["n"]}
