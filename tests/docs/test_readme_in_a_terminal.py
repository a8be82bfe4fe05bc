"""The README's commands as they are typed: in terminals of 80 and of 60 columns, and where there are the letters of Latin-1 only."""

import os
import re
import shlex
import shutil
from pathlib import Path

import pytest
from pseudo_terminal import Session, screen_of, typed
from test_commands_run import shortened
from told_commands import ROOT, Told, told_by

from quadruped_urdf import urdf

SILENT = 2.0
"""The longest that a terminal may stand still while a command works [s]."""
TERMINALS = [(80, "utf-8"), (60, "latin-1")]
COMMANDS = list(told_by(ROOT / "README.md"))
TYPED = [told for told in COMMANDS if told.block]
NAMED = [told for told in COMMANDS if not told.block]
QUICK = re.compile(r"(new|check|plan ladder)\b")
"""What takes seconds; all else takes minutes."""
REFUSAL = re.compile(r"\b(refused?|refuses|cannot be|can't be|no plan for)\b")
WAY_ON = re.compile(r"clamber [a-z]+|this command with --|--[a-z]+|docs/\w+\.md")


def check(session: Session, columns: int, command: str) -> None:
    """Nothing stood still, nothing broke, and whoever was refused something knows how to go on."""
    screen = "\n".join(session.screen)
    told = f"clamber {command}\n{screen}"
    assert "Traceback" not in session.written and "unexpected error" not in session.written, told
    assert session.code in (0, 1), told  # 1: not all climbs of a trial need succeed
    assert session.silence < SILENT * session.stretched, f"{session.silence:.1f} s without a letter\n{told}"
    for line in session.screen:
        whole = "/" in line or "clamber " in line  # names of files are not broken, nor commands to copy
        assert len(line) <= columns or whole, f"{len(line)} columns: {line}\n{told}"
        assert "…" not in line and not line.endswith("..."), f"cut: {line}\n{told}"
    for refusal in REFUSAL.finditer(screen):
        assert WAY_ON.search(screen, refusal.end()), told


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Where a reader types: a copy of what the README's commands need of the repository, and the file that a newcomer brings."""
    made = tmp_path_factory.mktemp("reader")
    shutil.copytree(ROOT / "examples", made / "examples")
    (made / "go2.urdf").write_text(urdf())
    return made


def type_all(commands: list[Told], columns: int, encoding: str, folder: Path) -> None:
    for told in commands:
        words = shortened(told.text)
        for file in re.findall(r"(?<=-o )\S+", words):
            (folder / file).unlink(missing_ok=True)
        check(typed(shlex.split(words), columns=columns, encoding=encoding, folder=folder), columns, words)


@pytest.mark.slow
@pytest.mark.parametrize(("columns", "encoding"), [*TERMINALS, (60, "utf-8")])
def test_what_takes_seconds(columns: int, encoding: str, folder: Path) -> None:
    quick = [told for told in TYPED if QUICK.match(told.text) and "go2" not in told.text]
    assert quick
    type_all(quick, columns, encoding, folder)


@pytest.mark.long
@pytest.mark.parametrize(("columns", "encoding"), TERMINALS)
def test_all_that_the_readme_types_in_its_order(columns: int, encoding: str, folder: Path) -> None:
    type_all(TYPED, columns, encoding, folder)


@pytest.mark.long
@pytest.mark.parametrize("told", NAMED, ids=lambda told: told.text)
def test_what_makes_a_figure_of_the_tables(told: Told, folder: Path) -> None:
    type_all([told], 60, "utf-8", folder)


@pytest.mark.slow
@pytest.mark.parametrize(
    "words",
    [
        "calibrate",
        "max-setting level-walk --vary payload=12kg..26kg:3",
        "show ladder-hand -o hand.gif",
        "show ladder-hand -o hand.mp4",
        "view ladder-hand -o hand.html",
        "run wall-gripper -o wall.gif",
    ],
)
def test_what_fits_walks_and_draws_is_never_silent(words: str, folder: Path) -> None:
    check(typed(words.split(), columns=80, folder=folder), 80, words)


def test_help_stands_in_a_narrow_latin_1_terminal(folder: Path) -> None:
    for words in (["--help"], ["plan", "--help"], ["trials", "--help"], ["list"]):
        session = typed(words, columns=60, encoding="latin-1", folder=folder)
        assert session.code == 0 and "Traceback" not in session.written
        assert max(map(len, session.screen)) <= 60


@pytest.mark.slow
def test_a_command_that_loads_slowly_says_so_until_it_speaks(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    slow = (
        "import sys, time\nclass Slow:\n    def find_spec(self, name, *_):\n"
        "        if name == 'rich':\n            time.sleep(3.5)\n    "
    )
    (tmp_path / "sitecustomize.py").write_text(slow + "\nsys.meta_path.insert(0, Slow())\n", encoding="utf-8")
    monkeypatch.setenv("PYTHONPATH", f"{tmp_path}{os.pathsep}{ROOT / 'src'}")
    for words in (["--version"], ["check", "no-such-task"], ["list", "robots", "--help"]):
        session = typed(words, columns=80, folder=tmp_path)
        assert "loading, 1 s" in session.written and "loading, 3 s" in session.written
        assert "loading" not in "\n".join(session.screen)
    assert "loading" not in typed(["check", "no-such-task", "-q"], columns=80, folder=tmp_path).written


def test_what_is_overwritten_does_not_stand_on_the_screen() -> None:
    assert screen_of("one\r\n\x1b[2Ktwo\r\x1b[2Kthree\r\n\x1b[1A\x1b[2Kfour\r\n") == ["one", "four", ""]
    assert screen_of("\x1b[1;32mgreen\x1b[0m\r\nabc\rx\x1b[K") == ["green", "x"]
