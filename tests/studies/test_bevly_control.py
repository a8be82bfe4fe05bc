"""Bevly 1997: what the thesis claims of control in words, on our plants; each verdict's rule can say no."""

import json
from functools import cache
from pathlib import Path

import pytest

from clamber.studies.bevly_1997 import (
    body_angle,
    body_coordinated,
    body_potential,
    limb_force,
    uneven_terrain,
)
from clamber.studies.bevly_1997.limb_force import ASKEW, HYBRID, IMPLICIT, KNOWN, STIFFER, Pressed
from clamber.studies.library import STUDIES
from clamber.studies.markdown import write_markdown
from clamber.studies.result import StudyResult


@cache
def told(name: str) -> StudyResult:
    return STUDIES["bevly-1997"][name]()


def number(name: str, label: str) -> float:
    value = told(name).numbers[label]
    assert isinstance(value, float | int)
    return value


VERDICTS = {
    "fig-3-15": "differs",
    "section-4-4-3": "open",
    "section-4-4-5": "open",
    "section-4-4-6": "holds",
}
"""Result -> what it comes to."""
LONG = {"section-5-2": "open"}


@pytest.mark.slow
@pytest.mark.parametrize("name", VERDICTS)
def test_results_that_take_longer_keep_their_verdicts(name: str, tmp_path: Path) -> None:
    keeps_its_verdict(name, VERDICTS[name], tmp_path)


@pytest.mark.long
def test_whether_uneven_terrain_is_climbed_by_what_was_learned_stays_open(tmp_path: Path) -> None:
    keeps_its_verdict("section-5-2", LONG["section-5-2"], tmp_path)


def keeps_its_verdict(name: str, verdict: str, tmp_path: Path) -> None:
    result = told(name)
    assert (result.result, result.verdict) == (name, verdict)
    json.dumps(result.to_json(), allow_nan=False)
    assert len({row.name for row in result.compared}) == len(result.compared)  # no number hides another
    write_markdown([result], tmp_path)
    assert len(list((tmp_path / "bevly-1997").glob("*.png"))) == len(result.figures)


def test_a_rule_that_fails_on_the_climbed_plan_differs_and_on_another_is_open() -> None:
    plans = (body_angle.CLIMBED, "another")
    good, bad = dict.fromkeys(plans, True), dict.fromkeys(plans, 1.0)
    assert body_angle.judged(good, bad) == "holds"
    assert body_angle.judged(good, bad | {"another": 1.6}) == "open"
    assert body_angle.judged(good | {"another": False}, bad) == "open"
    assert body_angle.judged(good, bad | {body_angle.CLIMBED: 1.6}) == "differs"
    assert body_angle.judged(good | {body_angle.CLIMBED: False}, bad) == "differs"


def test_force_control_must_hold_with_the_wall_known_and_need_to_know_it() -> None:
    good, far = Pressed(True, 0.5, 0.001), Pressed(False, 5.0, 0.01)
    told = {(HYBRID, KNOWN): [good], (HYBRID, ASKEW): [far], (IMPLICIT, KNOWN): [good], (IMPLICIT, STIFFER): [far]}
    assert limb_force.judged(told) == "holds"
    assert limb_force.judged(told | {(IMPLICIT, STIFFER): [good]}) == "open"
    assert limb_force.judged(told | {(HYBRID, KNOWN): [far]}) == "differs"
    assert limb_force.judged(told | {(HYBRID, KNOWN): [Pressed(True, 0.5, 0.003)]}) == "differs"


def test_the_earlier_scheme_must_bear_out_all_three_claims() -> None:
    claims = body_coordinated.Claims
    assert body_coordinated.judged(claims(True, True, True)) == "holds"
    assert body_coordinated.judged(claims(True, False, True)) == "open"
    assert body_coordinated.judged(claims(False, False, False)) == "differs"


def test_the_potential_must_keep_its_distance_and_be_needed() -> None:
    assert body_potential.judged([-0.02, 0.03], [0.011, 0.03]) == "holds"
    assert body_potential.judged([0.02, 0.03], [0.02, 0.03]) == "open"
    assert body_potential.judged([-0.02, 0.03], [0.009, 0.03]) == "differs"


def test_most_climbs_on_every_terrain_must_be_done_and_by_what_was_learned() -> None:
    fewer = {"a": 0.5, "b": 0.9}
    assert uneven_terrain.judged({"a": 1.0, "b": 0.9}, fewer) == "holds"
    assert uneven_terrain.judged({"a": 1.0, "b": 1.0}, {"a": 1.0, "b": 1.0}) == "open"  # no more than without
    assert uneven_terrain.judged({"a": 0.2, "b": 0.5}, fewer) == "open"
    assert uneven_terrain.judged({"a": 0.4, "b": 0.0}, fewer) == "differs"


@pytest.mark.slow
def test_the_printed_rule_for_the_angle_is_exact_on_the_ladder_and_lost_where_pegs_are_above_each_other() -> None:
    name = "section-4-4-3"
    all_of = "Table D.1, ladder: stances that two limbs carry"
    assert number(name, "Table D.1, ladder: of them with the pose found, all known, from zero") == number(name, all_of)
    table = told(name).table
    assert table is not None
    lost = {row[0]: (row[3], row[4]) for row in table.rows}
    assert lost["Table D.1, ladder"] == (0, 0)
    assert isinstance(lost["Table 2.3, modified ladder"][0], int) and lost["Table 2.3, modified ladder"][0] > 100
    assert not any(line for _, line in lost.values())
