"""Choose a layer of a beam: the best children that are new, few of them from any one niche."""

import numpy as np

from ..compiled import kernel
from .problem.family_kernels import step
from .problem.randoms import scramble
from .stance_table import slot_of


@kernel
def choose(p, order, scored, most, kept, niches, margins, taken):
    """Take children that hold in order of their score: those with a key that no layer had, at most `niche` per niche, up to `width`.

    Args:
        p: A family's parameters.
        order: Children, best first: parent times the slots of each parent, plus slot.
        scored: Parents, and codes, cells and keys as `Problem.expand_scored` wrote them; what it left to be judged is judged here.
        most: Children to take, and of one niche.
        kept: Keys of all layers so far, with room for `width` more, their number, and a hash table of them; the new ones are added.
        niches: Scratch: a hash table of niches and how often each was taken, all 0; at least twice `width` long, a power of two.
        margins: Scratch of the family's checks.
        taken: Output: the stances taken, with room for one more, and which children they are.

    Returns:
        How many were taken, and how many were judged.
    """
    parents, codes, cells, keys = scored
    width, niche = most
    children, chosen = taken
    kept_keys, n_kept, table = kept
    niches, counts = niches
    slots = codes.shape[1]
    n, judged = 0, 0
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
        judged += 1
        if step(p, parents[i], codes[i, j], children[n], margins) >= 0:
            continue
        niches[place] = cells[i, j]
        counts[place] += 1
        table[slot] = n_kept + n
        for w in range(keys.shape[2]):
            kept_keys[n_kept + n, w] = keys[i, j, w]
        chosen[n] = child
        n += 1
    return n, judged
