"""Shell completion: the words of commands and the names of things, asked as a shell asks."""

import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
import typer

import clamber
from clamber.cli.app import application, command_of, commands_below
from clamber.cli.list import LISTED
from clamber.families.climber.trials.body_entries import CONTROLS
from clamber.families.walker.trials.cooperative.tool_path import DATA as PATHS

SLOW = ("numba", "scipy", "mujoco", "matplotlib", "viser")
ASK = f"""
import sys
from clamber.cli import main
try:
    main()
finally:
    print(*(name for name in {SLOW!r} if name in sys.modules), file=sys.stderr)
"""


def complete(typed: str, shell: str = "bash") -> subprocess.CompletedProcess[str]:
    """What the shell is told when the key is pressed after some words; stderr names what was loaded that is slow to load."""
    environment = os.environ | {
        "PYTHONPATH": str(Path(clamber.__file__).parents[1]), "_CLAMBER_COMPLETE": f"complete_{shell}",
        "COMP_WORDS": typed, "COMP_CWORD": str(len(typed.split(" ")) - 1), "_TYPER_COMPLETE_ARGS": typed,
    }  # fmt: skip
    return subprocess.run([sys.executable, "-c", ASK], capture_output=True, text=True, env=environment, check=False)


def names(kind: str) -> set[str]:
    return {name for name, _ in LISTED[kind]()}


@pytest.mark.parametrize(
    ("typed", "offered"),
    [
        ("clamber pl", {"plan", "plant"}),
        ("clamber new ", {"robot", "board", "task", "world"}),
        ("clamber doc", {"doctor"}),
    ],
)
def test_words_of_commands_are_completed(typed: str, offered: set[str]) -> None:
    assert set(complete(typed).stdout.split()) == offered


@pytest.mark.parametrize(
    ("typed", "kinds"),
    [
        ("clamber plan ", ["tasks"]),
        ("clamber plan ladder --planner ", ["planners"]),
        ("clamber run ", ["tasks", "plans", "walks"]),
        ("clamber check ", ["robots", "boards", "grounds", "tasks", "walks", "plans"]),
        ("clamber new task --board ", ["boards"]),
        ("clamber new robot --like ", ["robots"]),
        ("clamber limb circle -c ", ["controllers"]),
        ("clamber limb step --plant ", ["plants"]),
    ],
)
def test_names_of_things_are_completed_and_nothing_slow_is_loaded(typed: str, kinds: list[str]) -> None:
    told = complete(typed)
    assert set(told.stdout.split()) == set().union(*(names(kind) for kind in kinds))
    assert told.stderr.split() == []


def test_names_that_begin_so_are_offered_and_files_where_there_is_none() -> None:
    assert set(complete("clamber max-setting slope").stdout.split()) == {"slope-walk"}
    assert complete("clamber plan ./mine").stdout.split() == []  # an empty answer lets the shell offer files


def test_words_that_are_not_listed_are_those_that_are_taken() -> None:
    assert set(complete("clamber body push -c ").stdout.split()) <= set(CONTROLS)
    assert set(complete("clamber follow ").stdout.split()) == {path.stem for path in PATHS.glob("*.csv")}


def test_results_of_a_study_are_completed() -> None:
    assert "table-4-2" in complete("clamber study bevly-1997 ta").stdout.split()
    assert "all" in complete("clamber study ").stdout.split()


def test_shells_that_show_meanings_get_titles() -> None:
    title = dict(LISTED["tasks"]())["ladder"]
    assert title and title in complete("clamber plan lad", "zsh").stdout


def test_words_that_are_said_to_be_listed_are_completed() -> None:
    """Wherever a command's help sends the reader to `clamber list KIND`, the shell offers those names."""
    told = 0
    for path, command in commands_below(command_of(application())):
        context: Any = typer.Context(command)  # type: ignore[arg-type]
        for word in command.params:
            kinds = re.findall(r"`clamber list (\w+)`", getattr(word, "help", None) or "")
            offered = {item.value for item in word.shell_complete(context, "")}
            for kind in kinds:
                assert kind in LISTED
                assert names(kind) <= offered, (path, word.name)
                told += 1
    assert told >= 10
