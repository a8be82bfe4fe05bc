"""What the tests of the commands share: `clamber` itself, called with words as a shell would."""

from collections.abc import Callable

import pytest

from clamber.cli import main


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
