"""Items over local worker processes: results in the items' order, whoever ends first and whoever dies."""

import json
import os
import signal
from collections import Counter, deque
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, nullcontext, suppress
from dataclasses import dataclass
from multiprocessing import get_context
from multiprocessing.connection import Connection, wait
from multiprocessing.context import SpawnProcess
from pathlib import Path
from typing import Any, Final

from ..files import content_hash
from ..types import Json
from .store import Store
from .worker import find_function, serve

MOST_TRIES: Final = 3
"""An item whose worker dies is run again in a fresh one, until it was tried so often."""


@dataclass(frozen=True, slots=True)
class Outcome:
    """How one item ended."""

    result: Json | None
    """What the function returned; None if it raised, or its workers died."""
    seconds: float
    """Wall-clock time of the run that ended it [s]."""
    error: str | None
    """In place of a result: what was raised, or that the worker died."""
    tries: int
    """Workers that it took."""
    stored: bool = False
    """Whether it was in the store already."""


Progress = Callable[[int, int, Outcome], None]
"""Called at each end with the number of items that ended, of all, and the outcome."""


def map_items(
    function: Callable[[Json], Json],
    items: Sequence[Json],
    *,
    workers: int = 1,
    store: Path | None = None,
    about: Json | None = None,
    title: str = "another batch",
    resume: bool = False,
    progress: Progress | None = None,
) -> list[Outcome]:
    """Run a function on every item, in worker processes.

    Items and results travel as JSON text. Equal items are run once. An exception of the function is the outcome of its
    item; a worker that dies is replaced and its item tried again, at most `MOST_TRIES` times in all.

    Args:
        function: Defined at the top of an importable module; takes and returns plain data.
        items: Plain data.
        workers: Processes at work at once; the results don't depend on it.
        store: SQLite file that gets each end at once; None keeps nothing.
        about: Plain data that says what the batch is; a store of another batch is refused.
        title: The same in words.
        resume: Whether to go on with the store: finished items are not run again, those with an error are.
        progress: Told of each end.

    Returns:
        One outcome per item, in the order of `items`.

    Raises:
        StoreError: If the file can't be the store of this batch.
        KeyboardInterrupt: After Ctrl-C; the store then holds all that had ended.
    """
    name = f"{function.__module__}:{function.__qualname__}"
    assert find_function(name) is function, f"{name} must lie at the top of its module"
    texts = [json.dumps(item, sort_keys=True, allow_nan=False) for item in items]
    keys = [content_hash(text) for text in texts]
    left = dict(zip(keys, texts, strict=True))
    total = len(left)
    ends: dict[str, Outcome] = {}
    identity = content_hash([name, about])
    with nullcontext() if store is None else Store(store, identity, title, resume=resume) as kept:
        if kept is not None:
            for key, result, seconds, tries in kept.finished():
                if left.pop(key, None) is not None:
                    ends[key] = Outcome(result, seconds, None, tries, stored=True)
        for key, end, tries in _run(name, left, workers):
            if kept is not None:
                kept.keep(key, left[key], end["result"], end["seconds"], end["error"], tries)
            told: Json | None = None if end["result"] is None else json.loads(end["result"])
            ends[key] = Outcome(told, end["seconds"], end["error"], tries)
            if progress is not None:
                progress(len(ends), total, ends[key])
    return [ends[key] for key in keys]


def _run(name: str, items: dict[str, str], workers: int) -> Iterator[tuple[str, Json, int]]:
    """Key, end and tries of each item, as they end."""
    queue = deque(items)
    tries: Counter[str] = Counter()
    busy: dict[Any, tuple[SpawnProcess, str]] = {}  # the parent's end of a worker's line -> the worker and its item

    def give(line: "Connection[Any, Any]", process: SpawnProcess) -> None:
        key = queue.popleft()
        tries[key] += 1
        busy[line] = process, key
        with suppress(OSError):  # it died while idle or at its start; the wait below sees it
            line.send_bytes(items[key].encode())

    try:
        while queue or busy:
            while queue and len(busy) < workers:
                give(*_start(name))
            for line in wait(list(busy)):
                assert isinstance(line, Connection)
                process, key = busy.pop(line)
                try:
                    end = json.loads(line.recv_bytes())
                except (EOFError, OSError):
                    process.join()
                    line.close()
                    if tries[key] < MOST_TRIES:
                        queue.append(key)
                        continue
                    died = f"its worker process died {MOST_TRIES} times, {_death(process.exitcode)}"
                    end = {"result": None, "seconds": 0.0, "error": died}
                else:
                    if queue:
                        give(line, process)
                    else:
                        line.close()  # its worker leaves
                yield key, end, tries[key]
    finally:
        for line, (process, _) in busy.items():
            process.kill()
            process.join()
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
    """A worker inherits one BLAS thread, for many small matrices, and no Ctrl-C, which its parent sees to."""
    before = os.environ.get("OPENBLAS_NUM_THREADS")
    os.environ["OPENBLAS_NUM_THREADS"] = "1"
    masks = hasattr(signal, "pthread_sigmask")
    mask = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT}) if masks else set()
    try:
        yield
    finally:
        if masks:
            signal.pthread_sigmask(signal.SIG_SETMASK, mask)
        if before is None:
            del os.environ["OPENBLAS_NUM_THREADS"]
        else:
            os.environ["OPENBLAS_NUM_THREADS"] = before
