"""A batch of items: results in the items' order, whoever runs them, whoever ends first and whoever dies."""

import json
from collections.abc import Callable, Sequence
from contextlib import closing, nullcontext
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

from ..files import Document, content_hash
from ..regular_files import is_there
from ..specs import build_spec
from ..types import Json
from .executor import Executor
from .local import LocalProcesses
from .store import Store
from .worker import find_function

T = TypeVar("T")


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


@dataclass(frozen=True, slots=True)
class Kept:
    """What a batch's store holds."""

    note: Json | None
    """Noted when it was made."""
    results: tuple[Json, ...]
    """Of the items that ended without an error."""


def look_into(store: Path, function: Callable[[Json], Json], *, about: Json | None = None, title: str) -> Kept | None:
    """What is in the store of a batch; None where there is no such file yet.

    Args:
        store: The file.
        function: As for `map_items`, which wrote it.
        about: Likewise.
        title: Likewise.

    Raises:
        StoreError: If the file can't be the store of this batch.
    """
    if not is_there(store):
        return None
    with Store(store, _identity(function, about), title, resume=True) as kept:
        return Kept(kept.noted(), tuple(result for _, result, _, _ in kept.finished()))


def read_result(kind: type[T], result: Json, store: Path | None = None) -> T:
    """A result as the record whose fields it has; one from a store may be damaged.

    Args:
        kind: A dataclass.
        result: What a function of a batch returned.
        store: Where it may come from.

    Raises:
        SpecError: If a field is missing, or has a value of another type.
    """
    return build_spec(kind, Document("a result" if store is None else f"{store}: a stored result", result))


def _identity(function: Callable[[Json], Json], about: Json | None) -> str:
    return content_hash([_name(function), about])


def _name(function: Callable[[Json], Json]) -> str:
    return f"{function.__module__}:{function.__qualname__}"


def map_items(
    function: Callable[[Json], Json],
    items: Sequence[Json],
    *,
    workers: int = 1,
    executor: Executor | None = None,
    store: Path | None = None,
    about: Json | None = None,
    title: str = "another batch",
    note: Json | None = None,
    resume: bool = False,
    progress: Progress | None = None,
) -> list[Outcome]:
    """Run a function on every item, in worker processes.

    Items and results travel as JSON text. Equal items are run once. An exception of the function is the outcome of its
    item; a worker that dies is replaced and its item tried again, at most `MOST_TRIES` times in all.

    Args:
        function: Defined at the top of an importable module; takes and returns plain data.
        items: Plain data.
        workers: Local processes at work at once; the results don't depend on it.
        executor: Who runs the items, in place of local processes.
        store: SQLite file that gets each end at once; None keeps nothing.
        about: Plain data that says what the batch is; a store of another batch is refused.
        title: The same in words.
        note: Plain data that a new store keeps beside its items, for `look_into`; it tells no batch from another.
        resume: Whether to go on with the store: finished items are not run again, those with an error are.
        progress: Told of each end.

    Returns:
        One outcome per item, in the order of `items`.

    Raises:
        StoreError: If the file can't be the store of this batch.
        ClusterError: If there is no cluster to run on, or it is lost.
        KeyboardInterrupt: After Ctrl-C; the store then holds all that had ended.
    """
    name = _name(function)
    assert find_function(name) is function, f"{name} must lie at the top of its module"
    texts = [json.dumps(item, sort_keys=True, allow_nan=False) for item in items]
    keys = [content_hash(text) for text in texts]
    left = dict(zip(keys, texts, strict=True))
    total = len(left)
    ends: dict[str, Outcome] = {}
    crew = executor or LocalProcesses(workers)
    noted = "" if note is None else json.dumps(note, sort_keys=True, allow_nan=False)
    opened = None if store is None else Store(store, _identity(function, about), title, resume=resume, note=noted)
    with nullcontext() if opened is None else opened as kept:
        if kept is not None:
            for key, result, seconds, tries in kept.finished():
                if left.pop(key, None) is not None:
                    ends[key] = Outcome(result, seconds, None, tries, stored=True)
        if left:
            crew.check()
        with closing(crew.run(name, left)) as running:
            for end in running:
                if kept is not None:
                    kept.keep(end.key, left[end.key], end.result, end.seconds, end.error, end.tries)
                told: Json | None = None if end.result is None else json.loads(end.result)
                ends[end.key] = Outcome(told, end.seconds, end.error, end.tries)
                if progress is not None:
                    progress(len(ends), total, ends[end.key])
    return [ends[key] for key in keys]
