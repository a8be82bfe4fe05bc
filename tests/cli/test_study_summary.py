"""What `clamber study` prints of many results: first how many hold, and which do not, so that nobody has to count."""

from collections.abc import Callable

import pytest

from clamber.studies import library
from clamber.studies.result import Compared, StudyResult, Verdict

Clamber = Callable[..., tuple[int, str, str]]
FOUND: dict[str, Verdict] = {
    "table-1": "holds",
    "table-2": "differs",
    "figure-1": "open",
    "figure-2": "holds",
    "figure-3": "differs",
    "section-1": "consistent",
}


def result_of(name: str, verdict: Verdict) -> Callable[[], StudyResult]:
    def repeat() -> StudyResult:
        return StudyResult(
            paper="paper",
            result=name,
            claim=f"that of {name}",
            verdict=verdict,
            compared=(Compared("plans", 12, 13),),
            deviations=(f"something was chosen in {name}",),
        )

    return repeat


@pytest.fixture
def paper(monkeypatch: pytest.MonkeyPatch) -> None:
    """A study with a result of each verdict, which takes no time."""
    results = {name: result_of(name, verdict) for name, verdict in FOUND.items()}
    monkeypatch.setattr(library, "STUDIES", {"paper": results})


@pytest.mark.usefixtures("paper")
def test_counts_and_what_does_not_hold_stand_before_any_result(clamber: Clamber) -> None:
    code, out, _ = clamber("study", "paper", "-q")
    assert code == 0
    lines = out.splitlines()
    assert lines[0] == "6 results: 2 hold, 1 is consistent, 2 differ, 1 is open"
    assert [line.strip() for line in lines[1:4]] == ["differs: table-2, figure-3", "open: figure-1", ""]
    told = [line for line in lines[4:] if not line.startswith(" ")]
    assert told == [f"{name}: {verdict}" for name, verdict in FOUND.items()]
    assert "claim: that of table-2" in out and "deviation: something was chosen in figure-1" in out


@pytest.mark.usefixtures("paper")
def test_one_result_has_no_counts(clamber: Clamber) -> None:
    code, out, _ = clamber("study", "paper", "table-2", "-q")
    assert code == 0 and out.startswith("table-2: differs\n")


def test_what_was_left_out_by_an_interrupt_is_counted(clamber: Clamber, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted() -> StudyResult:
        raise KeyboardInterrupt

    results = {"table-1": result_of("table-1", "holds"), "table-2": interrupted}
    monkeypatch.setattr(library, "STUDIES", {"paper": results})
    _, out, err = clamber("study", "paper", "-q")
    assert out.startswith("1 of 2 results: 1 holds\n") and "interrupted in table-2" in err
