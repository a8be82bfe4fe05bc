"""Keys, bounds and restored stances of a problem, by the kernels that planners call."""

from typing import Any

import numpy as np

from clamber.compiled import kernel
from clamber.families.spatial.planning.problem import SpatialProblem
from clamber.planning.problem.family_kernels import bound, key, restore


@kernel
def _keys(p, stances, words):  # type: ignore[no-untyped-def]
    for i in range(len(stances)):
        key(p, stances[i], words[i])


@kernel
def _restore(p, words, stances):  # type: ignore[no-untyped-def]
    for i in range(len(stances)):
        restore(p, words[i], stances[i])


@kernel
def _bounds(p, stances, out):  # type: ignore[no-untyped-def]
    for i in range(len(stances)):
        out[i] = bound(p, stances[i])


def keys_of(problem: SpatialProblem, stances: Any) -> Any:
    words = np.zeros((len(stances), problem.key_words), np.int64)
    _keys(problem.params.record, stances, words)
    return words


def restored(problem: SpatialProblem, words: Any) -> Any:
    made = np.zeros(len(words), problem.start.dtype)
    _restore(problem.params.record, words, made)
    return made


def bounds_of(problem: SpatialProblem, stances: Any) -> Any:
    out = np.zeros(len(stances))
    _bounds(problem.params.record, stances, out)
    return out
