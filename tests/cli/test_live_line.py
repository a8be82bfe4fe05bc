"""What takes long tells so at once, again and again, with the time that it has taken and what is left of it."""

import io
from collections.abc import Callable
from pathlib import Path

import pytest
from rich.console import Console

from clamber.terminal import live_line
from clamber.terminal.live_line import LiveLine
from clamber.terminal.worker_options import EndsLine

Clamber = Callable[..., tuple[int, str, str]]


@pytest.fixture
def pass_time(monkeypatch: pytest.MonkeyPatch) -> Callable[[float], None]:
    """A clock that goes on only when it is told to [s]."""
    now = [1000.0]
    monkeypatch.setattr(live_line.time, "monotonic", lambda: now[0])

    def later(seconds: float) -> None:
        now[0] += seconds

    return later


def log() -> Console:
    return Console(file=io.StringIO(), width=80, force_terminal=False)


def lines(console: Console) -> list[str]:
    assert isinstance(console.file, io.StringIO)
    return console.file.getvalue().splitlines()


def test_a_log_has_a_line_at_once_then_the_first_moment_then_one_every_ten_seconds(
    pass_time: Callable[[float], None],
) -> None:
    console = log()
    with LiveLine(console, quiet=False, doing="preparing the search") as line:
        assert lines(console) == ["preparing the search"]
        pass_time(2.0)
        for stances in range(5):
            line.show(f"{stances} stances")
            pass_time(3.0)
    assert lines(console)[1:] == ["0 stances, 2 s", "4 stances, 14 s"]


def test_what_is_left_is_told_from_what_was_done_in_how_long_and_not_from_what_was_done_before(
    pass_time: Callable[[float], None],
) -> None:
    console = log()
    with EndsLine(console, "points", quiet=False) as line:
        pass_time(10.0)
        line.update(20, 100)  # of which a store had 19
        pass_time(10.0)
        line.update(30, 100)
    assert lines(console) == [
        "working on points",
        "20 of 100 points, 10 s, about 13 min left",
        "30 of 100 points, 20 s, about 2 min left",
    ]


def test_who_is_quiet_says_nothing() -> None:
    console = log()
    with LiveLine(console, quiet=True, doing="preparing") as line:
        line.show("working", 0.5)
    assert lines(console) == []


def test_times_have_room_on_a_narrow_terminal_and_all_goes_in_the_end() -> None:
    console = Console(file=io.StringIO(), width=30, force_terminal=True, legacy_windows=False)
    with LiveLine(console, quiet=False) as line:
        line.show("a line that is too long for such a terminal")
    assert isinstance(console.file, io.StringIO)
    written = console.file.getvalue()
    assert "- a line that is too long for s" not in written and "a line that is too" in written
    assert written.rstrip().endswith("\x1b[2K")


def test_what_is_left_of_a_count_is_told_from_its_first_on(pass_time: Callable[[float], None]) -> None:
    console = log()
    with LiveLine(console, quiet=False, doing="preparing a.gif") as line:
        pass_time(20.0)
        count = line.counting("frame")
        for frame in range(1, 12):
            count(frame, 20)
            pass_time(1.0)
    assert lines(console) == ["preparing a.gif", "frame 1 of 20, 20 s", "frame 11 of 20, 30 s, about 10 s left"]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("words", "first", "shown"),
    [
        ("calibrate --seeds 1", "preparing the fits", "fit 8 of 8"),
        (
            "max-setting level-walk --set way.0.distance=2cm --vary payload=5kg..40kg:2",
            "preparing the walk",
            "value 2 of at most 2, payload = 40 kg",
        ),
        ("show ladder -o start.gif", "preparing start.gif", "frame 1 of 1"),
        ("view ladder-hand -o hand.html", "preparing hand.html", "picture 683 of 683"),
    ],
)
def test_what_fits_walks_and_draws_for_long_tells_how_far_it_is(
    words: str, first: str, shown: str, clamber: Clamber, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    told: list[str] = []
    show = LiveLine.show

    def heard(line: LiveLine, words: str, share: float | None = None, *, now: bool = False) -> None:
        told.append(words)
        show(line, words, share, now=now)

    monkeypatch.setattr(LiveLine, "show", heard)
    code, _, err = clamber(*words.split())
    assert code == 0 and shown in told
    assert err.startswith(first)
    assert clamber(*words.split(), "-q")[2] == ""
