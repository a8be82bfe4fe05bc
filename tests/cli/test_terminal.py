"""What people read fits 80 columns, has no colour where there is no terminal, and leaves progress to standard error."""

import shlex
from pathlib import Path
from typing import Any

import pytest
from command_examples import LONG, QUICK

from clamber.cli.app import application, command_of, commands_below

HELP = [" ".join(path) for path, _ in commands_below(command_of(application()))]


def check(clamber: Any, words: list[str]) -> None:
    code, out, err = clamber(*words)
    assert code in (0, 1), err
    assert out, "a command says what came of it"
    for line in (out + err).splitlines():
        assert len(line) <= 80 or ("/" in line and " " not in line.strip()), line  # names of files are not broken
    assert "\x1b" not in out + err
    assert "Traceback" not in err


@pytest.mark.slow
@pytest.mark.usefixtures("in_this_process")
@pytest.mark.parametrize("words", QUICK)
def test_answers_fit_80_columns_without_colour(
    clamber: Any, words: str, example_folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(example_folder)
    check(clamber, shlex.split(words))


@pytest.mark.long
@pytest.mark.usefixtures("in_this_process")
@pytest.mark.parametrize("words", [words for words in LONG if "start.y=" not in words])
def test_answers_that_take_longer_do_too(
    clamber: Any, words: str, example_folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(example_folder)
    check(clamber, shlex.split(words))


@pytest.mark.parametrize("command", HELP)
def test_help_fits_too(clamber: Any, command: str) -> None:
    check(clamber, [*command.split(), "--help"])
