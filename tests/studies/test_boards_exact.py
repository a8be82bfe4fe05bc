"""The study of exact proofs: what is known of the five boards comes out, and what it rests on is true."""

import json
from pathlib import Path

import numpy as np
import pytest

from clamber.families.climber.pictures.charts import draw_cones
from clamber.planning.beam_layers import Beam
from clamber.planning.problem.problems import pose_problem
from clamber.studies.bevly_1997.printed_plans import limbed_task
from clamber.studies.boards_exact.hook_cones import bisect_cone, holds_at, hooked
from clamber.studies.boards_exact.no_rotation import forbid_rotation
from clamber.studies.boards_exact.peg_spacing import vary_spacing
from clamber.studies.boards_exact.proofs import BARE_H, BOARDS, COARSE, MODEL, prove
from clamber.studies.boards_exact.torques import (
    joined,
    limit,
    places_on_start_holds,
    start_at,
    start_torque,
    trade_length_for_torque,
)
from clamber.studies.library import STUDIES
from clamber.units import OZ_IN


@pytest.mark.parametrize(
    ("board", "overrides", "length"),
    [("ladder", MODEL, 64), ("modified-ladder", MODEL, 67), ("ladder", COARSE, 30), ("h", BARE_H, 41)],
)
def test_shortest_plans_are_those_known_from_breadth_first_search(
    board: str, overrides: tuple[str, ...], length: int
) -> None:
    proof = prove(board, overrides)
    assert (proof.status, proof.length, proof.valid) == ("optimal", length, True)


def test_a_limit_below_the_start_s_own_torque_forbids_the_start() -> None:
    least = prove("ladder", MODEL, minimize=("torque",)).torque
    assert least is not None
    assert least == pytest.approx(start_torque("ladder"))
    assert prove("ladder", (*MODEL, limit(least, 1e-6))).feasible
    assert prove("ladder", (*MODEL, limit(least, -1e-6))).told == "the start is not allowed"


def test_places_on_the_start_s_holds_are_stances_with_the_torque_told() -> None:
    places = places_on_start_holds("ladder")
    own = ("bottom", 0, 0, 0)
    assert places[own] == pytest.approx(start_torque("ladder"))
    for place in sorted(places)[:: len(places) // 8]:
        problem = pose_problem(limbed_task("ladder", (*MODEL, *start_at("ladder", place))), threads=1).problem
        peak = problem.measured(problem.start)[0, problem.features.index("peak")]
        assert peak == pytest.approx(places[place], rel=1e-9)


def test_places_are_joined_by_single_moves_only() -> None:
    line = [("left", x, 0, 0) for x in (0, 1, 3)]
    assert joined(line[0], line) == set(line[:2])
    assert joined(("left", 0, 0, 0), [("left", 0, 0, 23), ("right", 0, 0, 1)]) == {
        ("left", 0, 0, 0),
        ("left", 0, 0, 23),
    }


@pytest.mark.slow
def test_the_narrowest_cone_of_the_ladder_parts_cones_with_a_plan_from_those_without() -> None:
    tried = dict(bisect_cone("ladder"))
    least = min(degrees for degrees, proof in tried.items() if proof.feasible)
    assert all(proof.feasible == (degrees >= least) for degrees, proof in tried.items())
    assert max(degrees for degrees in tried if degrees < least) == least - 0.25
    assert tried[least].valid
    assert all(holds_at(tried[least], degrees) for degrees in (least, 30.0, 90.0))
    assert not holds_at(tried[90.0], least)  # the cone matters


def test_a_plan_for_a_narrow_cone_holds_in_every_wider_one() -> None:
    for degrees in (60.0, 30.0):
        proof = prove("modified-ladder", hooked(degrees))
        assert proof.valid
        assert all(holds_at(proof, wider) for wider in np.arange(degrees, 90.1, 7.5))


def test_without_rotation_all_stances_are_seen_and_counted() -> None:
    result = forbid_rotation(2000, range(0), (Beam(width=20, longest=20),))
    assert result.verdict == "holds"
    assert result.numbers["stances that can be reached, all of them seen"] == 2234
    assert result.numbers["free, no hangs"] == "69 actions"
    assert result.numbers["own halves, offset while holding, one hang: exact search"] == "bounded"


@pytest.mark.slow
def test_ladders_of_other_spacings_are_planned_each() -> None:
    result = vary_spacing("board.spacing=18in..20in:2", "board.rung=6in..8in:2")
    assert result.numbers["marked ladders climbed"] == "2 of 2"
    assert result.table is not None
    assert {row[:2] for row in result.table.rows} == {(18.0, 6.0), (18.0, 8.0), (20.0, 6.0), (20.0, 8.0)}


def test_cones_are_drawn(tmp_path: Path) -> None:
    draw_cones({"a": {90.0: 10, 45.0: 12, 44.0: None}, "b": {90.0: 10}, "c": {90.0: None}}, tmp_path / "cones.png")
    assert (tmp_path / "cones.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.long
def test_front_of_h_is_complete_and_every_plan_of_it_replays() -> None:
    result = trade_length_for_torque()
    assert result.verdict == "holds"
    assert result.table is not None
    lengths, torques = zip(*(row[:2] for row in result.table.rows), strict=True)
    assert (lengths[0], lengths[-1]) == (92, 112)
    assert torques[0] == pytest.approx(748.87, abs=0.01)
    assert torques[-1] == pytest.approx(start_torque("h") / OZ_IN)


VERDICTS = {
    "optima": "holds",
    "h-torque-front": "holds",
    "least-torque": "holds",
    "no-rotation": "holds",
    "hook-cost": "holds",
    "narrowest-cone": "holds",
    "peg-spacing": "differs",
}


@pytest.mark.long
@pytest.mark.parametrize("name", VERDICTS)
def test_results_keep_their_verdicts(name: str) -> None:
    result = STUDIES["boards-exact"][name]()
    assert result.result == name
    assert result.verdict == VERDICTS[name]
    json.dumps(result.to_json(), allow_nan=False)
    if name == "optima":
        assert [result.numbers[f"{board}: shortest plan [actions]"] for board in BOARDS] == [64, 67, 92, 110, 122]
