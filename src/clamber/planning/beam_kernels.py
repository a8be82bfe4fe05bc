"""Choose a layer of a beam: the best children that are new, few of them from any one niche."""

import numpy as np

from ..compiled import kernel
from .problem.randoms import scramble
from .stance_table import slot_of


@kernel
def choose(order, slots, cells, keys, width, niche, kept_keys, n_kept, table, niches, counts, chosen):
    """Take children in order of their score: those with a key that no layer had yet, at most `niche` per niche, up to `width`.

    Args:
        order: Children, best first: parent times `slots` plus slot.
        slots: Slots per parent.
        cells, keys: As `Problem.expand_scored` wrote them.
        width: Most children to take.
        niche: Most of one niche.
        kept_keys, n_kept: Keys of all layers so far, with room for `width` more, and their number; the new ones are added.
        table: Hash table of `kept_keys`.
        niches, counts: Scratch: an empty hash table of niches (their number plus one), at least twice `width` long, a power of two.
        chosen: Output: the children taken.

    Returns:
        How many were taken.
    """
    n = 0
    mask = np.uint64(niches.shape[0] - 1)
    for at in range(order.shape[0]):
        if n == width:
            break
        child = order[at]
        i = child // slots
        j = child - i * slots
        slot = slot_of(keys[i, j], table, kept_keys)
        if table[slot] >= 0:
            continue
        place = np.int64(scramble(np.uint64(cells[i, j])) & mask)
        while counts[place] > 0 and niches[place] != cells[i, j]:
            place = (place + 1) & np.int64(mask)
        if counts[place] >= niche:
            continue
        niches[place] = cells[i, j]
        counts[place] += 1
        table[slot] = n_kept + n
        for w in range(keys.shape[2]):
            kept_keys[n_kept + n, w] = keys[i, j, w]
        chosen[n] = child
        n += 1
    return n
