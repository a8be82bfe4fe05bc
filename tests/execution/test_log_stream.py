"""A log that grows while it is recorded: whole at its end, readable wherever it ends before that."""

import io
import json
import os
import random
import resource
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mcap.exceptions import EndOfFile
from mcap.records import Message
from mcap.stream_reader import StreamReader

from clamber.cli import main
from clamber.errors import FileError
from clamber.execution.log import LogError
from clamber.execution.log_files import read_log
from clamber.execution.log_mcap import parse_mcap
from clamber.execution.log_roles import samples_of
from clamber.execution.log_stream import LogStream, part_of
from clamber.families.climber.execution.climb_trace import ClimbTrace
from clamber.families.climber.execution.executable_plan import climbable
from clamber.families.climber.planning.plans import thesis_code
from clamber.families.climber.planning.task import LimbedTask
from clamber.planning.problem.plan import Plan
from clamber.tasks import load_task
from clamber.terminal.live_line import LiveLine
from clamber.types import Floats

TITLES = ("time [s]", "elbow angle [rad]")
RUNG = (106, 301, 205, 300, 3, 3)
GAIT = (*RUNG, 304, 108, 303, 207, 300, 3, 3)  # two rungs, most of a minute


def rows(count: int) -> Floats:
    return np.column_stack([0.02 * np.arange(count), np.sin(np.arange(count))])


def stream(path: Path) -> LogStream:
    return LogStream(path, TITLES, {"robot": "libra"})


def test_a_finished_log_has_its_name_its_samples_and_the_notes_of_its_end(tmp_path: Path) -> None:
    path = tmp_path / "run.mcap"
    with stream(path) as log:
        for row in rows(250):
            log.add(row)
        assert not path.exists()
        log.finish({"report": "done"})
    assert [file.name for file in tmp_path.iterdir()] == ["run.mcap"]
    back = read_log(path)
    assert (back.cut, back.notes) == (False, {"robot": "libra", "report": "done"})
    np.testing.assert_array_equal(np.column_stack(list(back.columns.values())), rows(250))
    assert back.titles() == list(TITLES)


def test_a_log_that_is_left_early_keeps_all_samples_and_says_that_it_is_cut(tmp_path: Path) -> None:
    path = tmp_path / "run.mcap"
    path.write_bytes(b"an older log")
    with pytest.raises(ZeroDivisionError), stream(path) as log:
        for row in rows(40):
            log.add(row)
        raise ZeroDivisionError
    assert path.read_bytes() == b"an older log"
    left = read_log(part_of(path))
    assert left.cut and left.notes == {"robot": "libra"}
    np.testing.assert_array_equal(np.column_stack(list(left.columns.values())), rows(40))
    assert any("ends in the middle" in note for note in samples_of(left).notes)


def test_nothing_is_written_before_the_first_sample(tmp_path: Path) -> None:
    with stream(tmp_path / "run.mcap"):
        pass
    assert not list(tmp_path.iterdir())


def test_a_sample_that_is_told_twice_is_written_once(tmp_path: Path) -> None:
    with stream(tmp_path / "run.mcap") as log:
        for row in rows(3).repeat(2, axis=0):
            log.add(row)
        log.finish({})
    assert read_log(tmp_path / "run.mcap").rows == 3


def test_a_file_that_cannot_be_written_is_a_named_error(tmp_path: Path) -> None:
    with pytest.raises(FileError, match="cannot be written"), stream(tmp_path / "nowhere" / "run.mcap") as log:
        log.add(rows(1)[0])
        log.finish({})


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    """A file of several chunks."""
    path = tmp_path_factory.mktemp("log") / "run.mcap"
    with pytest.MonkeyPatch.context() as patch, stream(path) as log:
        patch.setattr("clamber.execution.log_stream.FLUSHED", 0.0)
        for row in rows(120):
            log.add(row)
        log.finish({"report": "done"})
    return path.read_bytes()


@given(st.data())
@settings(max_examples=150)
def test_a_file_cut_anywhere_gives_the_first_samples_or_says_that_there_are_none(
    whole: bytes, data: st.DataObject
) -> None:
    content = whole[: data.draw(st.integers(0, len(whole) - 1))]
    try:
        log = parse_mcap(content, "cut")
    except LogError as error:
        assert str(error).startswith("cut")
        assert len(content) < 1000  # the head and the first chunk: no sample is whole yet
        return
    assert log.cut
    np.testing.assert_array_equal(np.column_stack(list(log.columns.values())), rows(120)[: log.rows])


def test_each_flush_brings_its_samples_into_the_file(whole: bytes) -> None:
    counts = [parse_mcap(whole[:size], "cut").rows for size in range(1000, len(whole) - 1000, 500)]
    assert counts == sorted(counts)
    assert len(set(counts)) > 10


