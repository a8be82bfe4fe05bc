"""Reports of runs, made by the command: what they say, and that they open in a real browser."""

import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from clamber.cli import main
from clamber.families.climber.execution.executable_plan import climbable
from clamber.families.climber.planning.plans import thesis_code
from clamber.families.climber.planning.task import LimbedTask
from clamber.families.walker.pictures.report import piece_in_words
from clamber.families.walker.planning.piece import BodyTwist, Piece, Stop
from clamber.planning.problem.plan import Plan, load_plan
from clamber.tasks import load_task


def ran(*words: str) -> int:
    with pytest.raises(SystemExit) as left:
        main(["run", *words, "-q"])
    return int(left.value.code or 0)


@pytest.fixture(scope="module")
def plan(tmp_path_factory: pytest.TempPathFactory) -> Path:
    task = load_task("ladder")
    assert isinstance(task, LimbedTask)
    strict = climbable(task)
    path = tmp_path_factory.mktemp("plan") / "two.json"
    Plan.of_codes(strict, [thesis_code(strict, number) for number in (300, 3)]).save(path)
    return path


@pytest.fixture(scope="module")
def climb(plan: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("climb") / "report"
    assert ran(str(plan), "--peg-error", "1mm", "--seed", "3", "--report", str(folder)) == 0
    return folder


@pytest.fixture(scope="module")
def walk(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("walk") / "report"
    assert ran("level-walk", "--set", "way.0.distance=5cm", "--report", str(folder)) == 0
    return folder


def test_a_climbs_report_says_what_was_planned_and_what_became_of_it(climb: Path, plan: Path) -> None:
    page, data = (climb / "index.html").read_text(encoding="utf-8"), json.loads((climb / "run.json").read_text())
    assert data["done"] and load_plan(climb / "plan.json") == load_plan(plan)
    assert "2 actions for the task &#39;ladder&#39;" in page
    for action in data["actions"]:
        assert f"<td>{action['title']}</td><td>{action['outcome']}</td>" in page
    longest = max(data["actions"], key=lambda action: action["seconds"])
    assert f"<td>longest action</td><td>{longest['seconds']:.1f} s</td>" in page
    assert "plan, least margin" in page and "torque asked of a joint" in page


def test_the_command_of_a_report_repeats_the_run(climb: Path, plan: Path, tmp_path: Path) -> None:
    page = (climb / "index.html").read_text(encoding="utf-8")
    words = page.partition("<pre><code>clamber run ")[2].partition("</code>")[0].split()
    assert words == [str(plan), "--peg-error", "1mm", "--seed", "3"]
    assert ran(*words, "--report", str(tmp_path / "again")) == 0
    first, second = (json.loads((folder / "run.json").read_text()) for folder in (climb, tmp_path / "again"))
    assert first["actions"] == second["actions"]


@pytest.mark.slow
def test_a_walks_report_says_where_it_was_close(walk: Path) -> None:
    page, data = (walk / "index.html").read_text(encoding="utf-8"), json.loads((walk / "run.json").read_text())
    assert f"<td>least margin of balance</td><td>{1e3 * data['margin']:.0f} mm</td>" in page
    assert f"<td>{data['tilt'] * 57.29577951308232:.3f} deg</td>" in page
    assert page.count("<td>Delta</td>") + page.count("<td>Y</td>") == len(data["steps"])
    assert "The way: 0.05 m at 30 deg." in page


def test_pieces_of_a_way_are_told_in_words() -> None:
    assert piece_in_words(Piece(turn=0.5, about=(1.0, 0.0))) == "a turn of 29 deg about x 1.00 m, y 0.00 m"
    assert piece_in_words(Piece(turn=-0.5)) == "a turn of -29 deg on the spot"
    path = (Stop(x=0.5, y=0.0), Stop(x=1.0, y=0.25))
    assert piece_in_words(Piece(through=path)) == "a path of 2 places to x 1.00 m, y 0.25 m"
    twist = BodyTwist(vx=0.002, omega=math.radians(1.0))
    told = "2 mm/s ahead, 0 mm/s to the left, 1 deg/s for 60 s"
    assert piece_in_words(Piece(twist=twist, lasts=60.0)) == told
    assert piece_in_words(Piece(to=(1.0, 2.0), heading=0.0)) == "to x 1.00 m, y 2.00 m, facing 0 deg"


def test_a_walk_is_not_written_over_a_climb(climb: Path, capfd: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as left:
        main(["run", "level-walk", "--report", str(climb), "-q"])
    assert left.value.code == 2
    assert "is a report of the kind 'climb'" in capfd.readouterr().err


@pytest.mark.parametrize("width", [390, 1100])
def test_reports_of_runs_open_in_a_browser(climb: Path, walk: Path, visit: Callable[..., Any], width: int) -> None:
    for name, folder in (("climb", climb), ("walk", walk)):
        page = visit(folder / "index.html", f"{name}-{width}", width=width, dark=width > 1000)
        assert page.evaluate("document.documentElement.scrollWidth") <= width
        assert page.inner_text("h1 .badge") == "done"


def test_the_climb_plays_inside_its_report(climb: Path, visit: Callable[..., Any]) -> None:
    page = visit(climb / "index.html", "climb-player")
    page.get_by_text("Play it here").click()
    page.locator("iframe").scroll_into_view_if_needed(timeout=75_000)
    player = page.frame_locator("iframe")
    player.locator("canvas[data-engine]").wait_for(timeout=75_000)
    player.locator("#clamber li").nth(2).dispatch_event("click")  # it plays by itself, and the list goes along
    player.locator('#clamber[data-step="2"]').wait_for(timeout=30_000)
