"""Files that somebody crafted: what no task has is refused by name, and reaches no kernel.

A kernel takes indices as they are, so a code that slips through ends the process: the cases run in one of their own.
"""

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from clamber.errors import ClamberError
from clamber.planning.genetic.profile import load_profile
from clamber.planning.problem.codes import HOLD, MOVE, NEAREST, RELEASE, pack

BY_HAND = Path(__file__).with_name("any_codes_by_hand.py")
FOUND = 542239545
"""Of the macro that ended `clamber plan ladder --macros` with a segmentation fault."""
RUN = """
import contextlib, io, json, sys
from clamber.cli import main

for words in json.loads(sys.argv[1]):
    said = io.StringIO()
    with contextlib.redirect_stderr(said), contextlib.redirect_stdout(io.StringIO()):
        try:
            main(words)
        except SystemExit as left:
            code = left.code
    print(json.dumps([code or 0, said.getvalue()]), flush=True)
"""


def lesson(
    codes: list[Any], *, robot: str = "libra", gain: float = 0.3, schema: str = "clamber-macros-2"
) -> dict[str, Any]:
    macro = {"name": "m", "codes": codes, "gain": gain, "starts": 3, "tried": 12, "seen": 1, "from_start": 4}
    told = {"schema": schema, "task": "l", "robot": robot, "plans": 1, "evaluations": 1, "macros": [macro]}
    return {key: value for key, value in told.items() if key != "robot" or robot}


MACROS: dict[str, tuple[dict[str, Any], tuple[str, ...]]] = {
    "as found": (lesson([FOUND]), ("macros.0.codes.0 = 542239545", "kind 4, limb 0, argument 5368633", "hold (limbs 0 to 2, argument 0")),
    "limb 9": (lesson([pack(RELEASE, 9)]), ("macros.0.codes.0", "limb 9", "release (limbs 0 to 2")),
    "hold 300": (lesson([pack(MOVE, 0, 2), pack(HOLD, 0, 300)]), ("macros.0.codes.1", "argument 300", "argument 0 to 21)")),
    "kind 12": (lesson([pack(12)]), ("macros.0.codes.0", "kind 12", "random")),
    "move 6": (lesson([pack(MOVE, 0, 6)]), ("macros.0.codes.0", "argument 6", "move (limb 0, argument 0 to 5)")),
    "rank 0": (lesson([pack(NEAREST, 0, 0)]), ("macros.0.codes.0", "nearest (limbs 0 to 2, argument 1 to")),
    "negative": (lesson([-1]), ("macros.0.codes.0 = -1", "must be the code of an action")),
    "huge": (lesson([10**12]), ("macros.0.codes.0 = 1000000000000", "2147483647")),
    "of any size": (lesson([10**40]), ("macros.0.codes.0 = 1", "2147483647")),
    "no number": (lesson(["3"]), ("macros.m.codes.0 = '3'", "whole number")),
    "nothing": (lesson([]), ("macros.0.codes", "one code or more")),
    "not a number": (lesson([pack(MOVE, 0, 2)], gain=float("nan")), ("NaN is no JSON number",)),
    "of another robot": (lesson([pack(MOVE, 0, 2)], robot="gecko4"), ("robot = 'gecko4'", "must be 'libra'", "clamber learn")),
    "of no robot": (lesson([pack(MOVE, 0, 2)], robot="", schema="clamber-macros-1"), ("names no robot", "clamber learn")),
}  # fmt: skip


def all_of(commands: list[list[str]]) -> list[tuple[int, str]]:
    """Exit code and complaint of each command, all in one process."""
    done = subprocess.run(
        [sys.executable, "-c", RUN, json.dumps(commands)], capture_output=True, text=True, check=False
    )
    told = [tuple(json.loads(line)) for line in done.stdout.splitlines()]
    assert done.returncode == 0 and len(told) == len(commands), (done.returncode, told, done.stderr[-2000:])
    return told


