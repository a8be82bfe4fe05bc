"""Plans of robots in space: every planner, replays, keys, bounds, and an independent calculation of every stance."""

from functools import cache
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from spatial_again import bounds_of, keys_of, restored

import plain_spatial as plain
from clamber.errors import SpecError
from clamber.families.spatial.planning.checks import SPATIAL_CHECKS
from clamber.families.spatial.planning.problem import SpatialProblem
from clamber.families.spatial.planning.task import SpatialTask
from clamber.planning.auto import choose
from clamber.planning.beam import plan_beam
from clamber.planning.exact.planner import plan_exact
from clamber.planning.genetic.planner import plan_genetic
from clamber.planning.problem.plan import Plan
from clamber.planning.problem.verdict import check_plan
from clamber.planning.reach.reach import find_reach
from clamber.planning.route import plan_route
from clamber.tasks import load_task, task_from_document

SHORT = ["goal={ along_min = '0.4 m' }"]
TASKS = ("wall-gripper", "stones-quadruped")
WHOLE = (
    *TASKS, "overhang-gripper", "ceiling-gripper", "rubble-hexapod", "handrails-triped", "corners-magnet", "truss-inchworm",
    "chimney-hexapod",
)  # fmt: skip


@cache
def task(name: str, *overrides: str) -> SpatialTask:
    loaded: Any = load_task(name, [*SHORT, *overrides])
    return loaded  # type: ignore[no-any-return]


@cache
def planned(name: str) -> Plan:
    found = plan_beam(task(name), width=30, threads=1)
    assert found.has_plan, found.reason
    return found.plan


def posture_frames(problem: SpatialProblem, stance: np.void) -> Any:
    base = np.eye(4)
    base[:3, :3], base[:3, 3] = stance["turn"].reshape(3, 3), stance["place"]
    return base


@pytest.mark.parametrize("name", TASKS)
def test_a_plan_passes_every_check_and_comes_to_the_goal(name: str) -> None:
    verdict = check_plan(task(name), planned(name))
    assert verdict.ok and verdict.goals_met == 1
    least = {
        check.name: min(step.margins[check.name] for step in verdict.per_step if step.margins[check.name] is not None)
        for check in SPATIAL_CHECKS
        if any(step.margins[check.name] is not None for step in verdict.per_step)
    }
    assert {"reach", "joint", "jump", "equilibrium", "torque", "slip", "grip", "swing"} <= set(least)
    assert min(least.values()) >= 0.0


@pytest.mark.parametrize("name", TASKS)
def test_the_bodys_pose_is_the_sum_of_the_plans_moves_along_all_six_axes(name: str) -> None:
    verdict, plan = check_plan(task(name), planned(name)), planned(name)
    start = task(name).start
    at = np.array((start.along, start.across, start.height, start.yaw, 0.0, 0.0))
    moved = np.zeros(6)
    for action, step in zip(plan.actions, verdict.per_step, strict=True):
        moved += action.delta or 0.0
        turned = np.array(step.pose) - at - moved
        turned[3:] = (turned[3:] + np.pi) % (2.0 * np.pi) - np.pi
        np.testing.assert_allclose(turned, 0.0, atol=1e-9)
    assert list(verdict.to_json()["final"]["pose"]) == [
        "along_m", "across_m", "height_m", "yaw_rad", "pitch_rad", "roll_rad",
    ]  # fmt: skip


@pytest.mark.slow
def test_poses_that_differ_in_height_or_tilt_alone_are_told_apart_on_the_map() -> None:
    it = task("wall-gripper", "step.tilt=10deg", "step.tilts=1")
    seen = find_reach(it, max_stances=3_000)
    steps = seen.poses.lattice
    assert steps.shape[1] == 6 and len(np.unique(steps, axis=0)) == len(steps)
    assert len(np.unique(steps[:, [0, 1, 3]], axis=0)) < len(steps)
    assert all(np.ptp(steps[:, axis]) > 0 for axis in (2, 4, 5))
    assert seen.poses.columns["stances"].sum() == seen.places.columns["stances"].sum() == 3_000
    np.testing.assert_allclose(seen.poses.floats("height_m"), it.start.height + steps[:, 2] * it.step.height)
    assert sorted(seen.places.columns)[:2] == ["across_m", "along_m"]


