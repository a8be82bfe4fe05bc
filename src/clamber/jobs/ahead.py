"""Work begun ahead of its time, in other processes: what comes of it lies on disk and is found there later, or else is not."""

import os
import subprocess
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from importlib import import_module
from threading import Thread
from typing import Final


def usable_cores() -> int:
    """Cores that this process may use: fewer than the machine has where it was pinned to some."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


CALL: Final = "import sys; from clamber.jobs.ahead import call; call(sys.argv[1])"


@contextmanager
def ahead(names: Sequence[str]) -> Iterator[None]:
    """Call functions while a block runs, each in a process of its own; what is not done when the block ends is given up.

    Nobody waits for them or hears how they end. One core is left to the block, so on one core nothing is begun.

    Args:
        names: The functions, as "module:name", those first that matter most; they take nothing and give nothing.
    """
    begun = []
    try:
        for name in names[: usable_cores() - 1]:
            with suppress(OSError):  # no room for another process: the block does it all
                begun.append(_begin(name))
        yield
    finally:
        for process in begun:
            process.kill()
            process.communicate()


def _begin(name: str) -> "subprocess.Popen[bytes]":
    """A process that looks for modules where this one does; not a worker of `local`, which would read its caller's main file again."""
    return subprocess.Popen(
        [sys.executable, "-P", "-c", CALL, name],
        stdin=subprocess.PIPE,  # closed when this process ends, whatever ends it
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        env=os.environ | {"PYTHONPATH": os.pathsep.join(map(str, sys.path)), "OPENBLAS_NUM_THREADS": "1"},
    )


def call(name: str) -> None:
    """What such a process does, until it is done or its parent has ended."""
    Thread(target=_leave_with_parent, daemon=True).start()
    module, _, function = name.partition(":")
    getattr(import_module(module), function)()


def _leave_with_parent() -> None:
    os.read(sys.stdin.fileno(), 1)  # nothing is ever sent
    os._exit(1)
