"""Set-up of all tests: one BLAS thread, and property tests that try the same examples every time."""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before anything imports numpy

from collections.abc import Callable

import pytest
from hypothesis import settings

from clamber.cli import main
from clamber.jobs import LocalProcesses
from here import Here

settings.register_profile("steady", derandomize=True, deadline=None)
settings.register_profile("explore", deadline=None, max_examples=1000)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "steady"))


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Begin at another test, by its number in CLAMBER_FIRST, for runs that are cut off."""
    first = int(os.environ.get("CLAMBER_FIRST", "0")) % max(len(items), 1)
    items[:] = items[first:] + items[:first]


@pytest.fixture
def clamber(capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> Callable[..., tuple[int, str, str]]:
    """Runs `clamber` with these words on a terminal of 80 columns: exit code, standard output, standard error."""
    monkeypatch.setenv("COLUMNS", "80")

    def call(*words: str) -> tuple[int, str, str]:
        capfd.readouterr()
        with pytest.raises(SystemExit) as left:
            main(words)
        out, err = capfd.readouterr()
        return int(left.value.code or 0), out, err

    return call


@pytest.fixture
def in_this_process(monkeypatch: pytest.MonkeyPatch) -> None:
    """Batches whose commands ask for workers run in the test's own process."""
    monkeypatch.setattr(LocalProcesses, "run", Here.run)
