"""Tasks in space, and keys, bounds and restored stances of a problem, by the kernels that planners call."""

from typing import Any

import numpy as np

from clamber.compiled import kernel
from clamber.families.spatial.planning.problem import SpatialProblem
from clamber.families.spatial.planning.task import SpatialTask
from clamber.planning.problem.family_kernels import bound, draft, key, restore, step
from clamber.trials.work import open_work


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


@kernel
def _drafts(p, stances, codes, told, made):  # type: ignore[no-untyped-def]
    for i in range(len(stances)):
        for k in range(len(codes)):
            told[i, k] = draft(p, stances[i], codes[k], made[i, k])


@kernel
def _verdicts(p, stances, codes, margins, reasons, made):  # type: ignore[no-untyped-def]
    for i in range(len(stances)):
        for k in range(len(codes)):
            reasons[i, k] = step(p, stances[i], codes[k], made[i, k], margins)


def in_space(name: str, *overrides: str) -> SpatialTask:
    """A task that is carried out in space: its own, or a climb's in a plane."""
    item = open_work(name, None, overrides).item
    assert isinstance(item, SpatialTask)
    return item


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


def drafts_of(problem: SpatialProblem, stances: Any, codes: Any) -> Any:
    """What drafts tell of every code from every stance, and what they write, one after another."""
    told, made = np.zeros((len(stances), len(codes)), np.int64), np.zeros((len(stances), len(codes)), stances.dtype)
    _drafts(problem.params.record, stances, codes, told, made)
    return told.ravel(), made.ravel()


def verdicts_of(problem: SpatialProblem, stances: Any, codes: Any) -> Any:
    """The check that every code from every stance violates, and the stances that it leads to, one after another."""
    reasons, made = np.zeros((len(stances), len(codes)), np.int64), np.zeros((len(stances), len(codes)), stances.dtype)
    _verdicts(problem.params.record, stances, codes, np.zeros(len(problem.checks)), reasons, made)
    return reasons.ravel(), made.ravel()
