"""A log written while it is recorded: whatever ends the process, what was recorded until half a second before can be read.

Nothing that befalls a log ends what it is a log of: a full disk is told once, and the report says from when on the log is missing.
"""

import json
import os
import time
import warnings
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from queue import Empty, SimpleQueue
from threading import Thread
from types import TracebackType
from typing import IO, Any, Final

from ..json_form import Jsonable
from ..regular_files import check_target, open_growing
from ..types import Floats, Json
from .log_mcap import NOTES, TOPIC, open_channel, stamp_of
from .log_scene import LoggedScene, SceneWriter
from .sample_log import report_notes
from .samples import Samples

FLUSHED: Final = 0.5
"""A sample waits at most that long for those after it before all of them are written, by the wall's clock [s]."""
PART: Final = ".part"
"""In the name of a log that is not finished."""


@dataclass(frozen=True, slots=True)
class LogGap(Jsonable):
    """What the log lacks that could not be written to its end."""

    since: float
    """Time of the first sample that may be missing [s]."""
    file: str
    """What there is of it."""
    problem: str
    """Why."""

    def __str__(self) -> str:
        return f"{self.file}: cannot be written ({self.problem}): the log is missing from {self.since:.2f} s on"


def warn(words: str) -> None:
    """Tell a program that runs robots from Python."""
    warnings.warn(words, RuntimeWarning, stacklevel=2)


@dataclass(frozen=True, slots=True)
class WantedLog:
    """A log that a run is to write, and who is told, once, if that cannot go on."""

    path: Path
    tell: Callable[[str], None] = warn


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
        scene: The samples in three dimensions, on channels of their own; None: there is none.
    """

    def __init__(
        self,
        path: Path,
        titles: tuple[str, ...],
        notes: Mapping[str, str],
        topic: str = TOPIC,
        scene: LoggedScene | None = None,
    ) -> None:
        self.path = check_target(path)
        self.part = part_of(self.path)
        self._titles, self._notes, self._topic, self._scene = titles, dict(notes), topic, scene
        self._queue: SimpleQueue[Floats | Mapping[str, str] | None] = SimpleQueue()
        self._thread = Thread(target=self._work, name=f"log {path.name}", daemon=True)
        self._unsure: float | None = None
        """Time of the first sample that may not have been written yet [s]."""
        self.gap: LogGap | None = None
        """What is missing; None: nothing so far."""

    def add(self, row: Floats) -> None:
        """Take a sample, shape (columns,), which must not change any more; one no later than that before is a repetition, and left out.

        Once the file cannot be written (`gap`), samples are thrown away.
        """
        if self.gap is not None:
            return
        self._queue.put(row)
        if self._thread.ident is None:
            self._thread.start()

    def finish(self, notes: Mapping[str, str]) -> None:
        """Write what came out as metadata, and let the file have its name, unless there is a `gap`."""
        self._queue.put(dict(notes))
        self._wait()

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

    def _work(self) -> None:
        """What the thread does, from the first sample to the last."""
        try:
            with open_growing(self.part) as file:
                notes = self._write(file)
                os.fsync(file.fileno())
            if notes is not None:
                os.replace(self.part, self.path)
        except Exception as error:  # whatever it is, it is no reason to let go of a robot
            problem = (error.strerror if isinstance(error, OSError) else None) or str(error) or type(error).__name__
            self.gap = LogGap(self._unsure or 0.0, str(self.part), problem)

    def _write(self, file: IO[bytes]) -> Mapping[str, str] | None:
        """Write samples until the last; the notes of the end, None if it came too early."""
        from mcap.writer import Writer

        writer: Any = Writer(file)
        writer.start(profile="", library="clamber")
        scene = None if self._scene is None else SceneWriter(writer, self._scene)
        channel = open_channel(writer, self._topic, self._titles, self._notes)
        rows, before, flushed = 0, -1, 0.0
        while True:
            if time.monotonic() - flushed > FLUSHED:
                writer.flush()
                file.flush()
                flushed, self._unsure = time.monotonic(), None
            try:
                row = self._queue.get(timeout=FLUSHED)
            except Empty:
                continue
            if row is None or isinstance(row, Mapping):
                break
            stamp = stamp_of(float(row[0]))
            if self._unsure is None:
                self._unsure = float(row[0])
            if stamp > before:
                data = json.dumps(dict(zip(self._titles, row.tolist(), strict=True))).encode()
                writer.add_message(channel, stamp, data, stamp, rows)
                rows, before = rows + 1, stamp
                if scene is not None:
                    scene.add(row, stamp)
        writer.flush()
        if row is not None:
            writer.add_metadata(NOTES, dict(row))
            writer.finish()
        file.flush()
        return row


@contextmanager
def growing_log(
    wanted: Path | WantedLog | None,
    samples: Samples,
    titles: tuple[str, ...],
    notes: Mapping[str, str],
    topic: str,
    scene: LoggedScene | None = None,
) -> Iterator[Callable[[Json], LogGap | None]]:
    """A run's log that grows with its samples; what is yielded takes the report, ends the file, and returns what that lacks.

    Args:
        wanted: The .mcap file that is to be; None: there is none.
        samples: Of the run.
        titles: Of their numbers.
        notes: What is known beforehand.
        topic: Name of the channel.
        scene: The samples in three dimensions.

    Raises:
        FileError: If the file cannot be made.
    """
    if wanted is None:
        yield lambda _: None
        return
    path, tell = (wanted.path, wanted.tell) if isinstance(wanted, WantedLog) else (wanted, warn)
    with LogStream(path, titles, notes, topic, scene) as stream:
        told = False

        def add(row: Floats) -> None:
            nonlocal told
            stream.add(row)
            if stream.gap is not None and not told:
                told = True
                tell(str(stream.gap))

        samples.told = add

        def finish(report: Json) -> LogGap | None:
            stream.add(samples.last())
            stream.finish(report_notes(report))
            if stream.gap is not None and not told:
                tell(str(stream.gap))
            return stream.gap

        yield finish
