"""Beam, windows, corridors, hybrid and auto: plans stay valid, get no longer, and never beat the optimum."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from clamber.compiled import kernel
from clamber.errors import SpecError
from clamber.planning.auto import plan_auto
from clamber.planning.beam import plan_beam
from clamber.planning.beam_layers import Beam, search_layers
from clamber.planning.genetic.planner import plan_genetic
from clamber.planning.hybrid import plan_hybrid
from clamber.planning.problem.family_kernels import heuristic_between
from clamber.planning.problem.problems import pose_problem
from clamber.planning.shorten import polish_plan, shorten, shorten_by_windows, shorten_in_corridor, stances_to_goal
from clamber.tasks import load_task

NO_HANGS = "rules.max_hangs=0"
TASKS = [
    (name, rules) for name in ("ladder", "modified-ladder", "h", "across", "circle") for rules in ((), (NO_HANGS,))
]
OPTIMA = {"ladder": 64, "modified-ladder": 67, "h": 92, "across": 110, "circle": 122}
WALKS = {
    "limbed": ("ladder", (NO_HANGS,)),
    "limbed, hangs": ("ladder", ()),
    "walker": ("patch-walk", ("step.length=80mm", "step.angle=30deg")),
}


@kernel
def towards(p, stances, targets, out):
    for i in range(stances.shape[0]):
        for j in range(targets.shape[0]):
            out[i, j] = heuristic_between(p, stances[i], targets[j])


def random_walk(problem, seed, n):
    rng = np.random.default_rng(seed)
    walk = [problem.start]
    for _ in range(n):
        children = problem.expand(walk[-1]).stance
        walk.append(children[rng.integers(len(children))][None].copy())
    return np.concatenate(walk)


@pytest.mark.parametrize("name", WALKS)
@settings(max_examples=30, deadline=None)
@given(seed=st.integers(0, 10_000))
def test_toward_is_admissible_and_consistent_on_random_walks(name: str, seed: int) -> None:
    task, rules = WALKS[name]
    problem = pose_problem(load_task(task, rules), threads=1).problem
    walk = random_walk(problem, seed, 25)
    bounds = np.zeros((len(walk), len(walk)))
    towards(problem.params.record, walk, walk, bounds)
    for i in range(len(walk)):
        assert bounds[i, i] == 0.0
        assert np.all(bounds[i, i:] <= np.arange(len(walk) - i))
    children = problem.expand(walk[:5])
    after = np.zeros((len(children.stance), len(walk)))
    towards(problem.params.record, children.stance, walk, after)
    assert np.all(bounds[children.parent] <= 1.0 + after)


@pytest.mark.slow
@pytest.mark.parametrize(("name", "rules"), [*TASKS, ("patch-walk", ())])
def test_a_beam_finds_a_plan_that_replays(name: str, rules: tuple[str, ...]) -> None:
    result = plan_beam(load_task(name, rules), width=200)
    verdict = result.check()
    assert result.status == "found" and verdict.ok and verdict.reached


def test_a_beam_finds_the_same_plan_on_any_number_of_threads() -> None:
    task = load_task("across")
    plans = [search_layers(pose_problem(task, threads=n).problem, Beam(width=200)).codes for n in (1, 2, 4)]
    assert np.array_equal(plans[0], plans[1]) and np.array_equal(plans[0], plans[2])


def test_an_interrupted_beam_returns_how_far_it_came() -> None:
    def interrupt(_: object) -> None:
        raise KeyboardInterrupt

    result = plan_beam(load_task("h"), progress=interrupt)
    assert result.status == "stopped" and "interrupted" in result.reason and result.check().ok


@pytest.mark.parametrize(("name", "rules"), [("ladder", ()), ("ladder", (NO_HANGS,)), ("patch-walk", ())])
def test_windows_and_corridors_never_lengthen_a_plan_and_keep_it_valid(name: str, rules: tuple[str, ...]) -> None:
    task = load_task(name, rules)
    problem = pose_problem(task, threads=1).problem
    codes = plan_beam(task, width=30, polish=0).plan.codes(task)
    windows = shorten_by_windows(problem, codes, most=3000, effort=30_000)
    corridor = shorten_in_corridor(problem, codes, most=5000, effort=30_000)
    for made in (windows.codes, corridor.codes):
        assert len(made) <= len(codes) and stances_to_goal(problem, made) is not None


def test_a_window_over_a_small_board_gives_the_shortest_plan() -> None:
    task = load_task("ladder", (NO_HANGS, "goal.y_min=24in"))
    problem = pose_problem(task, threads=1).problem
    codes = plan_genetic(task, profile="thesis", seed=1).plan.codes(task)
    best = plan_hybrid(task)
    assert best.status == "optimal"
    assert len(shorten_by_windows(problem, codes, most=100_000).codes) == best.length
    corridor = shorten_in_corridor(problem, codes, most=400_000, effort=4_000_000)
    assert len(corridor.codes) == best.length


def test_a_plan_that_misses_the_goal_is_not_polished() -> None:
    task = load_task("ladder")
    plan = plan_beam(task).plan
    short = type(plan)(**{**{n: getattr(plan, n) for n in plan.__dataclass_fields__}, "actions": plan.actions[:5]})
    with pytest.raises(SpecError, match="reach"):
        polish_plan(task, short)


def test_rules_that_name_single_grabs_leave_a_plan_as_it_is() -> None:
    problem = pose_problem(load_task("ladder", ('rules.allowed=["3","191"]',))).problem
    codes = np.zeros(3, np.int32)
    assert shorten(problem, codes).codes is codes


@pytest.mark.parametrize(("name", "rules"), [("ladder", (NO_HANGS,)), ("h", ()), ("patch-walk", ())])
def test_auto_says_why_and_finds_a_plan(name: str, rules: tuple[str, ...]) -> None:
    result = plan_auto(load_task(name, rules))
    assert result.has_plan and result.check().reached
    assert ("prove" in result.reason) == (rules == (NO_HANGS,))


@pytest.mark.slow
def test_a_hybrid_out_of_memory_has_a_plan_with_a_gap(tmp_path: Path) -> None:
    result = plan_hybrid(load_task("h", ("rules.max_hangs=1",)), max_stances=20_000, max_evaluations=30_000)
    assert result.status == "bounded" and result.check().reached
    assert result.gap is not None and 0 <= result.gap < result.length


@pytest.mark.slow
@pytest.mark.parametrize("name", OPTIMA)
def test_polished_genetic_plans_are_within_a_tenth_of_the_optimum_and_never_below(name: str) -> None:
    task = load_task(name, (NO_HANGS, "step.length=1in"))
    for seed in range(5):
        result = plan_genetic(task, seed=seed)
        assert result.check().reached
        assert OPTIMA[name] <= result.length <= 1.1 * OPTIMA[name]
    assert plan_beam(task).length >= OPTIMA[name]
