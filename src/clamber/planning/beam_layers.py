"""Beam search over a `CompiledProblem`: layers of plans of equal length, the best of each layer kept, hashed and niched."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ..interrupts import Interruptible
from .beam_kernels import choose
from .problem.arrays import with_room
from .problem.problem import Beam, CompiledProblem, Records
from .progress import Clock
from .stance_table import rehash, table_size


@dataclass(frozen=True, slots=True)
class Corridor:
    """Where the body may be."""

    places: npt.NDArray[np.float64]
    """World frame [m], shape (n, 2)."""
    radius: float
    """Farthest from the nearest of them [m]."""

    def holds(self, stances: Records) -> npt.NDArray[np.bool_]:
        """Which stances lie in it."""
        x, y = self.places.T
        squares = (stances["x"][:, None] - x) ** 2 + (stances["y"][:, None] - y) ** 2
        inside: npt.NDArray[np.bool_] = squares.min(axis=1) <= self.radius**2
        return inside


@dataclass(frozen=True, slots=True)
class Reached:
    """What came of a beam search."""

    found: bool
    interrupted: bool
    codes: npt.NDArray[np.int32]
    """The plan; without one, the way to the stance with the best score."""
    layers: int
    stances: int
    """Stances kept in all layers."""
    checks: int
    """Children looked at that hold, or, where they are judged as they are taken, all that were judged."""


class _Kept:
    """Every stance that was kept: its key, and how it was reached; the arrays double as layers come."""

    def __init__(self, words: int) -> None:
        self.n = 0
        self.keys = np.zeros((0, words), np.int64)
        self.parent = np.zeros(0, np.int32)
        self.code = np.zeros(0, np.int32)
        self.table = np.zeros(0, np.int32)

    def make_room(self, more: int) -> None:
        if self.n + more <= len(self.keys):
            return
        capacity = 2 * (self.n + more)
        for name in ("keys", "parent", "code"):
            setattr(self, name, with_room(getattr(self, name), capacity))
        self.table = np.full(table_size(capacity), -1, np.int32)
        rehash(self.keys, self.n, self.table)


def search_layers(
    problem: CompiledProblem,
    beam: Beam,
    *,
    corridor: Corridor | None = None,
    seconds: float | None = None,
    tell: Callable[[int, int, float], None] | None = None,
) -> Reached:
    """Search layer by layer until a stance meets every goal, no new stance is left, or the layers or seconds are used up.

    Args:
        problem: The task.
        beam: Settings.
        corridor: Where the body may be; None for anywhere.
        seconds: Most time [s].
        tell: Called after every layer with its number, the stances kept so far, and the best score.

    Returns:
        What was reached: same settings, same plan, on any number of threads. Ctrl-C ends it with the best so far.
    """
    clock = Clock(seconds)
    weights = np.array([dict(beam.weights).get(name, 0.0) for name in problem.features])
    out = problem.scored_children(beam.width)
    slots, drafts = problem.branching, problem.drafts(weights)
    params, margins = problem.params.record, np.zeros(len(problem.checks))
    kept = _Kept(problem.key_words)
    kept.make_room(1 + beam.width)
    kept.parent[0] = -1
    kept.n = 1  # the start; its key is written when a child comes back to it
    layer, nodes, depth = problem.start, np.zeros(1, np.int64), 0
    best, best_score, checks = 0, -np.inf, 0
    goal = 0 if problem.is_done(problem.start) else -1
    niches = np.zeros(table_size(beam.width), np.int64)
    chosen, taken = np.zeros(beam.width, np.int64), np.zeros(beam.width + 1, problem.start.dtype)
    filled = np.arange(slots)
    with Interruptible() as block:
        while goal < 0 and len(layer) and depth < beam.longest:
            if clock.is_over:
                break
            problem.expand_scored(layer, weights, beam.toll, out)
            count = out.count[: len(layer)]
            children = np.flatnonzero((filled < count[:, None]).ravel())
            scores = out.score[: len(layer)].ravel()[children]
            ended = children[out.done[: len(layer)].ravel()[children] != 0]
            kept.make_room(beam.width)
            n, last = 0, False
            for order, most in ((ended, 1), (children[np.argsort(-scores, kind="stable")], beam.width)):
                scored, known = (layer, out.code, out.cell, out.keys), (kept.keys, kept.n, kept.table)
                counts = niches, np.zeros(len(niches), np.int32)
                n, judged = choose(params, order, scored, (most, beam.niche), known, counts, margins, (taken, chosen))
                checks += judged if drafts else 0
                last = n > 0 and most == 1
                if last:
                    break
            checks += 0 if drafts else len(children)
            parent, slot = (chosen[:n] // slots).astype(np.int32), chosen[:n] % slots
            code = out.code[parent, slot]
            kept.parent[kept.n : kept.n + n] = nodes[parent]
            kept.code[kept.n : kept.n + n] = code
            if n and (top := float(out.score[parent[0], slot[0]])) > best_score:
                best, best_score = kept.n, top
            goal = kept.n if last else -1
            layer, nodes = taken[:n].copy(), np.arange(kept.n, kept.n + n)
            if corridor is not None and n:
                near = corridor.holds(layer)
                layer, nodes = layer[near], nodes[near]
            kept.n += n
            depth += 1
            if tell is not None:
                tell(depth, kept.n, best_score)
    codes = []
    node = goal if goal >= 0 else best
    while node > 0:
        codes.append(int(kept.code[node]))
        node = int(kept.parent[node])
    return Reached(goal >= 0, block.interrupted, np.array(codes[::-1], np.int32), depth, kept.n, checks)
