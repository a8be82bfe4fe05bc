"""What the exact planner minimizes, against dynamic programming over a small board's whole graph; its bound against random walks."""

import json
import math
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise, product

import numpy as np
import pytest
from typer.testing import CliRunner

from clamber.benchmarks.breadth import breadth_first
from clamber.cli.app import application
from clamber.compiled import kernel
from clamber.kernel_cache import bounds_checked
from clamber.planning.exact.costs import Aim, CostError, read_costs
from clamber.planning.exact.explore import Exploration, explore
from clamber.planning.exact.front import plan_front
from clamber.planning.exact.planner import Minimizer, plan_exact
from clamber.planning.problem.family_kernels import reflect
from clamber.planning.problem.problem import CompiledProblem
from clamber.planning.problem.problems import pose_problem
from clamber.tasks import load_task
from plain.search import NO_HANGS, SMALL, keys_of, restored

BOARD = ("modified-ladder", (NO_HANGS, "step.length=3in", "step.angle=45deg", "goal.y_min=24in"))
ROOM = 400_000
HARD_FEET = 'rules.hard=["reach","joint","support","hangs","torque","clearance","limb_peg"]'


@dataclass
class Graph:
    """Every reachable stance of a small problem and every action between them."""

    edges: np.ndarray
    """From, to."""
    torque: np.ndarray
    """Of each action."""
    power: np.ndarray
    start_torque: float
    goals: np.ndarray
    size: int


def whole_graph(problem: CompiledProblem) -> Graph:
    peak, effort = (problem.features.index(name) for name in ("peak", "effort"))
    number = {keys_of(problem, problem.start)[0].tobytes(): 0}
    layer, ids = problem.start, np.array([0])
    parts, goals = [], []
    while len(layer):
        children = problem.expand(layer)
        words, _ = keys_of(problem, children.stance)
        features = problem.measured(children.stance)
        fresh = []
        to = np.zeros(len(words), np.int64)
        for i, word in enumerate(words):
            mark = word.tobytes()
            if mark not in number:
                number[mark] = len(number)
                fresh.append(i)
                if problem.is_done(children.stance[i : i + 1]):
                    goals.append(number[mark])
            to[i] = number[mark]
        parts.append(np.column_stack([ids[children.parent], to, features[:, peak], features[:, effort]]))
        layer, ids = children.stance[fresh], to[fresh]
        alive = [i for i in range(len(layer)) if not problem.is_done(layer[i : i + 1])]
        layer, ids = layer[alive], ids[alive]
    table = np.concatenate(parts)
    start = float(problem.measured(problem.start)[0, peak])
    return Graph(table[:, :2].astype(int), table[:, 2], table[:, 3], start, np.array(goals), len(number))


def by_length(graph: Graph, cost: np.ndarray, start: float, *, add: bool, most: int) -> list[float]:
    """Least cost of a plan of exactly n actions, for n up to `most`: Bellman's recursion over lengths."""
    best = np.full(graph.size, math.inf)
    best[0] = start
    out = []
    for _ in range(most + 1):
        out.append(float(best[graph.goals].min()))
        came = best[graph.edges[:, 0]]
        value = came + cost if add else np.maximum(came, cost)
        best = np.full(graph.size, math.inf)
        np.minimum.at(best, graph.edges[:, 1], value)
    return out


@pytest.fixture(scope="module")
def small() -> tuple[CompiledProblem, Graph]:
    problem = pose_problem(load_task(*BOARD)).problem
    return problem, whole_graph(problem)


def pareto(values: list[float]) -> list[tuple[int, float]]:
    out: list[tuple[int, float]] = []
    for length, value in enumerate(values):
        if math.isfinite(value) and (not out or value < out[-1][1] * (1.0 - 1e-9)):
            out.append((length, value))
    return out


@pytest.mark.parametrize("informed", [True, False])
@pytest.mark.parametrize("cost", ["torque", "energy"])
def test_the_front_is_that_of_dynamic_programming(
    small: tuple[CompiledProblem, Graph], cost: str, informed: bool
) -> None:
    problem, graph = small
    values = graph.torque if cost == "torque" else graph.power
    start = graph.start_torque if cost == "torque" else 0.0
    expected = pareto(by_length(graph, values, start, add=cost == "energy", most=60))
    seen = explore(
        problem.informed() if informed else problem,
        most_stances=ROOM,
        aim=Aim(second=cost, front=True),
        dominance=informed,
    )
    assert seen.found
    found = [(len(way.codes), way.second) for way in seen.ways]
    assert [length for length, _ in found] == [length for length, _ in expected]
    assert [value for _, value in found] == pytest.approx([value for _, value in expected], rel=1e-9)


