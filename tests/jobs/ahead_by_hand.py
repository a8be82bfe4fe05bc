"""Functions that tests/jobs/test_ahead.py has called in processes of their own, each told of its folder by the environment."""

import os
import signal
import sys
import time
from pathlib import Path
from typing import Any

from clamber.compiled import kernel
from clamber.jobs.ahead import ahead
from clamber.kernel_cache import is_compiled

FOLDER = Path(os.environ.get("AHEAD_BY_HAND", "."))


@kernel
def doubled(x: Any) -> Any:
    return x + x


def compile_one() -> None:
    doubled(1.0)
    (FOLDER / "compiled").touch()


def raise_aloud() -> None:
    print("to stdout", flush=True)
    (FOLDER / "raised").touch()
    raise RuntimeError("nobody hears this")


def die() -> None:
    (FOLDER / "died").touch()
    os.kill(os.getpid(), signal.SIGKILL)


def linger() -> None:
    with (FOLDER / "begun").open("w") as file:
        file.write(str(os.getpid()))
    (FOLDER / "begun").rename(FOLDER / "lingers")
    time.sleep(60.0)


def wait_for(name: str) -> None:
    """Until a function has come so far."""
    until = time.monotonic() + 60.0
    while not (FOLDER / name).exists():
        assert time.monotonic() < until, f"no {name}"
        time.sleep(0.01)


if __name__ == "__main__":
    from ahead_by_hand import doubled as importable

    with ahead(sys.argv[1:]):
        if "ahead_by_hand:linger" in sys.argv:
            wait_for("lingers")
            print("lingers", flush=True)
            time.sleep(60.0)
        wait_for("compiled")
        assert is_compiled("doubled")
        print(importable(1.0), sum(importable.stats.cache_misses.values()))
