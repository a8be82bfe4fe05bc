"""A binary heap of numbers with a value each, as kernels: the largest value first, among equals the lowest number."""

from ...compiled import inlined


@inlined
def before(value, a, b):
    """Whether entry a comes out before entry b."""
    return value[a] > value[b] or (value[a] == value[b] and a < b)


@inlined
def push(heap, n, value, entry):
    """Put an entry in; returns the new size."""
    at = n
    while at > 0:
        above = (at - 1) // 2
        if not before(value, entry, heap[above]):
            break
        heap[at] = heap[above]
        at = above
    heap[at] = entry
    return n + 1


@inlined
def pop(heap, n, value):
    """Take the first entry out; returns it, and the new size."""
    first = heap[0]
    n -= 1
    last = heap[n]
    at = 0
    while True:
        below = 2 * at + 1
        if below >= n:
            break
        if below + 1 < n and before(value, heap[below + 1], heap[below]):
            below += 1
        if not before(value, heap[below], last):
            break
        heap[at] = heap[below]
        at = below
    heap[at] = last
    return first, n
