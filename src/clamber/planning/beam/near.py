"""Make a plan shorter by a beam search about it: ways with other holds, that no window of the plan comes across."""

import numpy as np

from ..exact.windows import Codes, Shortened, is_plan
from ..problem.problem import CompiledProblem
from .layers import Beam, Corridor, search_layers


def shorten_by_beam(
    problem: CompiledProblem,
    codes: Codes,
    *,
    width: int,
    steps: float = 10.0,
    seconds: float | None = None,
) -> Shortened:
    """Search for a shorter plan whose body stays near that of a given one.

    Args:
        problem: The task.
        codes: A plan that holds and reaches the goal; every hold named (`Problem.resolve`).
        width: Stances kept of each layer.
        steps: How far the body may go from the plan's places, in body steps of the plan.
        seconds: Most time [s].

    Returns:
        A plan that holds, reaches the goal, and is never longer.
    """
    stances = problem.replay(codes).stances
    places = np.stack([stances["x"], stances["y"]], axis=1)
    strides = np.hypot(*np.diff(places, axis=0).T)
    moved = strides[strides > 0.0]
    radius = steps * float(np.median(moved)) if len(moved) else 0.0
    reached = search_layers(
        problem, Beam(width=width, longest=max(0, len(codes) - 1)), corridor=Corridor(places, radius), seconds=seconds
    )
    better = reached.found and len(reached.codes) < len(codes) and is_plan(problem, reached.codes)
    return Shortened(reached.codes if better else codes, reached.stances, reached.checks, False, reached.interrupted)
