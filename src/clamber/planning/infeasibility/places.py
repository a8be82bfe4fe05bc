"""One hold more: every pose that the robot can reach without it, and each place that a limb could grab from there, settled by exact search.

A plan that the added hold opens must grab it, for without that it would be a plan in the world as it is. Until its first grab only
stances are passed that can be reached as it is. So only places count that lie in some limb's reach from some pose that can be reached.
"""

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from typing import Any, Final

from ...interrupts import answer
from ...kernel_cache import is_compiled
from ...types import Floats
from ..problem.problem import CompiledProblem
from ..problem.problems import normalisation_of, plan_family
from ..reach.exploration import explore_breadth_first
from .find import FeasibleRelaxation
from .trial import Answer, Trial

PER_LIMB: Final = 4
"""Unless told otherwise, the lattice of places is as wide as a limb over this, in whole steps of the task."""
SHARE: Final = 0.25
"""Of the time, at most this much goes into seeing every pose that can be reached [-]."""


def reached_poses(trial: Trial, problem: CompiledProblem, threads: int) -> Floats | None:
    """Poses of the body that can be reached, as the family's lattice has them, shape (n, axes); None if they were not all seen."""
    task: Any = trial.task
    lattice = plan_family(task).lattice(task, problem)
    see = partial(
        explore_breadth_first, problem, normalisation_of(task), lattice, holds=len(task.world.holds), threads=threads
    )
    trial.grant(SHARE)
    if not is_compiled("spread"):  # compiling is not to count
        see(most_stances=2 * problem.branching)
        trial.grant(SHARE)
    seen = see(most_stances=trial.max_stances, seconds=trial.granted())
    if seen.ended == "interrupt":
        trial.stopped.set()
    if seen.ended:
        return None
    poses: Floats = lattice.origin + seen.poses[seen.notes["stances"] > 0] * lattice.step
    return poses


def settle_each(trial: Trial, overrides: Sequence[str], threads: int) -> list[Answer]:
    """The answer for each change by itself, in order, up to Ctrl-C (`trial.stopped`)."""
    answers: list[Answer] = []
    with ThreadPoolExecutor(threads, thread_name_prefix="clamber") as pool:
        asked = [pool.submit(trial.settle, (override,), threads) for override in overrides]
        try:
            answers += (future.result() for future in asked)
        except KeyboardInterrupt:
            answer()
            trial.stopped.set()
            pool.shutdown(cancel_futures=True)
    return answers


def smallest_radius(task: Any) -> float:
    """Radius of an added hold [m]: that of the smallest there is."""
    radius: float = min(hold.radius for hold in task.world.holds)
    return radius


def opening(key: str, after: str, override: str, found: Answer) -> FeasibleRelaxation:
    """What a hold more opens, its place in words."""
    return FeasibleRelaxation(
        key=key,
        before=None,
        after=after,
        unit="",
        overrides=(override,),
        length=len(found.codes),
        shortest=found.shortest,
        least=True,
    )
