"""The genetic operators as one kernel: selection, crossover, fresh tails, mutation; randomness by counters, so it has no order."""

import math

from ...compiled import inlined, kernel
from ..problem.randoms import below, draw, unit

ROULETTE, RANK = 0, 1
TAIL, ONE_POINT, TWO_POINT = 0, 1, 2


@inlined
def normal(seed, a, b, c):
    """A normal deviate (Box-Muller) for three counters."""
    u = unit(draw(seed, a, b, c))
    v = unit(draw(seed, a, b, c + 1))
    return math.sqrt(-2.0 * math.log(1.0 - u)) * math.cos(2.0 * math.pi * v)


@inlined
def near(at, spread, length, seed, a, b, c):
    """A place in 0..length, normally distributed about `at`."""
    place = int(round(at + spread * normal(seed, a, b, c)))
    return min(length, max(0, place))


@inlined
def pick(wheel, bits):
    """An index drawn in proportion to a cumulative wheel."""
    target = unit(bits) * wheel[wheel.shape[0] - 1]
    lo = 0
    hi = wheel.shape[0] - 1
    while lo < hi:
        mid = (lo + hi) // 2
        if wheel[mid] > target:
            hi = mid
        else:
            lo = mid + 1
    return lo


@kernel
def random_genes(row, first, end, runs, run_length, counters):
    """Fill genes `first` to `end` with random entries; entries that may run are repeated 1 to `run_length` times.

    With a run length of 1 every gene is drawn alone, as in the thesis's first generation. `runs` and `counters` as in `breed`, the number
    of the child last.
    """
    seed, generation, child = counters
    n_entries = runs.shape[0]
    at = first
    draw_number = 64
    while at < end:
        entry = below(draw(seed, generation, child, draw_number), n_entries)
        times = 1
        if runs[entry] and run_length > 1:
            times = 1 + below(draw(seed, generation, child, draw_number + 1), run_length)
        draw_number += 2
        while times > 0 and at < end:
            row[at] = entry
            at += 1
            times -= 1


@kernel
def breed(parents, children, runs, crossing, tails, mutating, counters):
    """Make a generation of children.

    Args:
        parents: Their genes, shape (n, longest), how many each has, where each failed, or the end of its best prefix, shape (n,);
            cumulative weights of selection, shape (n,); and for each the entries that hold at its cut (the configuration filter): count
            in column 0, then the entries, a count of 0 means any, shape (n, 1 + n_entries).
        children: Output: genes and how many each has.
        runs: Table entries that may run, shape (n_entries,).
        crossing: TAIL (cut points of both parents about their failures), ONE_POINT (one cut point for both, anywhere) or TWO_POINT; and the
            spread of cut points about the failure [genes].
        tails: Share of children that get a fresh random tail instead of another parent's, its most genes, and most repetitions of a move
            in it.
        mutating: Share of children that are mutated, near the failure, and whether mutation only inserts.
        counters: Of the random numbers: seed and generation.
    """
    genes, parent_lengths, cuts, wheel, first_genes = parents
    rows, child_lengths = children
    crossover, cut_spread = crossing
    tail_share, tail_length, run_length = tails
    mutation, insert_only = mutating
    seed, generation = counters
    longest = rows.shape[1]
    n_entries = runs.shape[0]
    for child in range(rows.shape[0]):
        a = pick(wheel, draw(seed, generation, child, 0))
        b = pick(wheel, draw(seed, generation, child, 1))
        length_a = parent_lengths[a]
        length_b = parent_lengths[b]
        row = rows[child]
        fresh = unit(draw(seed, generation, child, 2)) < tail_share
        if crossover == TAIL or fresh:
            c1 = near(cuts[a], cut_spread, length_a, seed, generation, child, 3)
            c2 = near(cuts[b], cut_spread, length_b, seed, generation, child, 5)
            end = longest
        elif crossover == ONE_POINT:
            c1 = below(draw(seed, generation, child, 3), min(length_a, length_b) + 1)
            c2 = c1
            end = longest
        else:
            shorter = min(length_a, length_b)
            c1 = below(draw(seed, generation, child, 3), shorter + 1)
            c2 = c1
            end = c1 + below(draw(seed, generation, child, 4), shorter - c1 + 1)
        for i in range(c1):
            row[i] = genes[a, i]
        if fresh:
            stop = min(longest, c1 + 1 + below(draw(seed, generation, child, 7), tail_length))
            random_genes(row, c1, stop, runs, run_length, (seed, generation, child))
            if c1 < stop and c1 == cuts[a] and first_genes[a, 0] > 0:
                row[c1] = first_genes[a, 1 + below(draw(seed, generation, child, 8), first_genes[a, 0])]
            length = stop
        else:
            length = c1
            i = c2
            while i < length_b and length < longest and length < end:
                row[length] = genes[b, i]
                length += 1
                i += 1
            if crossover == TWO_POINT:
                i = end
                while i < length_a and length < longest:
                    row[length] = genes[a, i]
                    length += 1
                    i += 1
        if unit(draw(seed, generation, child, 9)) < mutation:
            at = near(min(cuts[a], length), cut_spread, length, seed, generation, child, 10)
            length = mutate(row, length, at, n_entries, insert_only, (seed, generation, child))
        if length == 0:
            row[0] = below(draw(seed, generation, child, 20), n_entries)
            length = 1
        child_lengths[child] = length


