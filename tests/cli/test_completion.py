"""Shell completion: the words of commands, asked as a shell asks."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

import clamber


@pytest.mark.parametrize(
    ("typed", "offered"),
    [("clamber pl", {"plan", "plant"}), ("clamber new ", {"robot", "board", "task"}), ("clamber doc", {"doctor"})],
)
def test_words_of_commands_are_completed(typed: str, offered: set[str]) -> None:
    environment = os.environ | {
        "PYTHONPATH": str(Path(clamber.__file__).parents[1]), "_CLAMBER_COMPLETE": "complete_bash", "COMP_WORDS": typed,
        "COMP_CWORD": str(len(typed.split(" ")) - 1),
    }  # fmt: skip
    words = [sys.executable, "-c", "from clamber.cli import main; main()"]
    told = subprocess.run(words, capture_output=True, text=True, env=environment, check=False)
    assert set(told.stdout.split()) == offered
