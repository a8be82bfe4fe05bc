"""The benchmarks by name."""

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from statistics import median
from typing import Final

import numpy as np

from ..errors import how_to_install
from ..families.spatial.trials.speed import law_rows, space_rows
from ..families.spatial.trials.worlds import bench_worlds
from ..families.walker.control.cooperative.closest import ReachSearch
from ..families.walker.control.cooperative.cooperator import Cooperator
from ..families.walker.control.cooperative.freedoms import freedoms_of, weights_of
from ..families.walker.control.cooperative.settings import Cooperation, own_speeds
from ..families.walker.robot import WalkerRobot
from ..families.walker.robot.robot import build_walker
from ..families.walker.trials.cooperative.chain_peers import CHAIN_PEERS, PERIOD, Tick
from ..families.walker.trials.cooperative.follow import FollowOptions, FollowRun, follow_path
from ..families.walker.trials.cooperative.tool_path import load_tool_path
from ..interrupts import abandonable
from ..planning.exact.explore import explore
from ..planning.exact.planner import plan_exact
from ..planning.genetic.profile import load_profile
from ..planning.problem.problems import pose_problem
from ..tasks import load_task
from ..tasks.robots import read_robot
from ..trials.measured import NOTHING, Crew, Row, Say, keep_quiet, round_times
from ..types import Floats
from .batches import batch_rows
from .breadth import breadth_first
from .climb_speed import climb_rows
from .contest import NO_HANGS, THESIS, run_contest
from .control_speed import control_rows, installed, region_rows
from .peers import race_rows
from .planner_trials import bench_ablation, bench_seeds, filter_rows, macro_rows, run_cases
from .plant_bench import plant_rows
from .speed import speed_rows
from .starts import command_rows, start_rows
from .tables import rows_of
from .walls import wall_rows

ROUNDS: Final = 15
"""How often each piece of work is timed; the median counts, of a ratio that of the ratios of each round."""
STEPS: Final = 400
"""Of ours in one timing."""
PEER_STEPS: Final = 100
PATH: Final = "wide"
"""Whose configurations are timed: on its way actuators, legs, balance and joints come to their limits."""
DOFS: Final = (4, 5, 7, 10)


def walker() -> WalkerRobot:
    """The robot that is timed."""
    return build_walker(read_robot("hoshino"))


def _law(run: FollowRun, *, limited: bool) -> Cooperator:
    settings = Cooperation(
        speeds=own_speeds(run.robot), tool_speeds=np.full(3, 0.2), feedback=2.0, period=PERIOD, limited=limited
    )
    return Cooperator(run.robot, settings, run.footing)


def _step_often(law: Cooperator, run: FollowRun, weights: Floats, steps: int) -> None:
    still, many = np.zeros(3), len(run.q)
    for k in range(steps):
        row = k * many // steps
        law.step(run.q[row], run.wanted[row], still, weights)


def _tick_often(tick: Tick, run: FollowRun, steps: int) -> None:
    many = len(run.q)
    for k in range(steps):
        row = k * many // steps
        tick(run.q[row], run.wanted[row])


def step_rows(*, rounds: int = ROUNDS, steps: int = STEPS, say: Say = keep_quiet) -> list[Row]:
    """One step, called from Python, by degrees of freedom: with every limit, and equation 19 alone."""
    rows = []
    for dof in DOFS:
        say(f"steps with {dof} degrees of freedom")
        run = follow_path(walker(), load_tool_path(PATH), FollowOptions(dof=dof))
        weights = weights_of(freedoms_of(dof, 4), 4)
        works = [partial(_step_often, _law(run, limited=limited), run, weights, steps) for limited in (True, False)]
        whole, bare = np.median(round_times(works, rounds), axis=0) / steps
        rows.append(Row(f"redundancy step with all limits, {dof} dof", 1e6 * whole, "us", "< 150"))
        rows.append(Row(f"equation 19 without limits, {dof} dof", 1e6 * bare, "us"))
    return rows


