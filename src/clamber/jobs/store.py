"""The store of a batch: one SQLite file that gets each result as it ends, so that a killed run loses none."""

import json
import math
import os
import sqlite3
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from types import TracebackType
from typing import Any, Final

from ..errors import StatedError, printable
from ..files import parse_json
from ..regular_files import check_target
from ..types import Json
from .release import difference, release

SCHEMA: Final = "clamber-jobs-1"
LOOK: Final = 1.0
"""Between two looks whether another process still has the file locked [s]."""
PATIENCE = 120.0
"""The longest wait for that at the end of an item [s]: what took minutes is not to be lost to somebody who looks into the file."""


class StoreError(StatedError):
    """A file can't be the store of this batch."""

    says = "{path}: {problem}; {allowed}"
    path: str
    problem: str
    allowed: str


class Store:
    """Items and their results by key; a result is either there whole or not at all. Used in a `with` block."""

    def __init__(self, path: Path, identity: str, title: str, *, resume: bool, note: str = "") -> None:
        """Open it, or make it if there is no such file.

        Args:
            path: The file.
            identity: Hash of what the batch is about; a store of another one is refused.
            title: What the batch is about, for the error that refuses it later.
            resume: Whether finished items may be there already.
            note: Kept beside the items, unless something is already.

        Raises:
            StoreError: If the file is no store, belongs to another batch, is in use, or has results and `resume` is off.
        """
        self._path = path
        self.note = ""
        """What was noted beside the items first."""
        check_target(path)
        try:
            self._lock = _locked(path)
        except BlockingIOError:
            raise self._refuse("is in use by another process", "wait for it, or name another file") from None
        except OSError as error:
            raise self._refuse(f"cannot be opened ({error.strerror})", "name a file in a writable folder") from None
        self._file = sqlite3.connect(path, timeout=LOOK, isolation_level=None)
        try:
            self._open(identity, title, resume=resume)
            self._keep_note(note)
        except sqlite3.Error as error:
            self._close()
            if "locked" in str(error):
                raise self._refuse("is in use by another process", "wait for it, or name another file") from None
            raise self._refuse(f"is no store of results ({error})", "name another file") from None
        except StoreError:
            self._close()
            raise

    def _open(self, identity: str, title: str, *, resume: bool) -> None:
        # A log to append to, not synced at every row: a row costs 0.05 ms instead of some ms and outlives this process;
        # others may read meanwhile.
        self._file.execute("PRAGMA journal_mode = WAL")
        self._file.execute("PRAGMA synchronous = NORMAL")
        self._file.execute("BEGIN EXCLUSIVE")
        tables = {name for (name,) in self._file.execute("SELECT name FROM sqlite_master WHERE type = 'table'")}
        if not tables:
            self._file.execute("CREATE TABLE about (key TEXT PRIMARY KEY, value TEXT NOT NULL)")
            self._file.execute(
                "CREATE TABLE items (key TEXT PRIMARY KEY, item TEXT NOT NULL, "
                "result TEXT, seconds REAL NOT NULL, error TEXT, tries INTEGER NOT NULL)"
            )
            mine = json.dumps(release(), sort_keys=True)
            about = (("schema", SCHEMA), ("identity", identity), ("title", title), ("release", mine))
            self._file.executemany("INSERT INTO about VALUES (?, ?)", about)
        elif not {"about", "items"} <= tables:
            raise self._refuse("is a database of something else", "name another file")
        self._file.execute("COMMIT")
        stored = dict(self._file.execute("SELECT key, value FROM about"))
        if stored.get("schema") != SCHEMA:
            raise self._refuse(f"has the schema {stored.get('schema')!r}, not {SCHEMA!r}", "name another file")
        if stored.get("identity") != identity:
            theirs = stored.get("title", "an unnamed batch")
            mine = "" if theirs == title else f", not {title}"
            why = mine or ", but with other data or settings"
            raise self._refuse(f"holds the results of {theirs}{why}", "name another file")
        self._check_release(stored.get("release"))
        (finished,) = self._file.execute("SELECT count(*) FROM items WHERE error IS NULL").fetchone()
        if finished and not resume:
            raise self._refuse(f"has {finished} finished items of this batch", "resume it, or name another file")

    def _check_release(self, stored: str | None) -> None:
        """Results of other code are not mixed with those of this one."""
        told = _json_of(stored)
        if not isinstance(told, dict) or told != release():
            other = difference(release(), told) if isinstance(told, dict) else "of code that it does not name"
            allowed = "go on with the code that began it, or name another file to begin anew with this one"
            raise self._refuse(f"has results of another release of Clamber ({other})", allowed)

    def _keep_note(self, note: str) -> None:
        for (kept,) in self._file.execute("SELECT value FROM about WHERE key = 'note'"):
            self.note = kept
            return
        self.note = note
        if note:
            self._file.execute("INSERT INTO about VALUES ('note', ?)", (note,))

    def noted(self) -> Json | None:
        """What was noted beside the items first, as plain data; None where nothing was.

        Raises:
            StoreError: If it is damaged.
        """
        told: Json | None = _json_of(self.note) if self.note else None
        if self.note and told is None:
            raise self._refuse("has a damaged note (about, key 'note')", "name another file")
        return told

    def _refuse(self, problem: str, allowed: str) -> StoreError:
        return StoreError(str(self._path), problem, allowed)

    def __enter__(self) -> "Store":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._close()

    def _close(self) -> None:
        self._file.close()
        os.close(self._lock)  # after the database: closing any handle of a file drops the locks that SQLite has on it

    def finished(self) -> Iterator[tuple[str, Json, float, int]]:
        """Key, result, seconds and tries of every item that ended without an error."""
        try:
            rows = self._file.execute("SELECT key, result, seconds, tries FROM items WHERE error IS NULL").fetchall()
        except (sqlite3.Error, UnicodeDecodeError) as error:
            raise self._refuse(f"is damaged ({error})", "name another file") from None
        for number, (key, result, seconds, tries) in enumerate(rows, start=1):
            told = _json_of(result)
            sound = isinstance(key, str) and isinstance(told, dict) and isinstance(tries, int)
            if not sound or not isinstance(seconds, float) or not math.isfinite(seconds):
                raise self._refuse(f"finished item {number} is damaged", "name another file, to begin anew")
            yield key, told, seconds, tries

    def keep(self, key: str, item: str, result: str | None, seconds: float, error: str | None, tries: int) -> None:
        """Write one item's end; it outlives this process when this returns.

        A power cut may take the last rows, whole, with it; they are then run again.

        Raises:
            StoreError: If it cannot be written, as on a full disk, or another process keeps it locked for longer than `PATIENCE`.
        """
        row = (key, item, result, seconds, error, tries)
        began, told = time.monotonic(), False
        while True:
            try:
                self._file.execute("INSERT OR REPLACE INTO items VALUES (?, ?, ?, ?, ?, ?)", row)
                return
            except sqlite3.Error as problem:
                locked = "locked" in str(problem)
                if not locked or time.monotonic() - began > PATIENCE:
                    allowed = "what is in it stays; resume when it can"
                    raise self._refuse(f"cannot be written ({problem})", allowed) from None
            if not told:
                waits = f"{self._path}: is locked by another process; waiting for it, {PATIENCE:.0f} s at most"
                print(printable(waits), file=sys.stderr)
                told = True


def _json_of(text: Any) -> Any:
    """Plain data from JSON text; None where it is none, or has a number that is not finite."""
    try:
        return parse_json(text)
    except (ValueError, TypeError):
        return None


def _locked(path: Path) -> int:
    """Open a file, or make it, so that no other run does: two runs at once on one store would do everything twice.

    The system frees it when the process dies. Systems without `flock` don't refuse the second run.

    Raises:
        BlockingIOError: If another process has it.
        OSError: If it can't be opened.
    """
    handle = os.open(path, os.O_RDWR | os.O_CREAT, 0o666)
    try:
        import fcntl

        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except ImportError:
        pass
    except OSError:
        os.close(handle)
        raise
    return handle
