"""How many places a disc can cover at once, wherever it lies."""

import math

import numpy as np

from ....compiled import kernel

SLACK = 1.0e-9
"""By how much a disc is taken larger, so that rounding never makes the count too small [m] and [rad]."""


@kernel
def most_covered(x, y, radius):
    """Most places that a closed disc can cover.

    A disc that covers a largest set can be moved until one of them lies on its edge; about each place, the discs with that place on
    their edge are gone round once (Chazelle and Lee, "On a circle placement problem", 1986), so the cost is that of the places near it.

    Args:
        x, y: Places [m], sorted by y, shape (n,).
        radius: Of the disc [m].
    """
    n = x.shape[0]
    reach = 2.0 * (radius + SLACK)
    opens = np.empty(64)
    closes = np.empty(64)
    best = min(n, 1)
    low = 0
    high = 0
    for i in range(n):
        while y[i] - y[low] > reach:
            low += 1
        while high < n and y[high] - y[i] <= reach:
            high += 1
        count = 0
        here = 1  # places that every such disc covers: this one, and others on the same spot
        wrapped = 0
        for j in range(low, high):
            dx = x[j] - x[i]
            if j == i or dx > reach or dx < -reach:
                continue
            dy = y[j] - y[i]
            distance = math.sqrt(dx * dx + dy * dy)
            if distance > reach:
                continue
            if distance <= SLACK:
                here += 1
                continue
            if count == opens.shape[0]:
                opens = np.append(opens, opens)
                closes = np.append(closes, closes)
            towards = math.atan2(dy, dx)
            half = math.acos(distance / reach) + SLACK
            first = towards - half
            last = towards + half
            if first < -math.pi:
                first += 2.0 * math.pi
                wrapped += 1
            elif last > math.pi:
                last -= 2.0 * math.pi
                wrapped += 1
            opens[count] = first
            closes[count] = last
            count += 1
        if here + count <= best:
            continue
        begun = np.sort(opens[:count])
        ended = np.sort(closes[:count])
        past = 0
        best = max(best, here + wrapped)
        for k in range(count):
            while past < count and ended[past] < begun[k]:
                past += 1
            best = max(best, here + wrapped + k + 1 - past)
    return best
