"""Proofs for robots in space: bounds against true distances, drafts and quick verdicts against whole ones, openings of infeasible tasks."""

from functools import cache
from typing import Any

import numpy as np
import pytest
from spatial_again import bounds_of, drafts_of, keys_of, verdicts_of

from clamber.families.spatial.planning.problem import SpatialProblem
from clamber.families.spatial.planning.task import SpatialTask
from clamber.planning.beam import plan_beam
from clamber.planning.exact.planner import plan_exact
from clamber.planning.infeasibility.find import explain_infeasibility
from clamber.planning.problem.codes import HOLD, MOVE, pack
from clamber.tasks import load_task

SMALL = (
    "step.heights=0",
    "step.angle='360 deg'",
    "step.nearest=3",
    "step.length='60 mm'",
    "goal={ along_min = '0.18 m' }",
    "world.patterns.0.along=['-0.24 m', '0.36 m']",
    "world.patterns.0.across=['-0.18 m', '0.18 m']",
)
"""A patch of 24 holds and a coarse lattice: few enough stances to see them all."""
PLANNED = ("wall-gripper", "stones-quadruped", "handrails-triped")


def task(name: str, *overrides: str) -> SpatialTask:
    loaded: Any = load_task(name, list(overrides))
    return loaded  # type: ignore[no-any-return]


@cache
def whole_space() -> tuple[SpatialProblem, Any, Any, Any]:
    """All stances that can be reached in the small case, the actions between them as pairs, and the true distances to the goal."""
    problem = SpatialProblem(task("patch-gripper", *SMALL), 1)
    number = {tuple(keys_of(problem, problem.start)[0].tolist()): 0}
    stances, pairs, layer = [problem.start], [], problem.start
    known = [0]
    while len(layer):
        children = problem.expand(layer)
        new, numbers = [], []
        for parent, child, words in zip(
            children.parent, children.stance, keys_of(problem, children.stance).tolist(), strict=True
        ):
            if tuple(words) not in number:
                numbers.append(len(number))
                number[tuple(words)] = len(number)
                new.append(child)
            pairs.append((known[parent], number[tuple(words)]))
        layer = np.array(new, problem.start.dtype)
        known = numbers
        stances.append(layer)
    every = np.concatenate([each for each in stances if len(each)])
    edges = np.array(pairs)
    left = np.where(every["stage"] >= 1, 0.0, np.inf)
    while True:
        through = np.full(len(every), np.inf)
        np.minimum.at(through, edges[:, 0], left[edges[:, 1]] + 1.0)
        if np.array_equal(np.minimum(left, through), left):
            return problem, every, edges, left
        left = np.minimum(left, through)


@pytest.mark.slow
def test_no_bound_is_above_the_true_distance() -> None:
    problem, every, _, left = whole_space()
    assert len(every) > 500 and np.isfinite(left[0])
    informed = bounds_of(problem.informed(), every)
    assert np.all(bounds_of(problem, every) <= left)
    assert np.all(informed <= left)
    assert informed[0] > bounds_of(problem, every[:1])[0]


def test_bounds_fall_by_one_an_action_at_most() -> None:
    problem, every, edges, _ = whole_space()
    for bounds in (bounds_of(problem, every), bounds_of(problem.informed(), every)):
        assert np.all(bounds[edges[:, 0]] <= 1.0 + bounds[edges[:, 1]])


def test_exact_search_finds_the_true_distance() -> None:
    _, _, _, left = whole_space()
    found = plan_exact(task("patch-gripper", *SMALL), threads=1)
    assert found.status == "optimal" and found.lower_bound == len(found.plan.actions) == left[0]
    assert found.check().ok


def test_a_fifth_of_a_metre_is_proved_shortest_among_60_holds() -> None:
    found = plan_exact(task("patch-gripper"), threads=1, max_stances=100_000)
    assert len(found.task.world.holds) == 60
    assert found.status == "optimal" and found.check().ok, found.reason


@pytest.mark.long
def test_six_tenths_of_a_metre_are_proved_shortest_on_the_whole_lattice() -> None:
    found = plan_exact(task("patch-gripper", "goal.along_min='0.6 m'"), threads=1, max_stances=4_000_000)
    assert found.status == "optimal" and found.check().ok, found.reason
    assert len(found.plan.actions) == found.lower_bound == 26


