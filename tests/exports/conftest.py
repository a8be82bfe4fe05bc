"""`clamber` itself, as the tests of the commands call it."""

from collections.abc import Callable

import pytest

from clamber.cli import main


@pytest.fixture
def clamber(capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> Callable[..., tuple[int, str, str]]:
    monkeypatch.setenv("COLUMNS", "80")

    def call(*words: str) -> tuple[int, str, str]:
        capfd.readouterr()
        with pytest.raises(SystemExit) as left:
            main(words)
        out, err = capfd.readouterr()
        return int(left.value.code or 0), out, err

    return call
