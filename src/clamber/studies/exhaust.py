"""The exact planner as the studies use it: a shortest plan, or the proof that there is none, and how high the body came."""

from dataclasses import dataclass

from ..families.climber.planning.task import LimbedTask
from ..planning.exact.explore import explore
from ..planning.problem.problems import pose_problem
from ..types import Ints

MOST_STANCES = 2_000_000


@dataclass(frozen=True, slots=True)
class Exhausted:
    """What a search through the stances came to."""

    codes: Ints | None
    """A shortest plan that reaches the goal; None: there is none, or the search was cut short."""
    closed: bool
    """Whether every stance that can be reached was looked at without meeting the goal: there is no plan."""
    stances: int
    """Different stances looked at."""
    highest: float
    """y of the body's origin where it came furthest [m]."""


def exhaust(task: LimbedTask, *, most: int = MOST_STANCES) -> Exhausted:
    """Search the stances of a task; without hangs (`max_hangs = 0`) they are finitely many.

    Args:
        task: The task; `rules.allowed` may leave out body moves.
        most: Stances after which the search gives up.
    """
    problem = pose_problem(task, threads=1).problem
    seen = explore(problem, most_stances=most)
    highest = float(problem.replay(seen.codes).stances["y"].max())
    return Exhausted(seen.codes if seen.found else None, seen.exhausted, seen.stances, highest)
