"""Work beside the page: one piece at a time, told to stop, and never taking the page with it."""

import threading

import pytest

from clamber.errors import ClamberError
from clamber.viewing.browser.work_panel import Labour, Tell


class Ears:
    def __init__(self) -> None:
        self.said: list[str] = []
        self.done: list[object] = []
        self.failed: list[str] = []
        self.ended = threading.Event()
        self.background_task = Labour(lambda words, share: self.said.append(words))

    def begin(self, work: object) -> bool:
        def done(found: object) -> None:
            self.done.append(found)
            self.ended.set()

        def failed(why: str) -> None:
            self.failed.append(why)
            self.ended.set()

        return self.background_task.begin(work, done, failed)  # type: ignore[arg-type]


def test_the_seconds_go_on_while_the_work_says_nothing_new(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("clamber.viewing.browser.work_panel.TICK", 0.01)
    ears, heard = Ears(), threading.Event()
    ears.background_task = Labour(lambda words, share: (ears.said.append(words), len(ears.said) < 3 or heard.set())[0])

    def work(tell: Tell) -> bool:
        tell("rehearsing")
        return heard.wait(5.0)

    assert ears.begin(work)
    assert ears.ended.wait(10.0)
    assert ears.done == [True]
    assert {words.split()[0] for words in ears.said} == {"rehearsing"}


def test_what_is_done_is_handed_on() -> None:
    ears = Ears()

    def work(tell: Tell) -> int:
        tell("half-way", 0.5)
        return 7

    assert ears.begin(work)
    assert ears.ended.wait(5.0)
    assert (ears.done, ears.failed) == ([7], [])
    assert ears.said == ["half-way (0 s)"]


def test_second_piece_of_work_waits_for_nobody_and_is_refused() -> None:
    ears, go = Ears(), threading.Event()
    assert ears.begin(lambda tell: go.wait(5.0))
    assert ears.background_task.busy
    assert not ears.begin(lambda tell: None)
    go.set()
    assert ears.ended.wait(5.0)


def test_work_stops_where_it_next_tells() -> None:
    ears = Ears()

    def work(tell: Tell) -> None:
        while True:
            tell("on and on")

    assert ears.begin(work)
    ears.background_task.stop(wait=5.0)
    assert ears.ended.wait(5.0)
    assert ears.failed == ["stopped"]
    assert not ears.background_task.busy


@pytest.mark.parametrize(
    ("error", "words"),
    [(ClamberError("no such peg"), "no such peg"), (ValueError("oh"), "a mistake in Clamber: ValueError: oh")],
)
def test_reason_of_a_failure_is_told(error: Exception, words: str, capsys: pytest.CaptureFixture[str]) -> None:
    ears = Ears()

    def work(tell: Tell) -> None:
        raise error

    assert ears.begin(work)
    assert ears.ended.wait(5.0)
    assert ears.failed == [words]
    assert ("Traceback" in capsys.readouterr().err) == (not isinstance(error, ClamberError))
