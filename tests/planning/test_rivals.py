"""The rivals of the benchmark: valid plans, the same from the same seed, within the budget, never better than the optimum."""

from typing import Any

import numpy as np
import pytest

from clamber.benchmarks.mcts import Settings, luby, plan_mcts
from clamber.benchmarks.rival_kernels import pop, push
from clamber.benchmarks.rivals import Bursts, plan_random
from clamber.errors import PlannerError
from clamber.planning.exact.planner import plan_exact
from clamber.planning.genetic.planner import plan_genetic
from clamber.planning.planners import find_planner
from clamber.planning.progress import Trying
from clamber.planning.result import PlanResult
from clamber.tasks import load_task

RIVALS = ("greedy", "random", "mcts")
NO_HANGS = "rules.max_hangs=0"
SHORT = ("ladder", (NO_HANGS, "goal.y_min=24in"))
UNCLIMBABLE = (
    "modified-ladder",
    (NO_HANGS, "step.length=3in", 'rules.allowed=["+y","-y","grab","release"]', "goal.y_min=60in"),
)


def run(rival: str, name: str, overrides: tuple[str, ...], **options: Any) -> PlanResult:
    return find_planner(rival)(load_task(name, overrides), **options)


@pytest.mark.slow
@pytest.mark.parametrize("rival", RIVALS)
@pytest.mark.parametrize("name", ["ladder", "h", "across", "patch-walk", "gecko-climb"])
def test_a_rival_finds_a_plan_that_replays_to_the_goal(rival: str, name: str) -> None:
    overrides = (NO_HANGS,) if name in ("ladder", "h", "across") else ()
    result = run(rival, name, overrides, seed=1, max_checks=200_000)
    assert result.status == "found"
    verdict = result.check()
    assert verdict.ok and verdict.reached
    assert result.first_checks is not None and 0 < result.first_checks <= result.checks
    assert result.first_length is not None and result.length <= result.first_length


@pytest.mark.parametrize("rival", RIVALS)
def test_a_rival_may_hang_where_hangs_are_allowed(rival: str) -> None:
    result = run(rival, "modified-ladder", (), seed=1, max_checks=200_000)
    assert result.status == "found" and result.check().reached


@pytest.mark.parametrize("rival", RIVALS)
def test_the_same_seed_gives_the_same_plan(rival: str) -> None:
    first, second = (run(rival, "ladder", (NO_HANGS,), seed=4, max_checks=60_000) for _ in range(2))
    assert first.plan.to_json() == second.plan.to_json()
    assert (first.checks, first.first_checks) == (second.checks, second.first_checks)


@pytest.mark.parametrize("rival", ["random", "mcts"])
def test_other_seeds_give_other_plans(rival: str) -> None:
    plans = [run(rival, "ladder", (NO_HANGS,), seed=seed, max_checks=60_000).plan.actions for seed in range(3)]
    assert plans[0] != plans[1] or plans[1] != plans[2]


@pytest.mark.parametrize("rival", RIVALS)
@pytest.mark.parametrize("most", [1, 50, 700])
def test_the_budget_in_checks_is_kept_to_one_expansion(rival: str, most: int) -> None:
    result = run(rival, "h", (NO_HANGS,), seed=0, max_checks=most)
    assert result.status == "stopped" and result.furthest is not None
    assert result.check().ok  # the way to the furthest stance holds
    assert result.checks <= most + 60  # stances of h have fewer actions than that


