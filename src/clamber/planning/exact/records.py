"""What an exact search reads and writes: its aim, its state, stances and the ways to them, as fixed-size records."""

from typing import NamedTuple

import numpy as np

from ...types import Ints, Records

RUNNING, FOUND, EXHAUSTED, FULL = 0, 1, 2, 3
NONE = -1
NEWEST, SHORTEST, NEAREST = 0, 1, 2
"""Which label of a bucket goes first: the newest (straight to the goal), the one of the fewest actions (so that the second cost is least
when a stance's turn comes), or the one nearest to the goal."""
EQUAL = 1e-12
"""Costs that differ by less than this part of them are the same: sums of one plan's costs in another order."""

NODE = np.dtype([("first", "f8"), ("second", "f8"), ("closed", "f8"), ("closed_first", "f8")], align=True)
"""Of a stance: the costs of its best label (in a front, of its newest); of those taken the least second cost, and the first with it."""
LABEL = np.dtype(
    [
        ("first", "f8"),
        ("second", "f8"),
        ("ahead", "f8"),  # bound on the actions still needed
        ("node", "i4"),
        ("parent", "i4"),
        ("code", "i4"),
        ("flipped", "i4"),  # the stance kept is the mirror image of the one that the action led to
        ("next", "i4"),  # in its bucket, or of a goal the goal before
    ],
    align=True,
)
"""A way to a stance: its two costs, the label that it goes on from, and the action."""
STATE = np.dtype(
    [
        ("nodes", "i8"),
        ("labels", "i8"),
        ("lowest", "i8"),  # bucket being emptied
        ("level", "i8"),  # lowest level of it that may hold a label
        ("levels", "i8"),  # levels that may hold one
        ("expanded", "i8"),
        ("checks", "i8"),
        ("goal", "i8"),  # best goal label; in a front the last one, `next` leads to those before
        ("dead", "i8"),  # stances from which the bound rules out every goal
        ("dominated", "i8"),  # stances dropped for a dominating one at no more cost
        ("goal_first", "f8"),
        ("goal_second", "f8"),
    ],
    align=True,
)
SEARCH = np.dtype(
    [
        ("first", "i4"),  # feature that is the first cost
        ("second", "i4"),  # feature that is the second; -1: none
        ("capped", "i4"),  # feature that no action may have more of than `cap`; -1: none
        ("front", "i4"),  # keep every way that is better in either cost
        ("informed", "i4"),  # the first cost is the number of actions: the family's bound counts
        ("dominance", "i4"),  # drop stances for dominating ones
        ("order", "i4"),  # within a bucket: NEWEST, SHORTEST or NEAREST first
        ("cap", "f8"),
        ("width", "f8"),  # of a bucket, in the first cost
        ("at_most", "f8"),  # of the first cost
    ],
    align=True,
)
"""What a search minimizes."""


class Seen(NamedTuple):
    """What a search knows."""

    nodes: Records
    """`NODE` of every stance seen, shape (room,)."""
    keys: "np.ndarray[tuple[int, ...], np.dtype[np.int64]]"
    """Shape (room, words)."""
    labels: Records
    """Ways to them."""
    heads: Ints
    """The first label of each bucket."""
    steps: Ints
    """The first label of each level of the bucket being emptied."""
    table: Ints
    """Hash table of the stances; its size is a power of two."""