@kernel
def mutate(row, length, at, n_entries, insert_only, counters):
    """Insert, replace or remove the gene at a place (the thesis only inserts); returns the new length."""
    seed, generation, child = counters
    entry = below(draw(seed, generation, child, 12), n_entries)
    kind = 0 if insert_only else below(draw(seed, generation, child, 13), 3)
    if kind == 0 and length < row.shape[0]:
        for i in range(length, at, -1):
            row[i] = row[i - 1]
        row[at] = entry
        return length + 1
    if kind == 1 and at < length:
        row[at] = entry
        return length
    if at < length:
        for i in range(at, length - 1):
            row[i] = row[i + 1]
        return length - 1
    return length


@kernel
def vary(best, children, child_lengths, runs, run_length, seed, turn):
    """Variants of a plan that works, most of them shorter: windows and single genes left out, windows replaced, genes moved.

    Args:
        best: The plan, shape (n,).
        children, child_lengths: Output.
        runs, run_length: As in `breed`.
        seed, turn: Counters of the random numbers.
    """
    length = best.shape[0]
    for child in range(children.shape[0]):
        row = children[child]
        for i in range(length):
            row[i] = best[i]
        n = length
        kind = below(draw(seed, turn, child, 0), 4)
        if kind == 0:  # one or two windows fewer
            for cut in range(1 + below(draw(seed, turn, child, 1), 2)):
                width = 1 + below(draw(seed, turn, child, 2 + 2 * cut), 6)
                n = leave_out(row, n, below(draw(seed, turn, child, 3 + 2 * cut), n), width)
        elif kind == 1:  # one to four single genes fewer
            for cut in range(1 + below(draw(seed, turn, child, 1), 4)):
                n = leave_out(row, n, below(draw(seed, turn, child, 2 + cut), n), 1)
        elif kind == 2:  # a window replaced by fewer genes
            width = 2 + below(draw(seed, turn, child, 1), 14)
            at = below(draw(seed, turn, child, 2), n)
            width = min(width, n - at)
            fresh = below(draw(seed, turn, child, 3), width)
            n = leave_out(row, n, at, width - fresh)
            random_genes(row, at, at + fresh, runs, run_length, (seed, turn, child))
        else:  # a gene moved, and another left out
            source = below(draw(seed, turn, child, 1), n)
            target = below(draw(seed, turn, child, 2), n)
            gene = row[source]
            n = leave_out(row, n, source, 1)
            target = min(target, n)
            for i in range(n, target, -1):
                row[i] = row[i - 1]
            row[target] = gene
            n += 1
            if below(draw(seed, turn, child, 3), 2):
                n = leave_out(row, n, below(draw(seed, turn, child, 4), n), 1)
        child_lengths[child] = n


@kernel
def leave_out(row, length, at, width):
    """Remove up to `width` genes at a place, but not the last gene left; returns the new length."""
    width = min(width, min(length - at, length - 1))
    for i in range(at, length - width):
        row[i] = row[i + width]
    return length - width
