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
        item: `point` as a sweep has it, and its number `n`.

    Returns:
        The process, when it was ready, and how long the point took [s].
    """
    ready = _ready(json.dumps(item["warm"]))
    started = time.monotonic()
    plan_point(item["point"])
    return {"process": os.getpid(), "ready": ready, "seconds": time.monotonic() - started}


def nothing(item: Json) -> Json:
    """An item that takes no time: what is left is the cost of handing it out."""
    return {"n": item["n"]}