def peer_rows(*, rounds: int = ROUNDS, steps: int = PEER_STEPS, say: Say = keep_quiet) -> list[Row]:
    """A step of mink and of pink over ours, which keeps the limits of actuators, legs and balance besides."""
    run = follow_path(walker(), load_tool_path(PATH), FollowOptions(dof=10))
    rows = []
    for name, make in CHAIN_PEERS.items():
        if not installed(name):
            rows.append(Row(f"{name} (not installed: {how_to_install('bench')})", NOTHING, "ratio"))
            continue
        say(f"{name} on the same chain")
        ours = partial(_step_often, _law(run, limited=True), run, weights_of("all", 4), 10 * steps)
        ticks = [make(run.robot, own_speeds(run.robot), limited=limited) for limited in (True, False)]
        works = [ours, *(partial(_tick_often, tick, run, steps) for tick in ticks)]
        own, limited, bare = round_times(works, rounds).T / steps
        own /= 10
        rows += [
            Row(f"{name}: update and solve_ik, limits of joints and rates, daqp", 1e6 * median(limited), "us"),
            Row(f"{name}: the same over our step with all limits", median(limited / own), "ratio"),
            Row(f"{name}: without limits over our step with all limits", median(bare / own), "ratio"),
        ]
    return rows


def reach_rows(*, rounds: int = ROUNDS, say: Say = keep_quiet) -> list[Row]:
    """The reachable place nearest to a target, found from one posture and from all."""
    say("nearest reachable places")
    run = follow_path(walker(), load_tool_path(PATH), FollowOptions(dof=10))
    search = ReachSearch(run.robot, run.footing, weights_of("all", 4))
    near, far = np.array([0.6, 0.2, 0.6]), np.array([1.3, 0.2, 0.6])
    works = [partial(search.find, run.q[0], target) for target in (near, far)]
    inside, outside = np.median(round_times(works, rounds), axis=0)
    return [
        Row("nearest reachable place, target in reach", 1e3 * inside, "ms"),
        Row("nearest reachable place, target out of reach", 1e3 * outside, "ms"),
    ]


def hexapod_rows(*, say: Say = keep_quiet) -> list[Row]:
    """All of it."""
    return [*step_rows(say=say), *peer_rows(say=say), *reach_rows(say=say), *region_rows(walker(), say=say)]


MOST_STANCES: Final = 12_000_000


@dataclass(frozen=True, slots=True)
class Case:
    """A task that is proved."""

    label: str
    task: str
    overrides: tuple[str, ...] = ()


CASES: Final = (
    Case("ladder, 3 in", "ladder"),
    Case("ladder, 1 in", "ladder", ("step.length=1in",)),
    Case("modified ladder, 1 in", "modified-ladder"),
    Case("h, 3 in, no sub-goals", "h", ("step.length=3in", "subgoals=[]")),
    Case("h, 1 in", "h"),
    Case("across, 1 in", "across"),
    Case("circle, 1 in", "circle"),
)


def bench_exact(*, cases: tuple[Case, ...] = CASES, say: Say = keep_quiet) -> list[Row]:
    """Optimum, stances and time of both searches on every case without hangs, and the ratio of the whole set's times."""
    _warm()
    rows: list[Row] = []
    plain_total = exact_total = 0.0
    for case in cases:
        say(case.label)
        task = load_task(case.task, (*NO_HANGS, *case.overrides))
        problem = pose_problem(task, threads=1).problem
        started = time.perf_counter()
        plain = abandonable(partial(breadth_first, problem, most_stances=MOST_STANCES))
        plain_seconds = time.perf_counter() - started
        started = time.perf_counter()
        seen = explore(problem.informed(), most_stances=MOST_STANCES)
        exact_seconds = time.perf_counter() - started
        assert plain.complete and plain.length == (len(seen.codes) if seen.found else None), case.label
        plain_total, exact_total = plain_total + plain_seconds, exact_total + exact_seconds
        length = NOTHING if plain.length is None else plain.length
        rows += [
            Row(f"{case.label}: proved optimum", length, "actions"),
            Row(f"{case.label}: breadth-first search, {plain.stances} stances", plain_seconds, "s"),
            Row(f"{case.label}: exact planner with its bound made, {seen.stances} stances", exact_seconds, "s"),
        ]
    rows.append(Row("whole set: breadth-first search", plain_total, "s"))
    rows.append(Row("whole set: exact planner", exact_total, "s"))
    rows.append(
        Row("whole set: exact planner's part of breadth-first search", exact_total / plain_total, "1", "at most 0.1")
    )
    return rows


