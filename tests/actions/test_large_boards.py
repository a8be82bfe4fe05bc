"""Random boards, and that what a robot does on a board costs and depends on the holds about it alone."""

import json
import math
import re
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import cKDTree

from clamber.benchmarks.walls import sampled_stances, wall_rows
from clamber.cli import main
from clamber.errors import PlannerError, SpecError
from clamber.families.climber.planning.crowding import most_covered
from clamber.families.climber.planning.place_costs import way_fields
from clamber.families.climber.planning.problem import LimbedProblem
from clamber.families.climber.planning.random_task import random_task
from clamber.families.climber.planning.step import find_hold
from clamber.families.climber.statics.records import STANCE
from clamber.families.climber.world.board import Board, RandomSpec, build_board
from clamber.families.climber.world.random_board import random_board_data
from clamber.families.climber.world.scatter import MOST_PACKED
from clamber.files import Document
from clamber.planning.problem.problems import pose_problem
from clamber.planning.route import plan_route
from clamber.tasks import load_task
from clamber.toml_text import toml_text
from clamber.trials.measured import Row

SEEDS = st.integers(0, 2**63 - 1)


def random_board(holds: int, density: float, seed: int = 0, **more: float) -> Board:
    return build_board(Document("random board", random_board_data(holds, density, seed, **more)))  # type: ignore[arg-type]


@given(st.integers(1, 300), st.floats(1.0, 500.0), st.floats(0.05, 1.0), st.floats(0.2, 5.0), SEEDS)
@settings(max_examples=60, deadline=None)
def test_a_random_board_has_its_holds_its_gap_and_its_size(
    holds: int, density: float, packed: float, aspect: float, seed: int
) -> None:
    most = math.sqrt(4.0 * MOST_PACKED / (math.pi * density))
    gap = max(0.0102, packed * most)  # two radii of 5 mm, and a little
    width = aspect * math.sqrt(holds / density)
    board = random_board(holds, density, seed, width=width, least_gap=gap)
    points = board.positions()
    assert board.numbers().tolist() == list(range(1, holds + 1))
    assert points.min() >= 0.0 and points[:, 0].max() <= width + 1e-9
    assert points[:, 1].max() <= holds / density / width + 1e-9
    if holds > 1:
        assert cKDTree(points).query(points, k=2)[0][:, 1].min() >= gap - 1e-9
    assert np.array_equal(points, random_board(holds, density, seed, width=width, least_gap=gap).positions())


def test_holds_fill_a_random_board_evenly_and_other_seeds_give_others() -> None:
    points = random_board(4000, 20.0, 1).positions()
    side = math.sqrt(4000 / 20.0)
    counts, *_ = np.histogram2d(*points.T, bins=8, range=[[0, side], [0, side]])
    assert np.all(np.abs(counts - 62.5) < 5 * math.sqrt(62.5))
    assert not np.array_equal(points, random_board(4000, 20.0, 2).positions())


def test_a_random_board_is_this_one_on_every_machine() -> None:
    places = RandomSpec(holds=3, density=20.0, seed=7).places()
    assert places.tolist() == [[0.3004, 0.0872], [0.1162, 0.3383], [0.242, 0.3474]]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--holds", "0"), "random.holds = 0: must be greater than or equal to 1"),
        (("--holds", "-5"), "random.holds = -5"),
        (("--density", "0"), "random.density = '0.0 holds/m^2': must be more than 0"),
        (("--density", "few"), "--density = 'few': is no number per area"),
        (("--density", "nan"), "--density = 'nan'"),
        (("--width", "3"), "--width = '3': lacks its unit"),
        (("--least-gap", "1m"), "20 holds/m^2 leave room for gaps of at most 0.1693 m, not 1 m"),
        (("--density", "20000"), "holds of radius 0.005 m overlap if closer than 0.01 m"),
        (("--task", "--density", "0.5"), "start: robot 'libra' has no stance on two holds"),
        (("--task", "--set", "motor.torque_limit=1Nm"), "unknown key; a key starts with name, title, start"),
        (("--task", "--set", "robot=walker"), "no robot is called 'walker'"),
    ],
)
def test_a_board_that_cannot_be_is_refused_by_name(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], words: tuple[str, ...], said: str
) -> None:
    with pytest.raises(SystemExit) as left:
        main(["new", "board", "--random", *words, "-o", str(tmp_path / "wall.toml")])
    assert left.value.code == 2 and said in " ".join(capsys.readouterr().err.split())
    assert not list(tmp_path.iterdir())