def test_a_macro_that_the_task_has_not_is_refused_by_name(tmp_path: Path) -> None:
    files = {name: tmp_path / f"{name.replace(' ', '-')}.json" for name in MACROS}
    for name, (stored, _) in MACROS.items():
        files[name].write_text(json.dumps(stored))
    told = all_of([["plan", "ladder", "--planner", "genetic", "-q", "--macros", str(file)] for file in files.values()])
    for (name, (_, words)), (code, said) in zip(MACROS.items(), told, strict=True):
        assert code == 2 and str(files[name]) in said and "Traceback" not in said, (name, code, said)
        told_words = " ".join(said.split())
        assert all(word in told_words for word in words), (name, said)


@pytest.mark.slow
def test_a_checkpoint_that_the_search_cannot_have_is_refused_by_name(tmp_path: Path) -> None:
    profile, kept = tmp_path / "small.toml", tmp_path / "kept.json"
    text = (Path(sys.modules[load_profile.__module__].__file__ or "").parent / "data" / "default.toml").read_text()
    profile.write_text("".join(
        "population = 10\n" if line.startswith("population") else line for line in text.splitlines(keepends=True)
    ))  # fmt: skip
    search = [
        "plan",
        "ladder",
        "--planner",
        "genetic",
        "--profile",
        str(profile),
        "--evaluations",
        "10",
        "-q",
        "--checkpoint",
    ]
    assert all_of([[*search, str(kept)]])[0][0] in (0, 1)
    whole = json.loads(kept.read_text())
    crafted: dict[str, tuple[Any, str]] = {
        "genes.0": ([10**9], "must be an entry of the action table"),
        "genes.1": ([-1], "greater than or equal to 0"),
        "follow.0": ([1, 10**6], "must be an entry of the action table"),
        "follow.1": ([3, 0], "count"),
        "best": ([10**6], "must be an entry of the action table"),
        "width": ([10**6, 1], "as the profile says"),
        "genes": ([[0]], "must be 10 plans"),
        "records.0": ([0.0, 0.0, [0.0] * 8, 0, 10**6, 1, 1, 1, 1, 0], "the plan's genes"),
        "records.1": ([0.0, 0.0, [0.0] * 8, 0, 0, 1, 1, -5, 1, 0], "the plan's genes"),
        "found": (True, "does not reach the goal"),
        "polished": ([FOUND], "must be the code of an action"),
        "macros": (lesson([FOUND])["macros"], "must be the code of an action"),
        "best_fitness": (float("nan"), "NaN is no JSON number"),
        "release": ({}, "belongs to another release of Clamber"),
        "turn": ("x", "whole number"),
    }
    commands = []
    for key, (value, _) in crafted.items():
        data = json.loads(json.dumps(whole))
        name, _, place = key.partition(".")
        if place:
            data[name][int(place)] = value
        else:
            data[name] = value
        file = tmp_path / f"{key}.json"
        file.write_text(json.dumps(data))
        commands.append([*search, str(file)])
    for (key, (_, words)), (code, said) in zip(crafted.items(), all_of(commands), strict=True):
        assert code == 2 and f"{key}.json" in said and words in " ".join(said.split()), (key, code, said)
        assert key == "best_fitness" or key in said


@pytest.mark.parametrize("examples", [10, pytest.param(1000, marks=pytest.mark.long)])
def test_any_code_gene_or_index_is_answered_or_refused_by_every_way_in(tmp_path: Path, examples: int) -> None:
    done = subprocess.run(
        [sys.executable, str(BY_HAND), str(tmp_path), str(examples)], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0 and "every way in" in done.stdout, (done.returncode, done.stderr[-3000:])


@pytest.mark.parametrize("weight", ["nan", "inf", "-inf"])
def test_a_profile_with_a_weight_that_is_no_number_is_refused(tmp_path: Path, weight: str) -> None:
    data = Path(sys.modules[load_profile.__module__].__file__ or "").parent / "data" / "default.toml"
    lines = data.read_text().splitlines()
    place = next(k for k, line in enumerate(lines) if line.startswith("[weights]")) + 1
    name = lines[place].split("=")[0].strip()
    lines[place] = f"{name} = {weight}"
    file = tmp_path / "odd.toml"
    file.write_text("\n".join(lines))
    with pytest.raises(ClamberError, match=f"weights.{name}"):
        load_profile(str(file))
