"""The exact planner: its optima against plain breadth-first search, its bound against the optima, its proofs and its limits."""

from collections import deque

import numpy as np
import pytest

from clamber.benchmarks.contest import random_case
from clamber.errors import PlannerError
from clamber.planning.exact.explore import explore
from clamber.planning.exact.planner import plan_exact
from clamber.planning.planners import PLANNERS, accepts, find_planner
from clamber.planning.problem.problems import pose_problem
from clamber.tasks import load_task, task_from_document
from plain.search import NO_HANGS, SMALL, UNCLIMBABLE, breadth_first, keys_of, restored


@pytest.mark.parametrize("name", SMALL)
def test_the_exact_length_is_that_of_breadth_first_search(name: str) -> None:
    board, overrides = SMALL[name]
    problem = pose_problem(load_task(board, overrides)).problem
    shortest, seen = breadth_first(problem)
    found = explore(problem, most_stances=200_000)
    assert found.found == (shortest is not None)
    if shortest is None:
        assert found.exhausted and found.stances == len(seen)
    else:
        assert len(found.codes) == shortest
        replayed = problem.replay(found.codes)
        assert replayed.ok and problem.is_done(replayed.stances[-1:])


def test_the_bound_never_exceeds_the_optimum_and_falls_by_at_most_one_an_action() -> None:
    problem = pose_problem(load_task("h", (NO_HANGS, "step.length=3in"))).problem
    found = explore(problem, most_stances=500_000)
    stances = problem.replay(found.codes).stances
    _, bounds = keys_of(problem, stances)
    left = np.arange(len(found.codes), -1, -1)
    assert np.all(bounds <= left)
    here = problem.start
    rng = np.random.default_rng(1)
    for _ in range(200):
        children = problem.expand(here)
        _, before = keys_of(problem, here)
        _, after = keys_of(problem, children.stance)
        assert np.all(before[0] <= 1 + after)
        here = children.stance[rng.integers(len(children.stance))][None].copy()


@pytest.mark.parametrize(
    ("name", "overrides"),
    [
        ("ladder", (NO_HANGS,)),
        ("h", (NO_HANGS, 'rules.branch="kept"')),
        ("ladder", ("rules.max_hangs=1", 'rules.hard=["reach","joint","support","hangs","torque","clearance","swing","limb_peg"]')),
        ("patch-walk", ()),
    ],
)  # fmt: skip
def test_a_stance_made_again_from_its_key_has_the_same_future(name: str, overrides: tuple[str, ...]) -> None:
    problem = pose_problem(load_task(name, overrides)).problem
    rng = np.random.default_rng(2)
    here = problem.start
    for _ in range(150):
        words, _ = keys_of(problem, here)
        again = np.zeros(1, here.dtype)
        restored(problem.params.record, words, again)
        assert np.array_equal(keys_of(problem, again)[0], words)
        first, second = problem.expand(here), problem.expand(again)
        assert np.array_equal(first.code, second.code)
        assert np.array_equal(keys_of(problem, first.stance)[0], keys_of(problem, second.stance)[0])
        here = first.stance[rng.integers(len(first.stance))][None].copy()
        here["stage"] = 0


def test_the_ladder_needs_thirty_actions_and_h_forty_one() -> None:
    ladder = plan_exact(load_task("ladder", (NO_HANGS,)))
    assert (ladder.status, ladder.length) == ("optimal", 30)
    assert ladder.check().reached and "hangs" in ladder.model
    h = load_task("h", (NO_HANGS, "step.length=3in", "subgoals=[]"))
    assert plan_exact(h).length == 41


SMALL_BUDGETS = {"max_checks": 60_000, "max_evaluations": 3_000, "max_stances": 40_000}


@pytest.mark.slow
@pytest.mark.parametrize("planner", PLANNERS)
@pytest.mark.parametrize("board", ["ladder", "random-20-1", "random-20-2", "random-40-4"])
def test_no_planner_beats_the_optimum(planner: str, board: str) -> None:
    if board == "ladder":
        task = load_task("ladder", (NO_HANGS,))
    else:
        holds, seed = (int(word) for word in board.split("-")[1:])
        task = task_from_document(random_case(holds, seed).document)
    proof = plan_exact(task)
    assert proof.status in ("optimal", "infeasible")
    options = {name: most for name, most in SMALL_BUDGETS.items() if accepts(planner, name)}
    result = find_planner(planner)(task, seed=1, threads=2, **options)
    if proof.status == "infeasible":
        assert not result.has_plan and result.status != "optimal"
    elif result.has_plan:
        assert result.check().reached and result.length >= proof.length
        assert result.status != "optimal" or result.length == proof.length
    if result.lower_bound is not None and proof.status == "optimal":
        assert result.lower_bound <= proof.length


def test_an_unclimbable_board_is_proved_so_and_the_proof_says_for_which_rules() -> None:
    result = plan_exact(load_task("modified-ladder", UNCLIMBABLE))
    assert result.status == "infeasible" and result.lower_bound is None
    assert result.stances is not None and result.stances > 1
    assert "reachable stances" in result.reason and "strict" in result.model


def test_exact_search_refuses_rules_that_it_cannot_list() -> None:
    with pytest.raises(PlannerError, match=r"rules\.allowed"):
        plan_exact(load_task("ladder", ('rules.allowed=["3","191"]',)))


def test_running_out_of_memory_is_a_result_with_a_bound() -> None:
    result = plan_exact(load_task("ladder", (NO_HANGS,)), max_stances=200)
    assert result.status == "bounded"
    assert result.lower_bound is not None and 18 <= result.lower_bound <= 30
    assert result.furthest is not None and result.check().ok


@pytest.mark.slow
def test_an_interrupt_is_a_result_with_a_bound() -> None:
    def interrupt(_: object) -> None:
        raise KeyboardInterrupt

    result = plan_exact(load_task("h", (NO_HANGS,)), minimize=("energy",), progress=interrupt)
    assert result.status == "bounded" and "interrupted" in result.reason


def test_breadth_first_search_of_the_tests_counts_depths() -> None:
    problem = pose_problem(load_task("ladder", (NO_HANGS, "goal.y_min=12in"))).problem
    shortest, seen = breadth_first(problem)
    assert shortest == max(seen.values())
    assert deque(seen.values(), maxlen=1)[0] == shortest
