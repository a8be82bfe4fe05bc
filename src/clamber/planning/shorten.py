"""Make any plan shorter: a beam search about it, exact windows between its own stances, the shortest way through the stances about it."""

import time
from collections.abc import Callable
from dataclasses import replace
from typing import Final

import numpy as np

from .beam.layers import Beam, Corridor, search_layers
from .exact.corridor import shorten_in_corridor
from .exact.windows import Codes, Shortened, is_plan, shorten_by_windows
from .problem.problem import CompiledProblem


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


WIDTH: Final = 300
"""Stances kept of each layer of the beam."""
WINDOW: Final = 3_000
"""Most stances of one window."""
CORRIDOR: Final = 40_000
"""Most stances of one corridor: memory, about 250 bytes each."""
EFFORT: Final = 300_000
"""Most stances of windows and corridors together, unless told otherwise."""


def shorten(
    problem: CompiledProblem,
    codes: Codes,
    *,
    width: int = WIDTH,
    effort: int = EFFORT,
    seconds: float | None = None,
    tell: Callable[[int], None] | None = None,
) -> Shortened:
    """Make a plan shorter; it stays valid, and ends in a goal stance.

    Args:
        problem: The task. One whose actions can't be listed (`Problem.incomplete`) leaves the plan as it is.
        codes: A plan that holds and reaches the goal; every hold named (`Problem.resolve`).
        width: Width of the beam about the plan; 0 for none.
        effort: Most stances of windows and corridors; 0 for none.
        seconds: Most time [s]; a search that it ends is not repeatable.
        tell: Called with the length of the plan now and then.

    Returns:
        The plan, never longer; `complete` if it is proved that no plan of the task is shorter.
    """
    done = Shortened(codes, 0, 0, complete=not len(codes))
    if problem.incomplete is not None or not len(codes):
        return done
    started = time.monotonic()

    def left() -> float | None:
        return None if seconds is None else max(0.0, seconds - (time.monotonic() - started))

    if width:
        done = shorten_by_beam(problem, codes, width=width, seconds=left())
        if tell is not None:
            tell(len(done.codes))
    if effort and not done.interrupted:
        near = shorten_by_windows(problem, done.codes, most=WINDOW, effort=effort, seconds=left(), tell=tell)
        done = _then(done, near)
        effort -= near.stances
    if effort > 0 and not done.interrupted:
        wide = shorten_in_corridor(problem, done.codes, most=CORRIDOR, effort=effort, seconds=left(), tell=tell)
        done = _then(done, wide)
    return done


def _then(first: Shortened, second: Shortened) -> Shortened:
    return replace(second, stances=first.stances + second.stances, checks=first.checks + second.checks)