@pytest.mark.parametrize(
    "order", [("length", "torque"), ("length", "energy"), ("torque", "length"), ("length", "torque", "energy")]
)
def test_lexicographic_orders_are_those_of_dynamic_programming(
    small: tuple[CompiledProblem, Graph], order: tuple[str, ...]
) -> None:
    problem, graph = small
    least = Minimizer(problem.informed(), most_stances=ROOM).least(order)
    stances = problem.replay(least.codes).stances
    features = problem.measured(stances)
    torque = features[:, problem.features.index("peak")].max()
    energy = features[1:, problem.features.index("effort")].sum()
    if order[0] == "torque":
        every = by_length(graph, graph.torque, graph.start_torque, add=False, most=120)
        assert torque == pytest.approx(min(every), rel=1e-9)
        assert len(least.codes) == next(n for n, value in enumerate(every) if value <= torque * (1.0 + 1e-9))
        return
    lengths = by_length(graph, np.ones(len(graph.torque)), 0.0, add=True, most=60)
    shortest = next(n for n, value in enumerate(lengths) if math.isfinite(value))
    assert len(least.codes) == shortest
    if order[1] == "torque":
        assert torque == pytest.approx(
            by_length(graph, graph.torque, graph.start_torque, add=False, most=60)[shortest], rel=1e-9
        )
        if len(order) == 3:
            easy = graph.torque <= torque * (1.0 + 1e-9)
            tame = Graph(
                graph.edges[easy], graph.torque[easy], graph.power[easy], graph.start_torque, graph.goals, graph.size
            )
            assert energy == pytest.approx(by_length(tame, tame.power, 0.0, add=True, most=60)[shortest], rel=1e-9)
    else:
        assert energy == pytest.approx(by_length(graph, graph.power, 0.0, add=True, most=60)[shortest], rel=1e-9)


def test_least_energy_is_that_of_dynamic_programming(small: tuple[CompiledProblem, Graph]) -> None:
    problem, graph = small
    least = explore(problem.informed(), most_stances=ROOM, aim=Aim(first="energy"))
    expected = min(by_length(graph, graph.power, 0.0, add=True, most=150))
    assert least.found and least.ways[0].first == pytest.approx(expected, rel=1e-9)


def test_a_torque_limit_on_either_side_of_the_least_torque_opens_and_closes_the_board(
    small: tuple[CompiledProblem, Graph],
) -> None:
    problem, _ = small
    least = explore(problem.informed(), most_stances=ROOM, aim=Aim(first="torque")).ways[0].first
    over = explore(problem.informed(), most_stances=ROOM, aim=Aim(most_peak=least * (1.0 + 1e-9)))
    under = explore(problem.informed(), most_stances=ROOM, aim=Aim(most_peak=least * (1.0 - 1e-9)))
    assert over.found and under.exhausted and not under.ways


WALKS = {
    "circle": ("circle", (NO_HANGS,)),
    "circle, turns alone": ("circle", (NO_HANGS, "subgoals=[]")),
    "angles finer than a word": ("ladder", (NO_HANGS, "step.angle=5deg")),
    "no rotation": (
        "modified-ladder",
        (NO_HANGS, "rules.offset_while_holding=true", 'rules.allowed=["+x","-x","+y","-y","grab","release"]'),
    ),
    "atomic": ("h", (NO_HANGS, 'rules.support="atomic"')),
    "kept": ("across", (NO_HANGS, 'rules.branch="kept"')),
    "an angle asked for": ("ladder", (NO_HANGS, 'goal.theta_min="40deg"', 'goal.theta_max="50deg"')),
    "held again": ("ladder", (NO_HANGS, 'rules.allowed=["+x","+y","-y","+theta","hold","release"]')),
    "four limbs": ("gecko-climb", (NO_HANGS, "step.length=60mm", "step.angle=45deg")),
    "one hang": ("ladder", ("rules.max_hangs=1",)),
    "any number of hangs": ("h", ()),
    "two hangs on a ring": ("circle", ("rules.max_hangs=2",)),
    "walker": ("patch-walk", ()),
}  # fmt: skip
COSTLY = ("circle", "four limbs", "two hangs on a ring")
"""Walks whose bounds take seconds."""


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(WALKS, key=lambda name: name in COSTLY))
def test_the_relaxed_bound_falls_by_at_most_one_an_action(name: str) -> None:
    task, overrides = WALKS[name]
    problem = pose_problem(load_task(task, overrides)).problem.informed()
    rng = np.random.default_rng(3)
    here = problem.start
    for _ in range(60 if name == "four limbs" else 300):  # their forces are linear programmes
        children = problem.expand(here)
        if not len(children.stance):
            break
        before = keys_of(problem, here)[1][0]
        after = keys_of(problem, children.stance)[1]
        assert before <= 1.0 + after.min()
        here = children.stance[rng.integers(len(children.stance))][None].copy()


