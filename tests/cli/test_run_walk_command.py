"""`clamber run` of a walk: what it prints, writes and refuses."""

import json
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from clamber.execution.log_files import read_log
from clamber.families.walker.execution.walk_trace import WalkTrace

TINY = ("--set", "way.0.distance=3cm")
SHORT = ("--set", "way.0.distance=5cm")


@pytest.fixture
def run(clamber: Any) -> Any:
    return partial(clamber, "run")


@pytest.mark.slow
def test_a_walk_is_carried_out_and_its_log_holds_the_report(run: Any, tmp_path: Path) -> None:
    log, picture = tmp_path / "walk.mcap", tmp_path / "walk.png"
    code, out, err = run("slope-walk", *SHORT, "-o", str(log), "-o", str(picture), "--json")
    said = json.loads(out)
    assert code == 0, said["reason"]
    assert said["done"] and said["steps"]
    assert "step 1" in err
    trace = WalkTrace.from_log(read_log(log))
    assert trace.notes is not None
    assert trace.notes["steps"] == said["steps"]
    assert trace.time[-1] == pytest.approx(said["seconds"])
    assert picture.stat().st_size > 10_000


@pytest.mark.slow
def test_the_table_fits(run: Any) -> None:
    code, out, _ = run("level-walk", *SHORT, "-q")
    assert code == 0
    assert "walked: " in out and "largest tilt" in out
    assert max(map(len, out.splitlines())) <= 80


def test_a_walk_that_falls_leaves_with_1(run: Any, tmp_path: Path) -> None:
    changes = ("level=false", "start.plate=ground", "ground.uphill=180deg", "way.0.distance=1m")
    code, out, _ = run("slope-walk", *(word for change in changes for word in ("--set", change)), "-q")
    assert code == 1
    assert "not walked" in out and "fell" in out


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("slope-walk", "--planner", "exact"), "walk"),
        (("slope-walk", "--force"), "walk"),
        (("slope-walk", "--set", "plant.backlash=1deg"), "friction"),
        (("slope-walk", "--noise", "peg_error=1mm"), "inclinometer_noise"),
        (("slope-walk", "--set", "ground.slope=50deg"), "legs"),
        (("slope-walk", "-o", "walk.xyz"), ".gif"),
        (("level-walk", "--set", "way=[{ path = 'gone.csv' }]"), "gone.csv"),
        (("level-walk", "--set", "way=[{ twist = { vx = '1 mm/s' } }]"), "lasts"),
    ],
)
def test_bad_input_is_one_message(run: Any, words: tuple[str, ...], said: str) -> None:
    code, out, err = run(*words, "-q")
    assert (code, out) == (2, "")
    assert said in err and "Traceback" not in err


@pytest.mark.usefixtures("in_this_process")
@pytest.mark.long
def test_the_command_prints_what_walks_say_together(clamber: Any) -> None:
    words = ("trials", "level-walk", *TINY, "-n", "2", "--workers", "1", "--noise", "none", "-q")
    code, out, _ = clamber(*words)
    assert code == 0
    assert "2 of 2 walks" in out and "tilt [deg]" in out
    code, out, _ = clamber("trials", "level-walk", *TINY, "--noise", "none", "--replay", "3", "-q")
    assert code == 0 and "walked: 2 steps of 'level-walk'" in out


@pytest.mark.long
def test_a_task_is_planned_once_and_walked_with_every_seed(clamber: Any, tmp_path: Path) -> None:
    near = (
        "goal.x_min=2cm",
        "goal.x_max=8cm",
        "goal.y_min=-2cm",
        "goal.y_max=2cm",
        "goal.theta_min=-1deg",
        "goal.theta_max=1deg",
    )
    sets = [word for text in near for word in ("--set", text)]
    words = (
        "trials",
        "terrace-walk",
        *sets,
        "--planner",
        "exact",
        "--noise",
        "none",
        "--workers",
        "1",
        "--store",
        str(tmp_path / "t.db"),
    )
    code, out, _ = clamber(*words, "-n", "1", "-q")
    assert code == 0
    assert "1 of 1 walks 'terrace-walk'" in out and "kept their balance" in out
    code, out, _ = clamber(*words, "-n", "2", "--resume", "--json")
    said = json.loads(out)
    assert code == 0 and said["done"] == 2
    exact = ("--planner", "exact", "--noise", "none")
    code, out, _ = clamber("trials", "terrace-walk", *sets, *exact, "--replay", "3", "-q")
    assert code == 0 and "of 'terrace-walk'" in out


@pytest.mark.slow
def test_a_ditch_that_is_too_wide_leaves_with_1(run: Any) -> None:
    code, out, _ = run("ditch-walk", "--set", "way.0.ditch=30cm", "-q")
    assert code == 1
    assert "refused: the ditch cannot be crossed" in " ".join(out.split())


def test_the_log_of_a_walk_that_falls_is_whole_and_the_same_as_one_written_at_the_end(run: Any, tmp_path: Path) -> None:
    changes = ("level=false", "start.plate=ground", "ground.uphill=180deg", "way.0.distance=1m")
    grown, written = tmp_path / "fall.mcap", tmp_path / "fall.csv"
    code, *_ = run(
        "slope-walk", *(word for change in changes for word in ("--set", change)), "-q", "-o", str(grown), "-o", str(written)
    )  # fmt: skip
    assert code == 1
    assert sorted(file.name for file in tmp_path.iterdir()) == ["fall.csv", "fall.mcap"]
    one, other = read_log(grown), read_log(written)
    assert not one.cut
    assert one.notes["report"] == other.notes["report"]
    for name, column in one.columns.items():
        np.testing.assert_array_equal(column, other.columns[name], err_msg=name)
    trace = WalkTrace.from_log(one)
    assert trace.notes is not None
    assert trace.notes["reason"].startswith("fell: ")
    assert trace.true_margin is not None
    assert trace.true_margin.min() == -np.inf
    assert trace.time[-1] == pytest.approx(trace.notes["seconds"])
