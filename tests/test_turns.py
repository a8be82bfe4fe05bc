"""Processes that compile at once: each kernel is compiled by one, its code for other types stays apart, and no death holds anybody up."""

import os
import subprocess
import sys
import time
from pathlib import Path

import pytest

import clamber
from clamber.turns import Turns

MODULE = """
from clamber.compiled import kernel


@kernel
def {name}(x):
    return x * x + x
"""
USE = """
import sys, time
from pathlib import Path
{imports}
Path(sys.argv[1]).touch()
while not Path(sys.argv[2]).exists():
    time.sleep(0.001)
value = squared({argument})
print(value, sum(squared.stats.cache_misses.values()))
"""
HOLD = """
import sys, time
from pathlib import Path
from clamber.turns import Turns
turns = Turns()
turns.take(Path(sys.argv[1]), "mine")
print("taken", flush=True)
time.sleep(60)
"""


def start(code: str, *words: object, cache: Path, path: Path) -> "subprocess.Popen[str]":
    places = os.pathsep.join((str(Path(clamber.__file__).parents[1]), str(path)))
    environment = os.environ | {"PYTHONPATH": places, "CLAMBER_CACHE": str(cache)}
    return subprocess.Popen(
        [sys.executable, "-c", code, *map(str, words)], env=environment, stdout=subprocess.PIPE, text=True
    )


def use_at_once(folder: Path, *arguments: str) -> list[tuple[str, str]]:
    """What processes print that call the same kernel at the same moment: its value, and how often it was compiled there."""
    (folder / "small.py").write_text(MODULE.format(name="squared"))
    code, go = "from small import squared", folder / "go"
    processes = [
        start(USE.format(imports=code, argument=word), folder / f"ready{k}", go, cache=folder / "cache", path=folder)
        for k, word in enumerate(arguments)
    ]
    while not all((folder / f"ready{k}").exists() for k in range(len(arguments))):
        time.sleep(0.001)
    go.touch()
    told = [process.communicate(timeout=120)[0].split() for process in processes]
    go.unlink()
    return [(value, compiled) for value, compiled in told]


@pytest.mark.slow
def test_a_kernel_that_several_processes_need_at_once_is_compiled_by_one_of_them(tmp_path: Path) -> None:
    assert sorted(use_at_once(tmp_path, "3", "3", "3")) == [("12", "0"), ("12", "0"), ("12", "1")]


@pytest.mark.slow
def test_code_for_other_types_compiled_at_the_same_time_stays_apart(tmp_path: Path) -> None:
    assert use_at_once(tmp_path, "3", "0.5", "2j") == [("12", "1"), ("0.75", "1"), ("(-4+2j)", "1")]
    assert use_at_once(tmp_path, "3", "0.5", "2j") == [("12", "0"), ("0.75", "0"), ("(-4+2j)", "0")]


@pytest.fixture
def holder(tmp_path: Path) -> "subprocess.Popen[str]":
    """A process that has its turn with "mine" and does not end it."""
    process = start(HOLD, tmp_path, cache=tmp_path, path=tmp_path)
    assert process.stdout is not None and process.stdout.readline() == "taken\n"
    return process


def test_others_wait_for_a_turn_until_it_ends_with_its_process(tmp_path: Path, holder: "subprocess.Popen[str]") -> None:
    turns = Turns()
    turns.take(tmp_path, "another", most=0.0)
    began = time.monotonic()
    turns.take(tmp_path, "mine", most=0.3)  # whoever stopped it, nobody waits for ever
    assert 0.3 <= time.monotonic() - began < 5.0
    holder.kill()
    holder.communicate()
    began = time.monotonic()
    turns.take(tmp_path, "mine")
    assert time.monotonic() - began < 5.0
    turns.leave(tmp_path, "mine")


def test_where_files_cannot_be_locked_nobody_waits(tmp_path: Path) -> None:
    turns, began = Turns(), time.monotonic()
    turns.take(tmp_path / "missing", "mine")
    turns.leave(tmp_path / "missing", "mine")
    assert time.monotonic() - began < 1.0