def test_new_writes_a_board_and_a_task_that_load_and_start(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "wall.toml"
    for extra in ((), ("--listed", "--force")):
        words = ["new", "board", "--random", "--holds", "120", "--seed", "4", "--task", *extra]
        with pytest.raises(SystemExit) as left:
            main([*words, "-o", str(path), "--json"])
        assert (left.value.code or 0) == 0
        told = json.loads(capsys.readouterr().out)
        assert told["holds"] == 120 and Path(told["written"]["board"]).is_file()
        task = load_task(str(path))
        assert np.array_equal(task.world.positions(), random_board(120, 20.0, 4).positions())
        pose_problem(task, threads=1)


def test_toml_text_reads_back_as_what_was_written() -> None:
    import tomllib

    data = {
        "a": 1,
        "b": 'q"\\',
        "t": {"x": [1.5, 2.0], "odd key": True, "in": {"y": "3 m"}},
        "list": [{"n": 1, "x": "1 m"}, {"n": 2, "x": "2 m"}],
        "deep": [{"n": {"m": 1}}, {"n": {"m": 2}}],
    }
    assert tomllib.loads(toml_text(data, "two\nlines")) == data


@given(st.integers(1, 60), st.sampled_from([0.2, 0.5, 2.0]), SEEDS)
@settings(max_examples=60, deadline=None)
def test_most_in_reach_is_that_of_every_pair_of_holds(n: int, side: float, seed: int) -> None:
    """A largest set is covered by a disc about one hold, or with two of them on its edge."""
    points, radius = np.random.default_rng(seed).random((n, 2)) * side, 0.3
    centres = [*points]
    for a in points:
        for b in points:
            gap = math.hypot(*(b - a))
            if 0.0 < gap <= 2 * radius:
                across = np.array([a[1] - b[1], b[0] - a[0]]) / gap
                centres.append(0.5 * (a + b) + math.sqrt(radius**2 - gap**2 / 4) * across)
    away = np.hypot(*(np.array(centres)[:, None] - points[None]).transpose(2, 0, 1))
    by_y = points[np.argsort(points[:, 1])]
    assert most_covered(by_y[:, 0].copy(), by_y[:, 1].copy(), radius) == (away <= radius + 1e-9).sum(axis=1).max()


def test_a_failed_grab_tells_how_far_the_nearest_hold_is_wherever_the_limb_is() -> None:
    task = random_task(80, 6.0, 3)
    problem = LimbedProblem(task, pose_problem(task, threads=1).problem.actions, threads=1)
    points, draw = task.world.positions(), np.random.default_rng(0)
    failed = 0
    for _ in range(300):
        stance = np.zeros(1, STANCE)
        stance["hold"] = -1
        stance["x"], stance["y"] = draw.uniform(-30.0, 30.0, 2)
        stance["c"] = 1.0
        stance["hold"][0, :2] = draw.choice(len(points), 2, replace=False)
        own = int(stance["hold"][0, 0])
        found, _, margin = find_hold(problem.params.record, stance[0], 0, 1, own)
        limb = task.robot.limbs[0]
        port = np.array([stance["x"][0] + limb.port_x, stance["y"][0] + limb.port_y])
        others = np.delete(points, stance["hold"][0, :2], axis=0)
        nearest = float(np.hypot(*(others - port).T).min())
        assert (found < 0) == (limb.length - nearest < -1e-9)
        if found < 0:
            failed += 1
            assert margin == pytest.approx(limb.length - nearest, abs=1e-12)
    assert failed > 100


def test_a_board_means_the_same_whatever_the_holds_are_called() -> None:
    """The same holds under other numbers: the same children, in another order."""
    task = random_task(60, 20.0, 5)
    mixed = np.random.default_rng(1).permutation(60)
    holds = tuple(replace(task.world.holds[old], number=new + 1) for new, old in enumerate(mixed.tolist()))
    other = replace(task, world=replace(task.world, holds=holds))
    renamed = {int(old): new for new, old in enumerate(mixed)}
    start = {limb: renamed[number - 1] + 1 if number else 0 for limb, number in task.start.holds.items()}
    other = replace(other, start=replace(task.start, holds=start))
    problems = [LimbedProblem(t, pose_problem(t, threads=1).problem.actions, threads=1) for t in (task, other)]
    seen = sampled_stances(problems[0], 40, 0)
    moved = seen.copy()
    for field in ("hold", "left"):
        moved[field] = [[renamed.get(int(h), -1) for h in row] for row in seen[field]]
    children = [problem.expand(stances) for problem, stances in zip(problems, (seen, moved), strict=True)]

    def facts(batch: object, names: dict[int, int]) -> list[tuple[object, ...]]:
        rows = zip(batch.parent, batch.stance, strict=True)  # type: ignore[attr-defined]
        return sorted(
            (int(parent), int(s["ix"]), int(s["iy"]), int(s["ia"]), *(names.get(int(h), -1) for h in s["hold"][:3]), int(s["in_use"]))
            for parent, s in rows
        )  # fmt: skip

    assert facts(children[0], renamed) == facts(children[1], {i: i for i in range(60)})


def test_the_way_over_a_wall_is_that_of_steps_and_leads_round_bare_parts() -> None:
    task = random_task(400, 20.0, 2)
    fields = way_fields(task)
    field, grain = fields.fields[0], fields.frame[2]
    assert grain == pytest.approx(task.step.length) and np.all(np.isfinite(field)) and field.min() == 0.0
    # neighbours differ by what a step costs at most, so the field never promises what a step can't give
    assert np.abs(np.diff(field, axis=0)).max() <= 50.0 + 1e-9 and np.all(fields.hold_fields >= 0.0)
    top = task.goals[-1].y_min or 0.0
    rows = np.round((np.array([task.start.y, top]) - fields.frame[1]) / grain).astype(int)
    column = round((task.start.x - fields.frame[0]) / grain)
    assert field[rows[0], column] >= rows[1] - rows[0] - 1


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(3))
def test_a_route_up_a_wall_replays_to_the_goal_and_is_the_same_each_time(seed: int) -> None:
    task = random_task(400, 20.0, seed)
    result = plan_route(task)
    assert result.status == "found" and result.check().reached and result.check().ok
    assert result.length <= (result.first_length or 0)
    assert [a.to_json() for a in plan_route(task).plan.actions] == [a.to_json() for a in result.plan.actions]


