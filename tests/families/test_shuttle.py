"""A third family, of another package: no file of Clamber knows it, and it goes through every command."""

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from clamber import family
from clamber.interrupts import Interruptible
from clamber.planning.planners import PLANNERS

HERE = Path(__file__).parent / "shuttle"
SHORTEST = 24
"""Actions: 19 moves of 2 cm to 42 cm, and 5 steps of feet, counted by hand."""
Run = Callable[..., tuple[int, str, str]]


@pytest.fixture(autouse=True)
def installed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """The toy's package on a path of its own, with its entry point, for this process and those that it starts."""
    site = tmp_path / "site"
    shutil.copytree(HERE, site / "shuttle", ignore=shutil.ignore_patterns("__pycache__"))
    info = site / "shuttle-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: shuttle\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text("[clamber.families]\nshuttle = shuttle.family:SHUTTLE\n")
    monkeypatch.syspath_prepend(str(site))
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join((str(site), *filter(None, [os.environ.get("PYTHONPATH")]))))
    monkeypatch.chdir(tmp_path)
    yield
    for name in ("shuttle", "shuttle.family", "shuttle.kernels"):
        sys.modules.pop(name, None)
    family.family_named.cache_clear()


@pytest.fixture
def plan(clamber: Run) -> Path:
    code, _, err = clamber("plan", "shuttle-line", "--planner", "exact", "-q", "-o", "plan.json")
    assert code == 0, err
    return Path("plan.json")


def told(clamber: Run, *words: str) -> Any:
    code, out, err = clamber(*words, "--json")
    assert code == 0, err
    return json.loads(out)


def test_no_file_of_the_source_knows_it() -> None:
    source = HERE.parents[2] / "src"
    assert [
        path for path in source.rglob("*") if path.suffix in (".py", ".toml") and "shuttle" in path.read_text()
    ] == []


def test_it_is_small() -> None:
    """A ratchet: a family of another package shall come to 300 lines."""
    assert sum(len(path.read_text().splitlines()) for path in HERE.glob("*.py")) <= 470


@pytest.mark.slow
@pytest.mark.parametrize("planner", PLANNERS)
def test_every_planner_plans_it(clamber: Run, planner: str) -> None:
    found = told(clamber, "plan", "shuttle-line", "--planner", planner, "--seconds", "20", "-q")
    assert found["status"] in ("found", "optimal")
    assert found["length"] >= SHORTEST
    assert (found["status"] == "optimal") <= (found["length"] == SHORTEST)


def test_it_is_listed_checked_and_inspected(clamber: Run, plan: Path) -> None:
    assert {"name": "shuttle", "title": "of the package shuttle 1.0"} in told(clamber, "list", "families")["families"]
    start = {one["check"]: one["margin"] for one in told(clamber, "check", "shuttle-line")["margins"]}
    assert start["reach"] == pytest.approx(0.07)
    assert told(clamber, "check", str(plan))["ok"]
    assert told(clamber, "inventory", "shuttle-line")["modules"] == 14
    assert told(clamber, "shorten", str(plan))["length"] == SHORTEST


@pytest.mark.slow
def test_its_reach_is_mapped_and_its_keys_are_swept(clamber: Run) -> None:
    seen = told(clamber, "reach", "shuttle-line")
    assert set(seen["places"]) == {"x_m", "y_m", "angles", "stances", "first_step", "margin", "margin_check"}
    assert seen["status"] == "complete" and seen["goals"][0]["first_step"] == SHORTEST
    assert max(seen["places"]["x_m"]) == pytest.approx(
        0.59
    )  # the last rung at 48 cm, a reach of 12 cm, steps of 2 cm from 5 cm
    swept = told(clamber, "sweep", "shuttle-line", "--vary", "robot.reach=8cm..10cm:3", "--planner", "exact")
    assert [point["status"] for point in swept["points"]] == ["infeasible", "optimal", "optimal"]


def test_what_would_open_an_infeasible_task_is_told(clamber: Run) -> None:
    code, out, _ = clamber("plan", "shuttle-line", "--planner", "exact", "--set", "robot.reach=8cm", "--json", "-q")
    assert code == 1
    (opening,) = json.loads(out)["openings"]["openings"]
    assert (opening["key"], opening["to"], opening["least"]) == ("robot.reach", 90.0, True)  # half of the gap of 18 cm


@pytest.mark.slow
def test_machine_code_is_made_anew_when_its_kernels_change(tmp_path: Path) -> None:
    """What is compiled for it stands in the cache of Clamber's own kernels, whose sources stay the same."""
    script = (
        "from clamber.tasks import load_task; from clamber.inspection.open_file import start_margins; "
        "print(start_margins(load_task('shuttle-line'))[0].margin)"
    )
    kernels, told = tmp_path / "site" / "shuttle" / "kernels.py", []
    for text in ("p.reach -", "0.5 * p.reach -", "p.reach -"):
        kernels.write_text((HERE / "kernels.py").read_text().replace("p.reach -", text))
        told.append(float(subprocess.run([sys.executable, "-c", script], capture_output=True, check=True).stdout))
    assert told == pytest.approx([0.07, 0.01, 0.07])


@pytest.mark.slow
def test_it_is_drawn_shown_and_exported(clamber: Run, plan: Path) -> None:
    for command, file, begins in (
        ("show", "plan.png", b"\x89PNG"), ("show", "plan.gif", b"GIF8"), ("view", "plan.html", b"<"), ("export", "plan.csv", b"time [s]"),
        ("export", "joints.json", b"{"),
    ):  # fmt: skip
        code, _, err = clamber(command, str(plan), "-o", file)
        assert code == 0, err
        assert Path(file).read_bytes().lstrip().startswith(begins)
    assert "Along the rungs" in Path("plan.html").read_text()
    code, _, err = clamber("reach", "shuttle-line", "-q", "-o", "reach.png")
    assert code == 0 and Path("reach.png").read_bytes().startswith(b"\x89PNG"), err


def test_it_runs_and_is_tried_out(clamber: Run, plan: Path) -> None:
    assert told(clamber, "run", "shuttle-line", "-q")["done"]
    assert told(clamber, "plan", "shuttle-line", "--to-run", "-q", "-o", "made.json")["to_run"]["ok"]
    assert told(clamber, "run", "made.json", "-q")["done"]
    slipped = told(clamber, "run", str(plan), "-q", "--noise", "slip=1mm", "--seed", "3")
    assert slipped["done"] and 0.0 < abs(slipped["drawn"]["slip"]) <= 1e-3
    code, out, _ = clamber("trials", str(plan), "-n", "6", "--noise", "slip=20mm", "--workers", "1", "--json", "-q")
    tried = json.loads(out)
    assert (code, tried["n"]) == (1, 6)
    for trial in tried["trials"]:
        assert trial["done"] == (abs(trial["drawn"]["slip"]) <= 0.01)  # its least margin is 10 mm
    code, out, err = clamber("trials", str(plan), "-n", "2", "--replay", "3")
    assert code in (0, 1) and "24 actions" in out, err


def test_what_an_interrupted_planner_has_is_not_simulated(clamber: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(task: object, **_: object) -> SimpleNamespace:
        with Interruptible():
            raise KeyboardInterrupt
        return SimpleNamespace(has_plan=True)

    monkeypatch.setattr("clamber.planning.genetic.planner.plan_genetic", interrupted)
    code, out, err = clamber("run", "shuttle-line", "--planner", "genetic", "-q")
    assert (code, out) == (130, "") and "nothing has moved" in err