def stopped_after(looks: int) -> Callable[[], bool]:
    """A clock that says, from a look on, that there is no more time."""
    seen = iter(range(looks))
    return lambda: next(seen, None) is None


def looks_of(problem: CompiledProblem) -> int:
    """How often a bound that is worked out whole looks at the clock."""
    looks = []
    problem.informed(lambda: bool(looks.append(None)))
    return len(looks)


@pytest.mark.slow
@pytest.mark.parametrize(("name", "share"), [("atomic", 0.3), *product(("circle", "four limbs"), (0.3, 0.8))])
def test_a_bound_that_ran_out_of_time_is_lower_and_falls_by_at_most_one_an_action(name: str, share: float) -> None:
    task, overrides = WALKS[name]
    problem = pose_problem(load_task(task, overrides)).problem
    whole, cut = problem.informed(), problem.informed(stopped_after(round(share * looks_of(problem))))
    rng = np.random.default_rng(4)
    here, lower = problem.start, 0
    for _ in range(30):
        children = problem.expand(here).stance
        if not len(children):
            break
        there = np.concatenate((here, children))
        full, bounds = keys_of(whole, there)[1], keys_of(cut, there)[1]
        assert np.all(bounds <= full)
        assert bounds[0] <= 1.0 + bounds[1:].min()
        lower += int(np.count_nonzero(bounds < full))
        here = children[rng.integers(len(children))][None].copy()
    assert lower or share > 0.5, "it was stopped too late to be one"


@pytest.mark.slow
def test_the_exact_planner_keeps_to_its_time_where_bound_and_stances_are_costly() -> None:
    task = load_task("gecko-climb")
    plan_exact(load_task("h", (NO_HANGS, "step.length=3in")))  # compiles what it needs
    before = time.process_time()
    result = plan_exact(task, seconds=1.0)
    most = 6.0 if bounds_checked() else 3.0  # an index that is checked takes longer [s]
    assert time.process_time() - before < most, "it was 25 s"
    assert result.status == "bounded" and result.lower_bound is not None and result.lower_bound > 0


@pytest.mark.parametrize("name", SMALL)
def test_bound_and_dominance_change_no_answer(name: str) -> None:
    task, overrides = SMALL[name]
    problem = pose_problem(load_task(task, overrides)).problem
    plain = breadth_first(problem, most_stances=ROOM)
    for variant in (problem, problem.informed()):
        for dominance in (True, False):
            seen = explore(variant, most_stances=ROOM, dominance=dominance)
            assert (len(seen.codes) if seen.found else None) == plain.length
            assert seen.exhausted == (plain.length is None)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["held again", "atomic", "circle"])
def test_the_relaxed_bound_is_below_what_is_left_of_an_optimal_plan(name: str) -> None:
    task, overrides = WALKS[name]
    problem = pose_problem(load_task(task, overrides)).problem.informed()
    seen = explore(problem, most_stances=2_000_000)
    assert seen.found
    _, bounds = keys_of(problem, problem.replay(seen.codes).stances)
    assert np.all(bounds <= np.arange(len(seen.codes), -1, -1))
    assert all(later >= sooner - 1.0 for sooner, later in pairwise(bounds))
    assert seen.expanded >= len(seen.codes)


@kernel
def image_of(p, stance, image):
    return reflect(p, stance[0], image[0])