def share_of(problem: SpatialProblem, stance: np.void, lifted: int = -1) -> float:
    """Share of all limits that HiGHS finds to be left, all limbs bearing but one; their tips must be on their holds."""
    it = problem.task
    chains, world = it.robot.chains, it.world
    base = posture_frames(problem, stance)
    holds = stance["hold"][: len(chains.limb_names)]
    places, normals = world.places[holds], world.normals[holds]
    for limb, place in enumerate(places):
        tip = plain.tip(chains, limb, stance["q"][limb], base)
        assert np.linalg.norm(tip - place) < 1e-4 * float(problem.params.array("robot")["size"][0])  # type: ignore[call-overload]
    stated: Any = problem.params.array("holds")[holds]
    still = plain.PlainStance(
        base=base, gravity=np.array(world.gravity), wrench=np.zeros(6), posture=stance["q"], places=places,
        normals=normals, along=np.zeros_like(normals), bears=[limb != lifted for limb in range(len(holds))],
        strength=stated["strength"], friction=stated["friction"],
    )  # fmt: skip
    return plain.solve_forces(chains, list(it.robot.contacts), still)


@pytest.mark.parametrize("name", TASKS)
def test_every_stance_of_a_plan_stands_by_an_independent_calculation(name: str) -> None:
    """Tips are on their holds, and HiGHS finds forces with the reserve that the task asks for."""
    it = task(name)
    problem = SpatialProblem(it, 1, exact=True)
    for stance in problem.replay(planned(name).codes(it)).stances:
        share = share_of(problem, stance)
        assert share == pytest.approx(stance["share"], abs=1e-6) and share >= it.rules.need - 1e-9


@pytest.mark.slow
@pytest.mark.parametrize("name", WHOLE)
def test_whole_plans_stand_by_an_independent_calculation_while_limbs_swing_too(name: str) -> None:
    it: Any = load_task(name)
    found = plan_beam(it, threads=1)
    assert found.has_plan and found.check().ok, found.reason
    problem = SpatialProblem(it, 1, exact=True)
    stances = problem.replay(found.plan.codes(it)).stances
    for before, after in pairwise(stances):
        share = share_of(problem, after)
        assert share == pytest.approx(after["share"], abs=1e-6) and share >= it.rules.need - 1e-9
        for limb in np.flatnonzero(before["hold"] != after["hold"]).tolist():
            assert min(share_of(problem, before, limb), share_of(problem, after, limb)) >= it.rules.need - 1e-9


@pytest.mark.parametrize("name", TASKS)
def test_wrenches_of_a_stance_bear_the_weight(name: str) -> None:
    it = task(name)
    stances = SpatialProblem(it, 1, exact=True).replay(planned(name).codes(it)).stances
    weight = it.robot.chains.total_mass * np.array(it.world.gravity)
    for stance in stances:
        assert stance["wrench"][:, :3].sum(axis=0) == pytest.approx(-weight, abs=1e-6 * np.linalg.norm(weight))


@pytest.mark.parametrize("name", TASKS)
def test_no_torque_of_a_plan_is_above_what_the_reserve_leaves(name: str) -> None:
    it = task(name)
    stances = SpatialProblem(it, 1, exact=True).replay(planned(name).codes(it)).stances
    used = np.arange(it.robot.chains.torque.shape[1]) < it.robot.chains.n_joints[:, None]
    limit = float(it.robot.chains.torque[used].max())
    assert np.all(stances["torque"] > 0.0)
    assert np.all(stances["torque"] <= (1.0 - stances["share"]) * limit + 1e-9)


def test_threads_do_not_change_a_plan() -> None:
    it = task("wall-gripper")
    assert plan_beam(it, width=30, threads=2).plan == planned("wall-gripper")