def climb_plan(folder: Path, numbers: tuple[int, ...]) -> Path:
    task = load_task("ladder")
    assert isinstance(task, LimbedTask)
    strict = climbable(task)
    plan = folder / "plan.json"
    Plan.of_codes(strict, [thesis_code(strict, number) for number in numbers]).save(plan)
    return plan


def climb_to_the_end(plan: Path, log: Path) -> ClimbTrace:
    with pytest.raises(SystemExit):
        main(("run", str(plan), "-q", "--json", "-o", str(log)))
    assert not part_of(log).exists()
    return ClimbTrace.from_log(read_log(log))


def kill_a_climb(plan: Path, log: Path, size: int, wait: float) -> None:
    """Start a climb in a process of its own and kill it some time after its log has that many bytes."""
    words = [sys.executable, "-c", "from clamber.cli import main; main()", "run", str(plan), "-q", "-o", str(log)]
    process = subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        while process.poll() is None and not (part_of(log).exists() and part_of(log).stat().st_size > size):
            time.sleep(0.01)
        time.sleep(wait)
        assert process.poll() is None, "the climb was over before it could be killed"
        os.kill(process.pid, signal.SIGKILL)
    finally:
        process.wait()


def assert_left(log: Path, climbed: ClimbTrace) -> None:
    """What a killed climb left is the beginning of what one to the end says, to the last bit."""
    assert not log.exists()
    left = read_log(part_of(log))
    trace = ClimbTrace.from_log(left)
    assert left.cut and trace.notes is None
    assert 1 < left.rows < len(climbed.time)
    for field in ("time", "step", "believed", "aim", "angles", "torques", "holds", "carries", "true_pose"):
        np.testing.assert_array_equal(getattr(trace, field), getattr(climbed, field)[: left.rows], err_msg=field)
    told: list[Message] = []
    with pytest.raises(EndOfFile):  # the format's own reader gets as far, whatever it then makes of the end
        for record in StreamReader(io.BytesIO(whole_records(part_of(log).read_bytes()))).records:
            told += [record] if isinstance(record, Message) else []
    numbers = [data for message in told if "time [s]" in (data := json.loads(message.data))]  # beside frames and shapes
    assert [data["time [s]"] for data in numbers] == trace.time.tolist()


def whole_records(content: bytes) -> bytes:
    end = 8
    while (length := int.from_bytes(content[end + 1 : end + 9], "little")) and end + 9 + length <= len(content):
        end += 9 + length
    return content[:end]


@pytest.mark.slow
@pytest.mark.skipif(os.name != "posix", reason="SIGKILL is POSIX")
def test_a_climb_that_is_killed_leaves_a_log_that_can_be_read(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    plan = climb_plan(tmp_path, GAIT)
    climbed = climb_to_the_end(plan, tmp_path / "whole.mcap")
    kill_a_climb(plan, tmp_path / "killed.mcap", size=20_000, wait=0.0)
    assert_left(tmp_path / "killed.mcap", climbed)


def test_a_climb_goes_on_without_its_log_and_says_from_when_that_is_missing(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    plan, before = climb_plan(tmp_path, RUNG[:2]), resource.getrlimit(resource.RLIMIT_FSIZE)
    whole = LiveLine.show

    def fills_the_disk(line: LiveLine, words: str, share: float | None = None) -> None:
        if words.startswith("action 2 "):
            resource.setrlimit(resource.RLIMIT_FSIZE, (2000, before[1]))
        whole(line, words, share)

    monkeypatch.setattr(LiveLine, "show", fills_the_disk)
    try:
        with pytest.raises(SystemExit) as left:
            main(("run", str(plan), "-q", "--json", "-o", str(tmp_path / "run.mcap")))
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    told = capfd.readouterr()
    report = json.loads(told.out)
    assert left.value.code == 0 and report["done"]
    assert 0.0 <= report["log_gap"]["since"] < report["seconds"]
    assert told.err.count("cannot be written (File too large): the log is missing from") == 1
    assert not (tmp_path / "run.mcap").exists()


@pytest.mark.long
@pytest.mark.skipif(os.name != "posix", reason="SIGKILL is POSIX")
def test_so_it_does_killed_at_any_moment(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    plan = climb_plan(tmp_path, (*GAIT, 3, 3))
    climbed = climb_to_the_end(plan, tmp_path / "whole.mcap")
    for seed in range(20):
        log = tmp_path / f"killed-{seed}.mcap"
        kill_a_climb(plan, log, size=5000, wait=random.Random(seed).uniform(0.0, 0.5))
        assert_left(log, climbed)