def test_the_genetic_planner_keeps_a_budget_in_checks_to_a_generation() -> None:
    task = load_task("h", (NO_HANGS,))
    free = plan_genetic(task, seed=1, max_evaluations=20_000)
    held = plan_genetic(task, seed=1, max_evaluations=20_000, max_checks=free.checks // 4)
    assert held.checks < free.checks // 4 + 600 * 400
    assert free.first_checks is not None and free.first_checks <= free.checks


@pytest.mark.parametrize("rival", RIVALS)
def test_no_time_is_a_result(rival: str) -> None:
    result = run(rival, "h", (NO_HANGS,), seconds=0.0)
    assert result.status == "stopped" and result.checks == 0


@pytest.mark.parametrize("rival", RIVALS)
def test_an_interrupt_is_a_result(rival: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("clamber.benchmarks.rivals.QUOTA", 10)

    def interrupt(_: object) -> None:
        raise KeyboardInterrupt

    result = run(rival, *UNCLIMBABLE, progress=interrupt)
    assert result.status == "stopped" and "interrupted" in result.reason


@pytest.mark.parametrize("rival", RIVALS)
def test_a_rival_tells_how_it_gets_on(rival: str) -> None:
    told: list[Any] = []
    run(rival, "ladder", (NO_HANGS,), max_checks=100_000, progress=told.append)
    assert told and all(isinstance(moment, Trying) for moment in told)
    assert [moment.checks for moment in told] == sorted(moment.checks for moment in told)


def test_greedy_search_that_saw_the_whole_space_says_so_with_the_stances_of_the_exact_planner() -> None:
    greedy, exact = run("greedy", *UNCLIMBABLE), run("exact", *UNCLIMBABLE)
    assert greedy.status == exact.status == "infeasible"
    assert greedy.stances == exact.stances and greedy.model == exact.model


@pytest.mark.parametrize("rival", ["random", "mcts"])
def test_a_search_that_proves_nothing_stops_without_a_plan(rival: str) -> None:
    result = run(rival, *UNCLIMBABLE, max_checks=50_000)
    assert result.status == "stopped" and "proves nothing" in result.reason


def test_greedy_search_says_when_its_memory_is_full() -> None:
    result = run("greedy", "h", (NO_HANGS,), max_stances=100)
    assert result.status == "stopped" and "memory was full" in result.reason


def test_tree_search_goes_on_when_its_memory_is_full() -> None:
    task = load_task(*SHORT)
    result = plan_mcts(task, max_stances=300, max_checks=200_000)
    assert result.status == "found" and result.check().reached


def test_tree_search_needs_no_walks_and_random_walks_need_no_jumps() -> None:
    task = load_task(*SHORT)
    assert plan_mcts(task, max_checks=200_000, settings=Settings(horizon=0)).status == "found"
    assert plan_random(task, max_checks=400_000, bursts=Bursts(walks=1, length=200, patience=1)).status == "found"


def test_tree_search_and_random_walks_come_close_to_the_optimum_of_a_small_board() -> None:
    task = load_task(*SHORT)
    best = plan_exact(task).length
    for rival in ("random", "mcts"):
        assert best <= run(rival, *SHORT, max_checks=200_000).length <= 1.5 * best


@pytest.mark.parametrize("rival", RIVALS)
def test_a_goal_that_is_met_at_the_start_needs_no_action(rival: str) -> None:
    result = run(rival, "ladder", (NO_HANGS, "goal.y_min=3in"), max_checks=1000)
    assert result.status == "found" and result.length == 0


@pytest.mark.parametrize("rival", RIVALS)
def test_a_robot_that_may_do_nothing_and_a_plan_of_one_action_end_the_search_at_once(rival: str) -> None:
    nothing = run(rival, "ladder", (NO_HANGS, "rules.allowed=[]"))
    assert nothing.status in ("stopped", "infeasible") and nothing.length == 0
    one = run(rival, "ladder", (NO_HANGS, "goal.y_min=9in"), max_checks=200_000)
    assert (one.status, one.length) == ("found", 1)


@pytest.mark.parametrize("rival", RIVALS)
def test_rivals_refuse_rules_that_they_cannot_list(rival: str) -> None:
    with pytest.raises(PlannerError, match=r"rules\.allowed"):
        run(rival, "ladder", ('rules.allowed=["3","191"]',))


def test_the_heap_gives_the_largest_value_first_and_among_equals_the_lowest_number() -> None:
    rng = np.random.default_rng(0)
    value = rng.integers(0, 20, 300).astype(np.float64)
    heap = np.zeros(300, np.int32)
    n, out, put = 0, [], 0
    while put < 300 or n:
        if put < 300 and (n == 0 or rng.random() < 0.6):
            n = push(heap, n, value, put)
            put += 1
        else:
            first, n = pop(heap, n, value)
            waiting = [first, *heap[:n].tolist()]
            assert first == min(waiting, key=lambda entry: (-value[entry], entry))
            out.append(int(first))
    assert sorted(out) == list(range(300))


def test_the_schedule_of_restarts_is_lubys() -> None:
    assert [luby(k) for k in range(1, 16)] == [1, 1, 2, 1, 1, 2, 4, 1, 1, 2, 1, 1, 2, 4, 8]
