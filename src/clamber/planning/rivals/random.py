"""The rival `random`: bursts of random walks with jumps and restarts (Monte-Carlo random walks, Nakhost and Müller 2009)."""

from typing import Final

import numpy as np

from ...tasks import Task
from ..progress import Listener
from ..result import PlanResult
from .answer import MAX_CHECKS, Hunt
from .guidance import guidance
from .random_kernels import burst

WALKS: Final = 50
"""Walks of a burst."""
LENGTH: Final = 6
"""Most actions of a walk; twice as many after a burst that came no further."""
PATIENCE: Final = 5
"""Bursts that come no further, before the search starts again from the start."""
AGAIN: Final = 0.5
"""Probability of a walk to do the same as before, where it can: runs of body moves, as in the genetic planner's fresh tails."""


def plan_random(
    task: Task,
    *,
    seed: int = 0,
    seconds: float | None = None,
    threads: int | None = None,
    max_checks: int = MAX_CHECKS,
    progress: Listener | None = None,
    walks: int = WALKS,
    length: int = LENGTH,
    patience: int = PATIENCE,
    again: float = AGAIN,
) -> PlanResult:
    """Walk at random, jump to where the best walk led, start again where none leads further; keep the shortest plan.

    Args:
        task: What to plan.
        seed: Same seed, same plan.
        seconds: Most wall-clock time [s].
        threads: The search runs on one.
        max_checks: Most actions to judge.
        progress: Called now and then.
        walks, length, patience, again: See `WALKS`, `LENGTH`, `PATIENCE`, `AGAIN`.

    Returns:
        "found", or "stopped" with the furthest stance.

    Raises:
        PlannerError: If the task allows actions that can't be listed one by one.
    """
    hunt = Hunt("random", task, seed, max_checks, seconds, progress)
    problem = hunt.problem
    params, weights = problem.params.record, guidance(problem)
    codes, stances = np.zeros(problem.branching, np.int32), np.zeros(3, problem.start.dtype)
    margins, row = np.zeros(len(problem.checks)), np.zeros(len(problem.features))
    here = np.zeros(2, problem.start.dtype)
    trail, best = (np.zeros(max(1, hunt.longest), np.int32) for _ in range(2))
    number = 0
    try:
        before = -1
        while not hunt.is_over and hunt.checks > before:
            before = hunt.checks
            here[:] = problem.start[0]
            way, value, stale, reached = np.zeros(0, np.int32), -np.inf, 0, False
            while not reached and stale < patience and not hunt.is_over:
                most = min(length << stale, hunt.longest - len(way))
                if most < 0:
                    break
                actions, value, judged, reached = burst(
                    params, here, codes, stances, margins, row, weights, again, walks, most, max_checks - hunt.checks,
                    seed, number, trail, best, value,
                )  # fmt: skip
                number += 1
                hunt.checks += int(judged)
                stale = 0 if actions > 0 else stale + 1
                way = np.concatenate([way, best[: max(0, actions)]])
                hunt.take(way, value, found=reached)
            hunt.tell()
    except KeyboardInterrupt:
        hunt.interrupted = True
    return hunt.result()
