"""How long a step of cooperative motion takes, with all its limits, beside mink and pink on the same chain."""

from functools import partial
from statistics import median
from typing import Final

import numpy as np

from ..families.walker.control.cooperative.closest import ReachSearch
from ..families.walker.control.cooperative.cooperator import Cooperator
from ..families.walker.control.cooperative.freedoms import freedoms_of, weights_of
from ..families.walker.control.cooperative.settings import Cooperation, own_speeds
from ..families.walker.robot import WalkerRobot
from ..families.walker.trials.cooperative.chain_peers import CHAIN_PEERS, PERIOD, Tick
from ..families.walker.trials.cooperative.follow import FollowOptions, FollowRun, follow_path
from ..families.walker.trials.cooperative.tool_path import load_tool_path
from ..tasks.robots import load_robot
from ..types import Floats
from .control_speed import round_times
from .ik_peers import installed
from .region_speed import region_rows
from .rows import NOTHING, Row, Say, keep_quiet

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
    robot = load_robot("hoshino")
    assert isinstance(robot, WalkerRobot)
    return robot


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
            rows.append(Row(f"{name} (not installed: pip install 'clamber[bench]')", NOTHING, "ratio"))
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
