"""The family seam: a family registers its scalar kernels under the class of its parameters; the loops over them are written once.

The kernel is chosen while compiling, by the record type of the parameters `p`, so the choice costs nothing at run
time and the machine code is cached on disk
(a jitted function handed in as an argument never is).
"""

from collections.abc import Callable
from typing import Any, Final

import numpy as np
from numba import from_dtype, types
from numba.extending import overload

from ...kernel_cache import made_outside

SCALARS = (
    "step",
    "draft",
    "candidates",
    "key",
    "restore",
    "measure",
    "bound",
    "heuristic_between",
    "dominating",
    "reflect",
    "done",
    "cell",
    "body_pose",
    "satisfies_goal",
    "stance_cost",
)
FAMILIES: dict[types.Type, dict[str, Callable[..., Any]]] = {}


def _no_other(p, s, which, t):  # type: ignore[no-untyped-def]
    return False


def _no_mirror(p, s, t):  # type: ignore[no-untyped-def]
    return False


def _no_bound(p, s, t):  # type: ignore[no-untyped-def]
    return 0.0


def _no_burden(p, s, spare, margins, row):  # type: ignore[no-untyped-def]
    pass


def _no_draft(p, before, code, after):  # type: ignore[no-untyped-def]
    return 0


PLAIN: Final[dict[str, Callable[..., Any]]] = {
    "dominating": _no_other,
    "reflect": _no_mirror,
    "heuristic_between": _no_bound,
    "stance_cost": _no_burden,
    "draft": _no_draft,
}
"""Kernels that a family may do without: nothing is known that would make searches shorter, and being somewhere costs nothing."""


def family_kernels(params: np.dtype[np.void], **kernels: Any) -> None:
    """Register a family: the record type of its parameters and its scalar kernels, one for each of `SCALARS` but those in `PLAIN`."""
    wrong = (set(SCALARS) - set(PLAIN) - set(kernels)) | (set(kernels) - set(SCALARS))
    assert not wrong, f"kernels {sorted(wrong)} missing or unknown"
    kind = from_dtype(params)
    FAMILIES[kind] = {**PLAIN, **{name: each.py_func for name, each in kernels.items()}}
    made_outside(kind, kernels.values())


def _chosen(name: str, params: types.Type) -> Callable[..., Any]:
    assert params in FAMILIES, f"no family has parameters of type {params}"
    return FAMILIES[params][name]


def step(p, before, code, after, margins):  # type: ignore[no-untyped-def]
    """Carry out one action: writes `after` and `margins`, returns the first violated hard check, or -1."""
    raise TypeError("called from kernels only")


def draft(p, before, code, after):  # type: ignore[no-untyped-def]
    """Write what an action leads to, but for what only judging tells: 1 if it is written, -1 if there is no such action, 0 if `step` must.

    Key, cell, bound and goals of what is written are those of the stance that `step` would write; so are the `foreseen` features.
    """
    raise TypeError("called from kernels only")


def candidates(p, s, codes):  # type: ignore[no-untyped-def]
    """Write every different action from a stance; return their number."""
    raise TypeError("called from kernels only")


def key(p, s, words):  # type: ignore[no-untyped-def]
    """Write the integers that stances with equal futures share; the first three are x, y and angle of the body, `TICKS` for each step."""
    raise TypeError("called from kernels only")


def restore(p, words, s):  # type: ignore[no-untyped-def]
    """Make a stance again from its key: all that actions and hard checks read."""
    raise TypeError("called from kernels only")


def measure(p, s, row):  # type: ignore[no-untyped-def]
    """Write the features of the action that led to a stance."""
    raise TypeError("called from kernels only")


def bound(p, s):  # type: ignore[no-untyped-def]
    """An admissible number of actions to the goal."""
    raise TypeError("called from kernels only")


def dominating(p, s, which, t):  # type: ignore[no-untyped-def]
    """Write the stance number `which` that can do all that a stance can, and maybe more; False if there is none of that number."""
    raise TypeError("called from kernels only")


def reflect(p, s, t):  # type: ignore[no-untyped-def]
    """Write the mirror image of a stance, as far as keys and bounds read it; False if the problem is not its own mirror image."""
    raise TypeError("called from kernels only")


def done(p, s):  # type: ignore[no-untyped-def]
    """Whether a stance has met every goal."""
    raise TypeError("called from kernels only")


def cell(p, s):  # type: ignore[no-untyped-def]
    """A coarse place in the search space, for niching."""
    raise TypeError("called from kernels only")


def heuristic_between(p, s, t):  # type: ignore[no-untyped-def]
    """An admissible, consistent number of actions from the stance `s` to the key of the stance `t`."""
    raise TypeError("called from kernels only")


def body_pose(p, s, words):  # type: ignore[no-untyped-def]
    """Write where a stance is: x, y, angle of the body in ticks, then the hold of each limb, -1 where it is free."""
    raise TypeError("called from kernels only")


def satisfies_goal(p, s, k):  # type: ignore[no-untyped-def]
    """Whether a stance is where goal k asks for, whatever came before."""
    raise TypeError("called from kernels only")


def stance_cost(p, s, spare, margins, row):  # type: ignore[no-untyped-def]
    """Write what it costs to be in a judged stance: the problem's `stance_costs`; the rest is scratch."""
    raise TypeError("called from kernels only")


overload(step)(lambda p, before, code, after, margins: _chosen("step", p))
overload(draft)(lambda p, before, code, after: _chosen("draft", p))
overload(candidates)(lambda p, s, codes: _chosen("candidates", p))
overload(key)(lambda p, s, words: _chosen("key", p))
overload(restore)(lambda p, words, s: _chosen("restore", p))
overload(measure)(lambda p, s, row: _chosen("measure", p))
overload(bound)(lambda p, s: _chosen("bound", p))
overload(dominating)(lambda p, s, which, t: _chosen("dominating", p))
overload(reflect)(lambda p, s, t: _chosen("reflect", p))
overload(done)(lambda p, s: _chosen("done", p))
overload(cell)(lambda p, s: _chosen("cell", p))
overload(body_pose)(lambda p, s, words: _chosen("body_pose", p))
overload(satisfies_goal)(lambda p, s, k: _chosen("satisfies_goal", p))
overload(stance_cost)(lambda p, s, spare, margins, row: _chosen("stance_cost", p))
overload(heuristic_between)(lambda p, s, t: _chosen("heuristic_between", p))
