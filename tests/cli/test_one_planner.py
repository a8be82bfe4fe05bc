"""One usual planner everywhere; an option that is for one planner chooses it, and what another cannot do is refused."""

import inspect
import os
import subprocess
import sys
from collections.abc import Callable

import pytest

import clamber as api
from clamber.cli.plan.options import PlanOptions
from clamber.cli.run.command import RunOptions
from clamber.planning.planners import USUAL_PLANNER, plan_task
from clamber.viewing.browser.work_panel import PLANNER

Clamber = Callable[..., tuple[int, str, str]]


def test_every_door_has_the_same_planner() -> None:
    doors = (api.plan, api.run, plan_task, RunOptions)
    assert {inspect.signature(door).parameters["planner"].default for door in doors} == {USUAL_PLANNER}
    assert PLANNER == PlanOptions().chosen == USUAL_PLANNER


def test_the_command_line_plans_as_python_does(clamber: Clamber) -> None:
    code, out, _ = clamber("plan", "ladder", "-q", "--json")
    assert code == 0
    assert '"planner": "auto/' in out


@pytest.mark.parametrize(
    ("option", "planner"),
    [
        ({"islands": 2}, "genetic"), ({"evaluations": 9}, "genetic"), ({"profile": "thesis"}, "genetic"),
        ({"minimize": "length"}, "exact"), ({"pareto": "length,torque"}, "exact"), ({"width": 9}, "beam"),
        ({"width": 9, "planner": "hybrid"}, "hybrid"),
    ],
)  # fmt: skip
def test_an_option_of_one_planner_chooses_it(option: dict[str, object], planner: str) -> None:
    assert PlanOptions(**option).chosen == planner  # type: ignore[arg-type]


def test_a_front_by_another_planner_is_refused(clamber: Clamber) -> None:
    code, _, err = clamber("plan", "ladder", "--planner", "genetic", "--pareto", "length,torque")
    assert code == 2
    assert "only the exact planner finds fronts, not genetic" in " ".join(err.replace("│", " ").split())


def test_a_start_that_is_refused_says_by_how_much_with_its_unit(clamber: Clamber) -> None:
    _, _, err = clamber("plan", "ladder", "--set", "start.y=2ft", "--no-openings", "-q")
    assert "violates the hard check" in err
    assert " in; move the body" in err


def test_suffixes_of_all_pictures_are_named(clamber: Clamber) -> None:
    _, _, err = clamber("show", "ladder-hand", "-o", "x.bmp")
    assert "allowed are .png, .svg, .pdf, .gif, .html, .mp4" in " ".join(err.split())


@pytest.mark.parametrize("columns", ["60", "80"])
def test_the_tables_of_ditch_break_no_number(clamber: Clamber, monkeypatch: pytest.MonkeyPatch, columns: str) -> None:
    monkeypatch.setenv("COLUMNS", columns)
    _, out, _ = clamber("ditch", "--width", "150mm")
    row = next(line for line in out.splitlines() if line.split()[:2] == ["1", "Y"])
    assert row.split()[2:] == ["-350.0", "0.0", "14.00", "61.6", "0.900", "100.4", "178.5"]


def test_help_cuts_no_name_of_an_option(clamber: Clamber) -> None:
    out = clamber("plan", "--help")[1]
    assert "--openings-secon…" not in out
    assert "--openings-secon" in out and "ds " in out


def test_a_terminal_of_few_letters_gets_no_traceback() -> None:
    words = [sys.executable, "-c", "from clamber.cli import main; main()", "plan", "--help"]
    told = subprocess.run(words, capture_output=True, check=False, env={**os.environ, "PYTHONIOENCODING": "latin-1"})
    assert told.returncode == 0, told.stderr.decode("latin-1")
    assert b"--openings" in told.stdout