@pytest.mark.parametrize("name", TASKS)
def test_a_key_makes_its_stance_again(name: str) -> None:
    it = task(name)
    problem = SpatialProblem(it, 1)
    stances = problem.replay(planned(name).codes(it)).stances
    words = keys_of(problem, stances)
    assert len({tuple(row) for row in words.tolist()}) >= len(stances) - 2
    again = restored(problem, words)
    for field in ("pose", "hold", "place", "turn", "q", "stage"):
        assert np.array_equal(again[field], stances[field]), field


def test_a_bound_is_never_above_what_is_left_of_a_plan() -> None:
    for name in TASKS:
        it = task(name)
        problem = SpatialProblem(it, 1)
        codes = planned(name).codes(it)
        stances = problem.replay(codes).stances
        left = len(codes) - np.arange(len(stances))
        assert np.all(bounds_of(problem, stances) <= left)


@pytest.mark.parametrize("planner", [plan_genetic, plan_route])
def test_other_planners_plan_in_space(planner: Any) -> None:
    found = planner(task("wall-gripper", "goal={ along_min = '0.1 m' }"), seed=1, seconds=60.0, threads=1)
    assert found.has_plan, found.reason
    assert found.check().ok


def test_a_world_of_many_holds_is_searched_by_a_beam_first() -> None:
    problem = SpatialProblem(load_task("chimney-hexapod"), 1)
    assert problem.landmarks > 1000 and choose(problem).planners[0] == "beam"


def test_exact_search_names_lattice_and_choice_of_holds() -> None:
    near = task(
        "wall-gripper", "goal={ along_min = '0.06 m' }", "step.nearest=2", "step.heights=0", "step.angle='360 deg'"
    )
    found = plan_exact(near, threads=1, seconds=100.0)
    assert found.status == "optimal", found.reason
    assert "30 mm along and across" in found.model and "2 nearest holds" in found.model
    assert found.check().ok


def test_a_stored_plan_is_checked_where_the_robots_files_are_not(tmp_path: Any) -> None:
    it, plan = task("wall-gripper"), planned("wall-gripper")
    again = task_from_document(plan.document, "stored")
    assert again.hashes == it.hashes
    assert check_plan(again, plan).ok


@pytest.mark.parametrize(
    ("override", "words"),
    [
        ("start.along='9 m'", "the nearest hold to the tip of"),
        ("start.holds={ LF = 1 }", "every limb begins on a hold"),
        ("start.holds={ LF = 1, LH = 2, RF = 3, XX = 4 }", "unknown limb"),
        ("start.holds={ LF = 1, LH = 1, RH = 2, RF = 3 }", "names a hold twice"),
        ("start.holds={ LF = 1, LH = 2, RH = 3, RF = 90000 }", "must be 1 to"),
        ("start.holds={ LF = 1, LH = 2, RH = 3, RF = 4 }", "violates the hard check 'reach'"),
        ("goal={ }", "asks for nothing"),
        ("goal={ along_min = '2 m', along_max = '1 m' }", "must be at most along_max"),
        ("rules.hard=['grip', 'flight']", "unknown check 'flight'"),
        ("step.angle='7 deg'", "must divide a turn"),
    ],
)  # fmt: skip
def test_a_task_that_cannot_be_is_refused_by_its_key(override: str, words: str) -> None:
    with pytest.raises(SpecError, match=words):
        SpatialProblem(task("wall-gripper", override), 1)


def test_a_worlds_seed_is_added_to_those_of_its_patterns() -> None:
    overrides = ((), ("world.seed=1",), ("world.patterns.0.seed=2",))
    places = [task("wall-gripper", *each).world.places for each in overrides]
    assert not np.allclose(places[0], places[1])
    assert np.array_equal(places[1], places[2])


def test_a_tasks_payload_takes_the_place_of_the_robots() -> None:
    bare, laden = load_task("corners-magnet", ["payload.mass=0 kg"]), load_task("corners-magnet")
    assert bare.robot.chains.total_mass == pytest.approx(15.0)  # type: ignore[attr-defined]
    assert laden.robot.chains.total_mass == pytest.approx(1.65 * 15.0)  # type: ignore[attr-defined]
