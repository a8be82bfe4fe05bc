"""Samples of a run: one every few ticks, one of the tick that ends it, each told once; and a table that comes back from its log."""

import resource
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from clamber.execution.log import LogError
from clamber.execution.log_files import read_log
from clamber.execution.log_stream import WantedLog, growing_log, part_of
from clamber.execution.sample_log import fields_of, report_notes, report_of, sample_log, table_of, width
from clamber.execution.samples import Samples
from clamber.types import Floats, Ints

TITLES = {
    "time": ("time [s]",),
    "step": ("step",),
    "places": ("left x [m]", "left y [m]", "right x [m]", "right y [m]"),
}


class Counter:
    def __init__(self) -> None:
        self.ticks = 0

    def tick(self) -> None:
        self.ticks += 1

    def stop(self) -> None:
        raise KeyboardInterrupt

    def sample(self) -> Floats:
        return np.array((self.ticks, -self.ticks), dtype=np.float64)


@given(st.integers(0, 40), st.integers(1, 7))
def test_a_sample_is_taken_every_few_ticks_and_at_the_last_one(ticks: int, every: int) -> None:
    robot, told = Counter(), []
    samples = Samples(robot, every)
    samples.told = told.append
    for _ in range(ticks):
        samples.over(robot.tick)
    with pytest.raises(KeyboardInterrupt):
        samples.over(robot.stop)
    kept = samples.table()[:, 0].tolist()
    assert kept == sorted({*range(every, ticks + 1, every), ticks})
    assert [row[0] for row in told] == kept[:-1]
    assert samples.last().tolist() == [ticks, -ticks]
    assert len(samples.table()) == len(kept)


def test_a_log_that_grows_is_whole_at_the_end_and_else_what_there_was(tmp_path: Path) -> None:
    robot = Counter()
    samples = Samples(robot, 1)
    with growing_log(tmp_path / "run.mcap", samples, ("time [s]", "less"), {"robot": "toy"}, "toy") as finish:
        for _ in range(5):
            samples.over(robot.tick)
        finish({"done": True})
    whole = read_log(tmp_path / "run.mcap")
    assert (whole.cut, report_of(whole), whole.notes["robot"]) == (False, {"done": True}, "toy")
    assert whole.column("less").tolist() == [-1.0, -2.0, -3.0, -4.0, -5.0]
    with pytest.raises(KeyboardInterrupt), growing_log(tmp_path / "cut.mcap", samples, ("time [s]", "less"), {}, "toy"):
        for _ in range(3):
            samples.over(robot.tick)
        samples.over(robot.stop)
    assert not (tmp_path / "cut.mcap").exists()
    cut = read_log(part_of(tmp_path / "cut.mcap"))
    assert cut.cut and report_of(cut) is None
    assert cut.column("time").tolist() == [5.0, 6.0, 7.0]  # the last one might have been taken again
    with growing_log(None, samples, ("time [s]", "less"), {}, "toy") as finish:
        finish({})
    assert len(list(tmp_path.iterdir())) == 2


@contextmanager
def full_disk(size: int) -> Iterator[None]:
    """Has every file end at a size, as on a disk that is full, what pytest itself writes included."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


@pytest.mark.slow
def test_a_disk_that_gets_full_is_told_once_and_the_run_goes_on(tmp_path: Path) -> None:
    robot, told = Counter(), []
    samples = Samples(robot, 1)
    log = WantedLog(tmp_path / "run.mcap", told.append)
    with growing_log(log, samples, ("time [s]", "less"), {"robot": "toy"}, "toy") as finish:
        for _ in range(100):
            samples.over(robot.tick)
        while not (part_of(log.path).exists() and part_of(log.path).stat().st_size > 1000):
            time.sleep(0.05)  # the first are on disk
        with full_disk(part_of(log.path).stat().st_size + 100):
            until = time.monotonic() + 60.0
            while not told and time.monotonic() < until:
                samples.over(robot.tick)
                time.sleep(0.001)
            for _ in range(100):
                samples.over(robot.tick)
            gap = finish({"done": True})
    assert gap is not None and 1.0 < gap.since <= robot.ticks - 100 and "File too large" in gap.problem
    assert told == [
        f"{part_of(log.path)}: cannot be written (File too large): the log is missing from {gap.since:.2f} s on"
    ]
    assert not log.path.exists()
    left = read_log(part_of(log.path))
    assert left.cut and left.column("time")[0] == 1.0 and left.column("time")[-1] >= gap.since - 1.0


@dataclass
class Trace:
    time: Floats
    step: Ints
    places: Floats


def test_a_table_is_taken_apart_and_comes_back_from_its_log() -> None:
    table = np.arange(18.0).reshape(3, 6)
    assert width(TITLES) == 6
    trace = Trace(**fields_of(table, TITLES, whole=frozenset({"step"}), shapes={"places": (2, 2)}))  # type: ignore[arg-type]
    assert (trace.time.shape, trace.step.dtype, trace.places.shape) == ((3,), np.int32, (3, 2, 2))
    assert trace.places[1, 1].tolist() == [10.0, 11.0]  # the right one's x and y in the second row
    log = sample_log(trace, TITLES, report_notes({"done": True}), "toy")
    assert log.units == {"time": "s"} | dict.fromkeys(("left x", "left y", "right x", "right y"), "m")
    np.testing.assert_array_equal(table_of(log, TITLES), table)
    assert report_of(log) == {"done": True}
    assert report_of(sample_log(trace, TITLES, {}, "toy")) is None


def test_a_log_that_lacks_a_column_is_told() -> None:
    log = sample_log(Trace(np.zeros(1), np.zeros(1, np.int32), np.zeros((1, 4))), TITLES, {}, "toy")
    with pytest.raises(LogError, match="height"):
        table_of(log, TITLES | {"height": ("height [m]",)})