def test_a_wall_too_sparse_is_told_with_the_furthest_stance_and_no_proof() -> None:
    result = plan_route(random_task(300, 5.0, 0, overrides=("rules.max_hangs=0",)))
    assert result.status == "stopped" and "proves nothing" in result.reason
    assert result.furthest is not None and result.furthest.goals_met == 0 and result.check().ok


def test_the_route_planner_wants_a_board_and_enough_memory_is_a_result() -> None:
    with pytest.raises(PlannerError, match="its world has no holds"):
        plan_route(load_task("patch-walk"))
    result = plan_route(random_task(1000, 20.0, 0), max_stances=300)
    assert result.status == "stopped" and "out of time or memory" in result.reason


def test_the_bench_of_walls_tells_the_ratio_of_each_doubling() -> None:
    rows = wall_rows(sizes=(100,), stances=40, repeats=1)
    assert all(isinstance(row, Row) and row.value > 0 for row in rows)
    assert [row.aim for row in rows if row.unit == "ratio"] == ["< 1.10"]


def test_a_density_with_a_gap_that_jams_names_both() -> None:
    with pytest.raises(SpecError, match=re.escape("the density must be at most")):
        random_board(50, 100.0, least_gap=0.09)


@pytest.mark.slow
@pytest.mark.parametrize("density", [8.0, 20.0, 60.0])
def test_a_route_up_ten_thousand_holds_is_found_and_valid(density: float) -> None:
    task = random_task(10_000, density, 0)
    result = plan_route(task)
    verdict = result.check()
    assert result.status == "found" and verdict.ok and verdict.reached
    heights = [stance["y"] for stance in pose_problem(task).problem.replay(result.plan.codes(task)).stances]
    assert heights[-1] > 0.9 * task.world.positions()[:, 1].max()
    assert all(abs(b - a) < 1.0 for a, b in pairwise(heights))
