"""Functions that the worker processes of tests/jobs/test_jobs.py run, and the batch that it kills from outside."""

import os
import signal
import sys
import time
from pathlib import Path
from typing import Any

from clamber.jobs import LocalProcesses, RayCluster, map_items


def square(item: dict[str, Any]) -> dict[str, Any]:
    """Writes that it ran into `item["log"]`; dies at its first try, always, or raises, as the item asks."""
    if "log" in item:
        with Path(item["log"]).open("a") as log:
            log.write(f"{item['n']} {os.getpid()}\n")
    if "die_once" in item and not Path(item["die_once"]).exists():
        Path(item["die_once"]).touch()
        os.kill(os.getpid(), signal.SIGKILL)
    if item.get("die"):
        os._exit(3)
    if item.get("raise"):
        raise ValueError("thirteen is not liked")
    time.sleep(item.get("sleep", 0.0))
    return {"square": item["n"] ** 2, "blas": os.environ["OPENBLAS_NUM_THREADS"]}


def batch(folder: Path, n: int = 16, sleep: float = 0.04) -> list[dict[str, Any]]:
    return [{"n": k, "log": str(folder / "log"), "sleep": sleep} for k in range(n)]


if __name__ == "__main__":
    from jobs_by_hand import square as importable

    place = Path(sys.argv[1])
    size = (int(sys.argv[2]), float(sys.argv[3])) if len(sys.argv) > 2 else ()
    executor = RayCluster(sys.argv[4]) if len(sys.argv) > 4 else LocalProcesses(2)
    map_items(importable, batch(place, *size), executor=executor, store=place / "store.db", resume=True)
