"""Sets of assignments of elbows: which sides all elbows together may have under `branch = "kept"` (page "The model", section 6).

An assignment gives each limb a branch: bit i of its number is the branch of limb i. A set has a bit for each of the 2^n assignments of
n limbs, in words of 64. A free limb's elbow is bound to nothing, so of every assignment in the set that with its other branch is in it.
"""

from typing import Any

from ....compiled import inlined, kernel

WORDS = 4
"""Words of a set, for eight limbs."""
EVERY = -1
"""A word of the set of all assignments."""
HALVES = (
    0x5555555555555555,
    0x3333333333333333,
    0x0F0F0F0F0F0F0F0F,
    0x00FF00FF00FF00FF,
    0x0000FFFF0000FFFF,
    0x00000000FFFFFFFF,
)
"""The assignments of a word in which limb 0, 1, ... 5 has branch 0."""


@inlined
def words_of(n):
    """How many words the set of n limbs has."""
    return 1 if n <= 6 else 1 << (n - 6)


@inlined
def is_open(elbows, assignment):
    """Whether an assignment is in a set."""
    return (elbows[assignment >> 6] >> (assignment & 63)) & 1 != 0


@kernel
def free_elbow(elbows, n, i):
    """Let limb i of n have either branch: of every assignment in the set, that with its other branch is in it, too."""
    if i < 6:
        for w in range(words_of(n)):
            word = elbows[w]
            elbows[w] = word | (word & HALVES[i]) << (1 << i) | (word >> (1 << i)) & HALVES[i]
    else:
        apart = 1 << (i - 6)
        for w in range(words_of(n)):
            if not w & apart:
                both = elbows[w] | elbows[w | apart]
                elbows[w] = both
                elbows[w | apart] = both


@kernel
def reflect_elbows(elbows, n, image, reflected):
    """Write the mirror image of a set: limb `image[i]` has the other branch than limb i."""
    for w in range(WORDS):
        reflected[w] = 0
    for assignment in range(1 << n):
        if is_open(elbows, assignment):
            there = 0
            for i in range(n):
                there |= (1 - ((assignment >> i) & 1)) << image[i]
            reflected[there >> 6] |= 1 << (there & 63)


def has_assignment(elbows: Any, assignment: int) -> bool:
    """Whether an assignment is in the set of a stance."""
    return bool(int(elbows[assignment >> 6]) >> (assignment & 63) & 1)


def open_branches(elbows: Any, n: int, i: int) -> int:
    """The branches that limb i of n has in the assignments of a set (bit set)."""
    found = 0
    for assignment in range(1 << n):
        if has_assignment(elbows, assignment):
            found |= 1 << (assignment >> i & 1)
    return found