@pytest.mark.parametrize(("task", "overrides"), [("ladder", ()), ("ladder", ('rules.branch="kept"', HARD_FEET))])
def test_the_mirror_image_of_a_stance_has_the_mirror_images_of_its_futures(
    task: str, overrides: tuple[str, ...]
) -> None:
    problem = pose_problem(load_task(task, (NO_HANGS, *overrides))).problem.informed()
    rng = np.random.default_rng(5)
    here = problem.start
    for _ in range(40):
        image = here.copy()
        assert image_of(problem.params.record, here, image)
        words, _ = keys_of(problem, image)
        again = np.zeros(1, here.dtype)
        restored(problem.params.record, words, again)
        children, mirrored = problem.expand(here), problem.expand(again)
        assert sorted(problem.mirrored(int(code)) for code in children.code) == sorted(
            int(code) for code in mirrored.code
        )
        for child, code in zip(children.stance, children.code, strict=True):
            other = mirrored.stance[list(mirrored.code).index(problem.mirrored(int(code)))][None]
            reflected = child[None].copy()
            image_of(problem.params.record, child[None], reflected)
            assert np.array_equal(keys_of(problem, reflected)[0], keys_of(problem, other)[0])
            assert child["torque"] == pytest.approx(other["torque"][0], abs=1e-9)
        here = children.stance[rng.integers(len(children.stance))][None].copy()


@pytest.mark.parametrize("aim", [Aim(), Aim(first="energy"), Aim(second="torque", front=True)])
def test_a_search_through_half_of_a_symmetric_space_answers_the_same(aim: Aim) -> None:
    problem = pose_problem(load_task("ladder", (NO_HANGS, "goal.y_min=36in", "step.angle=45deg"))).problem
    whole, half = (explore(one, most_stances=ROOM, aim=aim) for one in (problem, problem.informed()))
    assert [way.first for way in half.ways] == pytest.approx([way.first for way in whole.ways], rel=1e-9)
    assert [way.second for way in half.ways] == pytest.approx([way.second for way in whole.ways], rel=1e-9)
    assert half.stances < 0.6 * whole.stances
    for way in half.ways:
        replayed = problem.replay(way.codes)
        assert replayed.ok and problem.is_done(replayed.stances[-1:])


@pytest.mark.parametrize("override", ["start.x=9.2in", 'rules.allowed=["+x","+y","grab","release"]', "goal.x_min=0in"])
def test_what_breaks_the_symmetry_is_seen(override: str) -> None:
    problem = pose_problem(load_task("ladder", (NO_HANGS, override))).problem.informed()
    assert not image_of(problem.params.record, problem.start, problem.start.copy())


def test_a_front_tells_whether_it_is_complete() -> None:
    task = load_task(*BOARD)
    whole = plan_front(task, ("length", "torque"))
    assert whole.complete and len(whole.trades) > 1
    assert all(a.length < b.length and a.costs["torque"] > b.costs["torque"] for a, b in pairwise(whole.trades))
    part = plan_front(task, ("torque", "length"), max_stances=300)
    assert not part.complete and "more may be" in part.reason
    other = plan_front(task, ("energy", "torque"))
    assert other.complete and all(
        a.costs["energy"] < b.costs["energy"] and a.costs["torque"] > b.costs["torque"]
        for a, b in pairwise(other.trades)
    )


def test_what_is_minimized_is_told() -> None:
    result = plan_exact(load_task(*BOARD), minimize=("torque", "length"))
    assert result.status == "optimal" and result.minimized == ("torque", "length")
    assert result.costs["length"] == result.length and result.costs["torque"] >= result.max_torque


@pytest.mark.parametrize("text", ["lenght", "length,length", "", "length,torque,energy,torque"])
def test_unknown_and_doubled_costs_are_named(text: str) -> None:
    with pytest.raises(CostError, match="--minimize"):
        read_costs("--minimize", text)


def test_the_command_line_draws_a_front(tmp_path) -> None:  # type: ignore[no-untyped-def]
    name, overrides = BOARD
    sets = [word for override in overrides for word in ("--set", override)]
    picture = tmp_path / "front.svg"
    run = CliRunner().invoke(
        application(), ["plan", name, *sets, "--pareto", "length,torque", "--json", "-o", str(picture)]
    )
    assert run.exit_code == 0 and picture.exists()
    told = json.loads(run.stdout)
    assert told["status"] == "optimal" and len(told["trades"]) > 1


def test_an_order_whose_second_search_runs_out_is_not_called_optimal(small: tuple[CompiledProblem, Graph]) -> None:
    problem, _ = small

    class Interrupted(Minimizer):
        def run(self, aim: Aim) -> Exploration:
            if aim.first == "torque":
                return super().run(aim)
            return replace(super().run(aim), found=False, ways=())

    least = Interrupted(problem.informed(), most_stances=ROOM).least(("torque", "length"))
    assert not least.found and least.ways and least.lower_bound == pytest.approx(least.ways[0].first)
