"""How far a point lies inside standing feet, seen from above. A kernel."""

import math

from ..compiled import kernel


@kernel
def support_margin(feet, stands, point):
    """How far a point lies inside the hull of the standing feet, seen from above [m]; negative outside, -inf with fewer than three.

    Args:
        feet: Shape (n, 2) or (n, 3) [m].
        stands: 1 for feet that stand, shape (n,).
        point: Shape (2,) or (3,) [m].
    """
    n = 0
    for i in range(stands.shape[0]):
        n += stands[i] > 0
    if n < 3:
        return -math.inf
    best = math.inf
    for a in range(stands.shape[0]):
        for b in range(stands.shape[0]):
            x = feet[b, 0] - feet[a, 0]
            y = feet[b, 1] - feet[a, 1]
            length = math.hypot(x, y)
            if stands[a] <= 0 or stands[b] <= 0 or length == 0.0:
                continue
            least = math.inf
            for i in range(stands.shape[0]):
                if stands[i] > 0:
                    least = min(least, (x * (feet[i, 1] - feet[a, 1]) - y * (feet[i, 0] - feet[a, 0])) / length)
            if least >= -1e-9:  # all others on the left: an edge of the hull
                best = min(best, (x * (point[1] - feet[a, 1]) - y * (point[0] - feet[a, 0])) / length)
    return best