@cache
def actions_of(name: str) -> tuple[SpatialTask, Any, Any]:
    """Stances of a plan, each with every action from it: moves, and every limb to the holds that are nearest."""
    it = task(name, "goal={ along_min = '0.3 m' }")
    problem = SpatialProblem(it, 1)
    found = plan_beam(it, width=20, threads=1, polish=0)
    stances = problem.replay(found.plan.codes(it)).stances[:12]
    places = it.world.places
    codes = [pack(MOVE, 0, k) for k in range(16)]
    for limb in range(len(it.robot.chains.limb_names)):
        near = np.linalg.norm(places - places[stances["hold"][0, limb]], axis=1).argsort()[:12]
        codes += [pack(HOLD, limb, int(hold)) for hold in near]
    return it, stances, np.array(codes, np.int32)


@pytest.mark.parametrize("name", PLANNED)
def test_a_draft_has_the_key_and_the_progress_of_the_stance_that_it_foresees(name: str) -> None:
    it, stances, codes = actions_of(name)
    problem = SpatialProblem(it, 1)
    told, drafted = drafts_of(problem, stances, codes)
    reasons, stepped = verdicts_of(problem, stances, codes)
    held = reasons < 0
    assert held.sum() > 20 and np.all(told[held] == 1)
    assert np.array_equal(keys_of(problem, drafted[held]), keys_of(problem, stepped[held]))
    seen = [problem.features.index(feature) for feature in problem.foreseen]
    assert np.array_equal(problem.measured(drafted[held])[:, seen], problem.measured(stepped[held])[:, seen])


@pytest.mark.parametrize("name", PLANNED)
def test_quick_verdicts_are_those_of_whole_judgements(name: str) -> None:
    it, stances, codes = actions_of(name)
    quick, _ = verdicts_of(SpatialProblem(it, 1), stances, codes)
    whole, _ = verdicts_of(SpatialProblem(it, 1, exact=True), stances, codes)
    assert np.array_equal(quick < 0, whole < 0)
    assert 0.05 < (quick < 0).mean() < 0.95


@pytest.mark.slow
@pytest.mark.parametrize(
    ("key", "stated", "least", "most"),
    [("torque_share", "0.1", 0.1, 0.5), ("stretch", "0.7", 0.7, 0.75), ("limb_room", "120 mm", 100.0, 120.0)],
)
def test_what_forbids_a_task_is_told_with_what_would_do(key: str, stated: str, least: float, most: float) -> None:
    it = task("patch-gripper", *SMALL, f"robot.{key}={stated}")
    proved = plan_exact(it, threads=1)
    assert proved.status == "infeasible", proved.reason
    found = explain_infeasibility(it, seconds=None, threads=1)
    opening = next(each for each in found.openings if each.key == f"robot.{key}")
    assert isinstance(opening.after, float) and least <= opening.after <= most and opening.least
    assert plan_exact(task("patch-gripper", *SMALL, *opening.overrides), threads=1).status == "optimal"


def single_holds(places: Any) -> str:
    """A world's patterns of one hold each, at places along and across the guide [m]."""
    one = "{{ along = ['{0} m', '{0} m'], across = ['{1} m', '{1} m'], spacing = '1 m' }}"
    return f"world.patterns=[{', '.join(one.format(*place) for place in places)}]"


def test_a_hold_that_is_missing_is_told_with_its_place() -> None:
    """Of the holds that a plan on an even grid takes one is left out; the lattice of places tried is that grid."""
    grid = [(round(0.12 * i, 2), round(0.12 * j, 2)) for i in range(-2, 4) for j in range(-2, 3)]
    whole = plan_exact(task("patch-gripper", *SMALL[:5], single_holds(grid)), threads=1)
    stances = SpatialProblem(whole.task, 1).replay(whole.plan.codes(whole.task)).stances  # type: ignore[arg-type]
    first, used = stances["hold"][0, :4].tolist(), sorted(set(stances["hold"][:, :4].ravel().tolist()))
    for gone in (hold for hold in used if hold not in first):
        left = [grid[hold] for hold in used if hold != gone]
        it = task("patch-gripper", *SMALL[:5], single_holds(left))
        if plan_exact(it, threads=1).status == "infeasible":
            break
    found = explain_infeasibility(it, seconds=None, spacing=0.12, threads=1)
    assert found.places is not None and found.places.complete
    along, across = grid[gone]
    assert any(f"along {along:.4g} m, across {across:.4g} m" in str(each.after) for each in found.places.openings)
    opened = task("patch-gripper", *SMALL[:5], *found.places.openings[0].overrides)
    assert len(opened.world.holds) == len(it.world.holds) + 1
    assert plan_exact(opened, threads=1).check().ok
