"""A log written while it is recorded: whatever ends the process, what was recorded until half a second before can be read."""

import json
import os
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from queue import Empty, SimpleQueue
from threading import Thread
from types import TracebackType
from typing import IO, Any, Final

from ..errors import FileError
from ..types import Floats, Json
from .log_mcap import NOTES, TOPIC, open_channel, stamp_of
from .sample_log import report_notes
from .samples import Samples

FLUSHED: Final = 0.5
"""A sample waits at most that long for those after it before all of them are written, by the wall's clock [s]."""
PART: Final = ".part"
"""In the name of a log that is not finished."""


def part_of(path: Path) -> Path:
    """Where a log grows before it is whole: "run.part.mcap" for "run.mcap"; it opens like any other."""
    return path.with_name(f"{path.stem}{PART}{path.suffix}")


class LogStream:
    """One MCAP channel that grows in `part_of(path)`; `finish` gives the file its name. A context: left early, it keeps the part.

    No file is made before the first sample. A killed process leaves the part, which lacks only what was recorded after the last
    flush; a power cut may take more, for only `finish` waits for the disk. The file is a thread's own, so that Ctrl-C never comes
    between the halves of a record, and samples are flushed while the robot's loop is busy elsewhere.

    Args:
        path: The .mcap file that is to be.
        titles: Of the columns, such as "time [s]"; the first is the time.
        notes: What is known beforehand.
        topic: Name of the channel.
    """

    def __init__(self, path: Path, titles: tuple[str, ...], notes: Mapping[str, str], topic: str = TOPIC) -> None:
        self.path, self.part = path, part_of(path)
        self._titles, self._notes, self._topic = titles, dict(notes), topic
        self._queue: SimpleQueue[Floats | Mapping[str, str] | None] = SimpleQueue()
        self._thread = Thread(target=self._work, name=f"log {path.name}", daemon=True)
        self._failed: OSError | None = None

    def add(self, row: Floats) -> None:
        """Take a sample, shape (columns,), which must not change any more; one no later than that before is a repetition, and left out.

        Raises:
            FileError: If the file cannot be written.
        """
        self._check()
        self._queue.put(row)
        if self._thread.ident is None:
            self._thread.start()

    def finish(self, notes: Mapping[str, str]) -> None:
        """Write what came out as metadata, and let the file have its name.

        Raises:
            FileError: If the file cannot be written.
        """
        self._queue.put(dict(notes))
        self._wait()
        self._check()

    def __enter__(self) -> "LogStream":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        if self._thread.is_alive():
            self._queue.put(None)
            self._wait()

    def _wait(self) -> None:
        if self._thread.ident is None:
            self._thread.start()
        self._thread.join()

    def _check(self) -> None:
        if self._failed is not None:
            problem = f"cannot be written ({self._failed.strerror})"
            raise FileError(str(self.part), problem, "name a file in a writable folder with space left") from None

    def _work(self) -> None:
        """What the thread does, from the first sample to the last."""
        try:
            with self.part.open("wb") as file:
                notes = self._write(file)
                os.fsync(file.fileno())
            if notes is not None:
                os.replace(self.part, self.path)
        except OSError as error:
            self._failed = error

    def _write(self, file: IO[bytes]) -> Mapping[str, str] | None:
        """Write samples until the last; the notes of the end, None if it came too early."""
        from mcap.writer import Writer

        writer: Any = Writer(file)
        writer.start(profile="", library="clamber")
        channel = open_channel(writer, self._topic, self._titles, self._notes)
        rows, before, flushed = 0, -1, 0.0
        while True:
            if time.monotonic() - flushed > FLUSHED:
                writer.flush()
                flushed = time.monotonic()
            try:
                row = self._queue.get(timeout=FLUSHED)
            except Empty:
                continue
            if row is None or isinstance(row, Mapping):
                break
            stamp = stamp_of(float(row[0]))
            if stamp > before:
                data = json.dumps(dict(zip(self._titles, row.tolist(), strict=True))).encode()
                writer.add_message(channel, stamp, data, stamp, rows)
                rows, before = rows + 1, stamp
        writer.flush()
        if row is not None:
            writer.add_metadata(NOTES, dict(row))
            writer.finish()
        file.flush()
        return row


@contextmanager
def growing_log(
    path: Path | None, samples: Samples, titles: tuple[str, ...], notes: Mapping[str, str], topic: str
) -> Iterator[Callable[[Json], None]]:
    """A run's log that grows with its samples; what is yielded takes the report, and the file is whole then.

    Args:
        path: The .mcap file that is to be; None: there is none.
        samples: Of the run.
        titles: Of their numbers.
        notes: What is known beforehand.
        topic: Name of the channel.

    Raises:
        FileError: If the file cannot be written.
    """
    if path is None:
        yield lambda _: None
        return
    with LogStream(path, titles, notes, topic) as stream:
        samples.told = stream.add

        def finish(report: Json) -> None:
            stream.add(samples.last())
            stream.finish(report_notes(report))

        yield finish
