"""Items over local processes, which may die."""

import json
import os
import signal
import sys
from collections import Counter, deque
from collections.abc import Generator, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from multiprocessing import get_context
from multiprocessing.connection import Connection, wait
from multiprocessing.context import SpawnProcess
from multiprocessing.resource_tracker import ensure_running
from typing import Any, Final

from .executor import MOST_TRIES, End
from .worker import serve

AHEAD: Final = 2
"""Items that a worker has in hand: one at work, the next one waiting, so that it needn't wait for the parent."""
MOST_AHEAD: Final = 16_384
"""Longest item that is sent ahead [bytes]; a longer one may fill the line, and its sender would wait."""


@dataclass(slots=True)
class _Worker:
    """A process and what it was given."""

    process: SpawnProcess
    given: deque[str] = field(default_factory=deque)
    """Keys of its items, in its order: the first one is at work."""


@dataclass(frozen=True, slots=True)
class LocalProcesses:
    """Processes of this machine, spawned; one that dies is replaced."""

    workers: int = 1

    @property
    def here(self) -> bool:
        """True."""
        return True

    def check(self) -> None:
        """Local processes can always start."""

    def run(self, name: str, items: Mapping[str, str]) -> Generator[End]:
        """See `Executor`."""
        queue = deque(items)
        tries: Counter[str] = Counter()
        busy: dict[Any, _Worker] = {}  # the parent's end of a worker's line -> the worker

        def give(line: Any, worker: _Worker) -> None:
            while queue and len(worker.given) < AHEAD:
                text = items[queue[0]].encode()
                if worker.given and (len(text) > MOST_AHEAD or len(queue) < len(busy)):
                    return  # the last items go to whoever is idle first
                worker.given.append(queue.popleft())
                with suppress(OSError):  # it died while idle or at its start; the wait below sees it
                    line.send_bytes(text)

        try:
            while queue or busy:
                while queue and len(busy) < self.workers:
                    ours, process = _start(name)
                    busy[ours] = _Worker(process)
                    give(ours, busy[ours])
                for line in wait(list(busy)):
                    assert isinstance(line, Connection)
                    worker = busy[line]
                    try:
                        told = json.loads(line.recv_bytes())
                    except (EOFError, OSError):
                        worker.process.join()
                        line.close()
                        del busy[line]
                        key, *waiting = worker.given
                        queue.extendleft(reversed(waiting))  # it hadn't begun those
                        tries[key] += 1
                        if tries[key] < MOST_TRIES:
                            queue.append(key)
                            continue
                        died = f"its worker process died {MOST_TRIES} times, {_death(worker.process.exitcode)}"
                        yield End(key, None, 0.0, died, tries[key])
                    else:
                        key = worker.given.popleft()
                        give(line, worker)
                        if not worker.given:
                            del busy[line]
                            line.close()  # its worker leaves
                        yield End(key, told["result"], told["seconds"], told["error"], tries[key] + 1)
        finally:
            for line, worker in busy.items():
                worker.process.kill()
                worker.process.join()
                line.close()


def _death(code: int | None) -> str:
    return f"killed by signal {-code}" if code is not None and code < 0 else f"with exit code {code}"


def _start(name: str) -> tuple["Connection[Any, Any]", SpawnProcess]:
    spawn = get_context("spawn")  # a fork would copy locks that threads of ours or of a library hold
    ours, theirs = spawn.Pipe()
    process = spawn.Process(target=serve, args=(name, theirs), daemon=True)
    with _quiet_start():
        process.start()
    theirs.close()  # else the death of the worker would not close the line
    return ours, process


@contextmanager
def _quiet_start() -> Iterator[None]:
    """A worker inherits one BLAS thread, for many small matrices, and no Ctrl-C, which its parent sees to.

    It does not inherit the script that Python runs, either: it has no use for it, and one that starts work at its top level would
    start it in every worker again.
    """
    main = sys.modules["__main__"]
    ran: dict[str, Any] = {name: main.__dict__[name] for name in ("__spec__", "__file__") if name in main.__dict__}
    main.__dict__.pop("__file__", None)
    main.__dict__["__spec__"] = None
    before = os.environ.get("OPENBLAS_NUM_THREADS")
    os.environ["OPENBLAS_NUM_THREADS"] = "1"
    if os.name == "posix":
        ensure_running()  # which would let Ctrl-C in again if it were begun below
    masks = hasattr(signal, "pthread_sigmask")
    mask = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT}) if masks else set()
    try:
        yield
    finally:
        main.__dict__.update(ran)
        if masks:
            signal.pthread_sigmask(signal.SIG_SETMASK, mask)
        if before is None:
            del os.environ["OPENBLAS_NUM_THREADS"]
        else:
            os.environ["OPENBLAS_NUM_THREADS"] = before
