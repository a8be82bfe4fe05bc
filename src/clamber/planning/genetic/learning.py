"""Learn a macro: a sequence that a plan that works repeats, or could repeat, found, tried from several starts, and kept (thesis 2.2.2)."""

from collections.abc import Sequence
from typing import Annotated

import numpy as np
from pydantic import Field, StrictInt

from ...specs import spec
from ..problem.arrays import ActionTable
from ..problem.problem import CompiledProblem, Records
from .evolve import Evolution, Genes

Count = Annotated[int, Field(strict=True, ge=0, lt=2**62)]

SHORTEST, LONGEST = 2, 24
"""Genes of a macro."""
REPEATS = 2
"""How often a macro must work in a row from a start to count as working from there."""
STARTS = 3
"""From how many different starts it must work."""
LONG_RUN = 200
"""How often in a row a macro is tried from the task's start."""
LEAST_GAIN = 1e-3
"""Progress that every repetition must make [m]."""


@spec
class Macro:
    """A learned module: several actions as one."""

    name: Annotated[str, Field(strict=True, min_length=1, max_length=64)]
    codes: tuple[StrictInt, ...]
    """Packed actions; whether the task has them is asked where they meet it."""
    gain: Annotated[float, Field(allow_inf_nan=False)]
    """Progress of the body in one go [m]."""
    starts: Count
    """Of the starts that it was tried from, in how many it worked."""
    tried: Count
    seen: Count
    """How often the plan itself has the sequence."""
    from_start: Count
    """How often in a row it works from the task's own start."""


def learn(problem: CompiledProblem, codes: Genes, *, most: int = 1) -> list[Macro]:
    """The best macros in a plan: every window that can be repeated, tried from the plan's stances and from the task's start.

    Args:
        problem: The task.
        codes: A plan, in codes that are relative ("nearest", not a named hold; see `CompiledProblem.relative`).
        most: How many macros to give.

    Returns:
        Macros by how far they lead when done again and again from the task's start, then by progress per action.
    """
    windows = {
        tuple(int(code) for code in codes[first : first + n])
        for n in range(SHORTEST, min(LONGEST, len(codes)) + 1)
        for first in range(len(codes) - n + 1)
    }
    return _choose(problem, codes, sorted(windows), most)


def learn_while_searching(problem: CompiledProblem, state: Evolution) -> list[Macro]:
    """Macros in the best plan so far, from windows that it has at least twice, one behind the other or apart."""
    codes = problem.actions.spell(state.best)
    repeated = []
    for n in range(SHORTEST, min(LONGEST, len(codes) // 2) + 1):
        seen: dict[tuple[int, ...], int] = {}
        for first in range(len(codes) - n + 1):
            window = tuple(int(code) for code in codes[first : first + n])
            if window in seen and first - seen[window] >= n:
                repeated.append(window)
            seen.setdefault(window, first)
    return _choose(problem, codes, sorted({window for window in repeated if len(set(window)) > 1}), 1)


def _choose(problem: CompiledProblem, codes: Genes, windows: Sequence[tuple[int, ...]], most: int) -> list[Macro]:
    if not windows:
        return []
    stances = problem.replay(codes).stances
    starts = _spread_out(stances)
    table = ActionTable.build([(str(i), window, False) for i, window in enumerate(windows)])
    works = np.zeros((len(windows), len(starts)), bool)
    gains = np.zeros(len(windows))
    for column, start in enumerate(starts):
        held, gain = _repeat(problem, table, start, REPEATS)
        works[:, column] = (held >= REPEATS) & (gain > REPEATS * LEAST_GAIN)
        gains = np.where(works[:, column], np.maximum(gains, gain / REPEATS), gains)
    good = [int(i) for i in np.flatnonzero(works.sum(axis=1) >= min(STARTS, len(starts)))]
    if not good:
        return []
    table = ActionTable.build([(str(i), windows[i], False) for i in good])
    held, _ = _repeat(problem, table, problem.start, LONG_RUN)
    lengths = np.array([len(windows[i]) for i in good])
    way = held * gains[good]
    order = np.lexsort((lengths, -np.round(gains[good] / lengths, 9), -np.round(way, 6)))
    return [
        Macro(
            name=f"macro {rank + 1}",
            codes=windows[good[place]],
            gain=float(gains[good[place]]),
            starts=int(works[good[place]].sum()),
            tried=len(starts),
            seen=_count(codes, windows[good[place]]),
            from_start=int(held[place]),
        )
        for rank, place in enumerate(order[:most].tolist())
    ]


def _count(codes: Genes, window: tuple[int, ...]) -> int:
    """How often a plan has a sequence."""
    n = len(window)
    return sum(tuple(codes[i : i + n].tolist()) == window for i in range(len(codes) - n + 1))


def _spread_out(stances: Records, most: int = 12) -> list[Records]:
    """The plan's start and some of its stances, as starts to try from."""
    places = np.unique(np.linspace(0, len(stances) - 1, min(most, len(stances))).astype(int))
    return [stances[i : i + 1].copy() for i in places]


def _repeat(
    problem: CompiledProblem, table: ActionTable, start: Records, times: int
) -> tuple[Genes, np.ndarray[tuple[int], np.dtype[np.float64]]]:
    """How often each macro of a table works in a row from a stance, and how far the body comes.

    A start that meets the goal has no way to go, so it counts as not working.
    """
    bound = problem.rebind(table, start)
    n = len(table)
    genes = np.repeat(np.arange(n, dtype=np.int32)[:, None], times, axis=1)
    weights = np.zeros(len(problem.features))
    body = problem.features.index("body")
    weights[body] = 1.0
    records = bound.rollout(np.ascontiguousarray(genes), np.full(n, times, np.int32), weights, 1 << 20)
    at_start = problem.progress(start)
    finished = np.where(records["done"], times, records["genes"])
    return finished.astype(np.int32), records["features"][:, body] - at_start