def _warm() -> None:
    """Load or compile both searches before the clock runs."""
    small = pose_problem(load_task("ladder", (*NO_HANGS, "goal.y_min=12in")), threads=1).problem
    breadth_first(small, most_stances=10_000)
    explore(small.informed(), most_stances=10_000)


SEEDS: Final = tuple(range(20))


def bench_gaps(
    *, boards: Sequence[str] = THESIS, seeds: Sequence[int] = SEEDS, say: Say = keep_quiet, crew: Crew | None = None
) -> list[Row]:
    """Per board: the optimum, and the mean and largest length of the default profile's plans as parts of it."""
    tasks = {board: load_task(board, (*NO_HANGS, "step.length=1in")) for board in boards}
    say("genetic plans")
    trials = run_cases({board: (task, load_profile("default")) for board, task in tasks.items()}, seeds, crew)
    rows = []
    for board, task in tasks.items():
        say(f"the optimum of {board}")
        proof = plan_exact(task, threads=1)
        assert proof.status == "optimal", board
        lengths = [length for length in trials[board].lengths if length is not None]
        assert min(lengths, default=proof.length) >= proof.length, board
        parts = [length / proof.length for length in lengths] if len(lengths) == len(seeds) else [NOTHING]
        rows += [
            Row(f"{board}, 1 in, no hangs: proved optimum", proof.length, "actions"),
            Row(
                f"{board}: polished genetic plans, mean over the optimum, {len(lengths)} of {len(seeds)} found",
                sum(parts) / len(parts),
                "1",
            ),
            Row(f"{board}: polished genetic plans, longest over the optimum", max(parts), "1", "at most 1.1"),
        ]
    return rows


def bench_boards(*, say: Say = keep_quiet, crew: Crew | None = None) -> list[Row]:
    """Success, cost, length and proofs of every planner on the whole set."""
    say("every planner on 45 boards")
    return rows_of(run_contest(crew=crew))


def bench_plan(*, say: Say = keep_quiet) -> list[Row]:
    """Speed of planning, whole: the evaluator, the search beside peers, processes, and what makes searches smaller."""
    parts: tuple[Callable[..., list[Row]], ...] = (speed_rows, race_rows, start_rows, filter_rows, macro_rows)
    return [row for part in parts for row in part(say=say)]


BENCHES: Final[dict[str, Callable[..., list[Row]]]] = {
    "plan": bench_plan,
    "start": command_rows,
    "exact": bench_exact,
    "gaps": bench_gaps,
    "seeds": bench_seeds,
    "ablation": bench_ablation,
    "walls": wall_rows,
    "jobs": batch_rows,
    "boards": bench_boards,
    "control": control_rows,
    "climb": climb_rows,
    "plant": plant_rows,
    "hexapod": hexapod_rows,
    "spatial": space_rows,
    "worlds": bench_worlds,
    "whole-body": law_rows,
}
"""Name -> benchmark; the command line's choices and the tests read it. Each can be called without arguments, or with `say`."""


BATCHED: Final = ("seeds", "ablation", "jobs", "boards", "gaps", "worlds")
"""Those that are batches of items and take a `crew`; the others measure speed, alone."""


def run_bench(name: str, say: Say = keep_quiet, crew: Crew | None = None) -> list[Row]:
    """Run a benchmark by name; `crew` is for those of `BATCHED`."""
    return BENCHES[name](say=say, **({"crew": crew} if name in BATCHED else {}))
