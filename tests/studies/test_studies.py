"""Studies: what each published result comes to, and that its report can be read."""

import json
from pathlib import Path

import numpy as np
import pytest

from clamber.planning.problem.codes import MOVE, pack
from clamber.planning.problem.problems import plan_family
from clamber.studies.bevly_1997.modified_ladder import NO_HANGS, OWN, OWN_HALVES, WITHOUT_TURNS, exhaust
from clamber.studies.bevly_1997.printed_plans import PRINTED, limbed_task
from clamber.studies.library import STUDIES
from clamber.studies.markdown import write_markdown

BEVLY = STUDIES["bevly-1997"]
QUICK = {
    "inventory-size": "holds",
    "ladder-plan": "holds",
    "h-hand-plan": "holds",
    "h-planner-plan": "holds",
    "modified-ladder-plan": "holds",
    "across-plan": "holds",
    "circle-plan": "holds",
    "hook-check": "differs",
    "nominal-gait": "holds",
    "no-rotation": "holds",
    "h-torques": "holds",
    "push-pull": "holds",
    "static-torques": "differs",
}
"""Result of chapter 2 -> what it comes to."""


@pytest.mark.parametrize("name", QUICK)
def test_quick_results_of_bevly_keep_their_verdicts(name: str) -> None:
    result = BEVLY[name]()
    assert result.result == name
    assert result.verdict == QUICK[name]
    told = result.to_json()
    assert set(told) == {"paper", "result", "claim", "verdict", "numbers", "deviations", "seeds", "command"}
    json.dumps(told, allow_nan=False)


LONG = {
    "no-rotation-free": "differs",
    "step-size": "holds",
    "modified-ladder-evolution": "differs",
    "h-evolution": "differs",
    "planner-success": "open",
    "tail-crossover": "holds",
    "sub-goals": "differs",
    "learned-module": "differs",
    "modules-alone": "holds",
}
"""Likewise of those that take minutes."""


@pytest.mark.long
@pytest.mark.parametrize("name", LONG)
def test_long_results_of_bevly_keep_their_verdicts(name: str) -> None:
    assert BEVLY[name]().verdict == LONG[name]


def test_hook_counts_are_those_of_the_record() -> None:
    table = BEVLY["hook-check"]().table
    assert table is not None
    counts = {row[0]: (row[2], row[1], row[3]) for row in table.rows}
    assert counts == {
        "Table D.1, ladder": (0, 63, 0),
        "Table D.2, H by hand": (8, 69, 9),
        "Table 2.4, H by the planner": (14, 119, 14),
        "Table 2.3, modified ladder": (0, 60, 0),
        "Table D.3, across": (11, 214, 11),
        "Table D.4, circle": (14, 201, 14),
    }


def test_one_cycle_of_the_nominal_gait_climbs_one_rung() -> None:
    numbers = BEVLY["nominal-gait"]().numbers
    assert numbers["actions of the gait to y = 60 in, 6 in steps"] == 45  # nine rungs of five actions
    assert numbers["largest torque, 6 in steps [oz-in]"] == pytest.approx(648.0)


def test_without_rotation_the_modified_ladder_ends_at_21_inches_if_legs_keep_to_their_column() -> None:
    numbers = BEVLY["no-rotation"]().numbers
    assert numbers["stances that can be reached without rotation"] == 2234
    assert numbers["highest body without rotation [in]"] == pytest.approx(21.0)
    assert numbers["steps of Table 2.3 that keep these rules"] == 60


def test_a_plan_found_by_exhaustion_holds_and_reaches_the_goal() -> None:
    task = limbed_task("modified-ladder", (OWN_HALVES, NO_HANGS, WITHOUT_TURNS))
    found = exhaust(task)
    assert found.codes is not None
    replay = plan_family(task).problem(task).replay(found.codes)
    assert replay.ok
    assert replay.stances["stage"][-1] == 1
    assert not np.isin(found.codes, [pack(MOVE, 0, axis) for axis in (4, 5)]).any()


def test_exhaustion_without_an_answer_says_whether_it_was_complete() -> None:
    task = limbed_task("modified-ladder", (*OWN, WITHOUT_TURNS))
    assert exhaust(task).closed
    cut = exhaust(task, most=100)
    assert (cut.codes, cut.closed) == (None, False)


def test_report_has_a_page_for_each_result_and_its_pictures(tmp_path: Path) -> None:
    results = [BEVLY[name]() for name in ("inventory-size", "ladder-plan")]
    write_markdown(results, tmp_path)
    pages = tmp_path / "bevly-1997"
    assert "| modules without the no-op | 111 | 111 |" in (pages / "inventory-size.md").read_text(encoding="utf-8")
    page = (pages / "ladder-plan.md").read_text(encoding="utf-8")
    for figure in results[1].figures:
        assert f"ladder-plan-{figure.name}.png" in page
        assert (pages / f"ladder-plan-{figure.name}.png").read_bytes().startswith(b"\x89PNG")
    assert not (tmp_path / "bevly-1997.md").exists()  # only all results make a paper's page


@pytest.mark.parametrize("paper", STUDIES)
def test_every_result_names_a_function(paper: str) -> None:
    for repeat in STUDIES[paper].values():
        assert repeat.function.__annotations__["return"].__name__ == "StudyResult"


def test_every_printed_plan_is_a_result() -> None:
    assert set(PRINTED) <= set(BEVLY)
