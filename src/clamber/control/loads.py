"""How legs share a walker's load, and what sinking in does to where its feet stand. Kernels.

Loads count by the plane through them: the weight alone decides that. The rest is how six legs strain against each other.
"""

import math

import numpy as np

from ..compiled import kernel


@kernel
def plane_slope(points, values, counts):
    """How the plane that fits values at points best rises along x and y, [per m]; 0, 0 with fewer than three points or all in a line.

    Args:
        points: Shape (n, 2) [m].
        values: Such as loads [N] or heights [m], shape (n,).
        counts: 1 for points that count, shape (n,).
    """
    n = 0
    x_mean = y_mean = 0.0
    for i in range(counts.shape[0]):
        if counts[i]:
            n += 1
            x_mean += points[i, 0]
            y_mean += points[i, 1]
    if n < 3:
        return 0.0, 0.0
    x_mean /= n
    y_mean /= n
    xx = xy = yy = by_x = by_y = 0.0
    for i in range(counts.shape[0]):
        if counts[i]:
            x = points[i, 0] - x_mean
            y = points[i, 1] - y_mean
            xx += x * x
            xy += x * y
            yy += y * y
            by_x += x * values[i]
            by_y += y * values[i]
    spread = xx * yy - xy * xy
    if spread <= 1e-12 * (xx + yy) * (xx + yy):
        return 0.0, 0.0
    return (yy * by_x - xy * by_y) / spread, (xx * by_y - xy * by_x) / spread


@kernel
def strain_of(places, loads, stands):
    """By how much each standing leg carries more than its even share, shape (n,) [N]; 0 for others.

    The even shares are the plane through the loads: of all loads that carry the same weight at the same place they have the smallest
    sum of squares. What is over adds up to no force and no moment: so six legs strain against each other.

    Args:
        places: Of the legs in the plate, shape (n, 2) [m].
        loads: Of the feet, shape (n,) [N].
        stands: 1 for legs that count, shape (n,).
    """
    strain = np.zeros(stands.shape[0])
    n = 0
    x_mean = y_mean = mean = 0.0
    for i in range(stands.shape[0]):
        if stands[i]:
            n += 1
            x_mean += places[i, 0]
            y_mean += places[i, 1]
            mean += loads[i]
    if n <= 3:
        return strain
    x_mean /= n
    y_mean /= n
    mean /= n
    by_x, by_y = plane_slope(places, loads, stands)
    for i in range(stands.shape[0]):
        if stands[i]:
            strain[i] = loads[i] - mean - by_x * (places[i, 0] - x_mean) - by_y * (places[i, 1] - y_mean)
    return strain


@kernel
def sink_unevenly(share, give, heading, places, loads, stands, slope, heights):
    """Standing feet sink in by the plane through their loads, as far as they have not yet; the mean of their heights stays.

    Args:
        share: Of what they have not yet [-].
        give: By how much a foot sinks in under load [m/N].
        heading: Of the plate [rad].
        places: Of the legs in the plate, shape (n, 2) [m].
        loads: Of the feet, shape (n,) [N].
        stands: 1 for legs that stand, shape (n,).
        slope: Of the plane through the loads that is made up for, along the world's axes, changed, shape (2,) [N/m].
        heights: Of the footholds, changed where legs stand, shape (n,) [m].

    Returns:
        By how much the slope has changed, along the plate's axes [N/m].
    """
    x, y = plane_slope(places, loads, stands)
    c = math.cos(heading)
    s = math.sin(heading)
    more_x = share * (c * x - s * y - slope[0])
    more_y = share * (s * x + c * y - slope[1])
    slope[0] += more_x
    slope[1] += more_y
    change_x = c * more_x + s * more_y
    change_y = c * more_y - s * more_x
    n = 0
    x_mean = 0.0
    y_mean = 0.0
    for i in range(stands.shape[0]):
        if stands[i]:
            n += 1
            x_mean += places[i, 0]
            y_mean += places[i, 1]
    for i in range(stands.shape[0]):
        if stands[i]:
            heights[i] -= give * ((places[i, 0] - x_mean / n) * change_x + (places[i, 1] - y_mean / n) * change_y)
    return change_x, change_y


@kernel
def sink_together(share, give, forces, stands, loads, anchors, heights):
    """Standing feet sink in along the ground's normal, each to the side for itself, and all together downwards.

    Args:
        share: Of what they have not yet [-].
        give: By how much a foot sinks in under load [m/N].
        forces: As felt, shape (n,) [N].
        stands: 1 for feet that stand, shape (n,).
        loads: Those that are made up for, changed, shape (n,) [N].
        anchors: Where the feet stand, seen from above, changed, shape (n, 2) [m].
        heights: Of the footholds, changed where feet stand, shape (n,) [m].

    Returns:
        By how much all of them together go down [m].
    """
    rise_x, rise_y = plane_slope(anchors, heights, stands)
    upright = give / (
        1.0 + rise_x * rise_x + rise_y * rise_y
    )  # of the force along the normal, the part that is upright
    n = 0
    total = 0.0
    for i in range(stands.shape[0]):
        if stands[i]:
            change = share * (forces[i] - loads[i])
            loads[i] += change
            anchors[i, 0] += upright * change * rise_x
            anchors[i, 1] += upright * change * rise_y
            total += change
            n += 1
    if n == 0:
        return 0.0
    down = upright * total / n
    for i in range(stands.shape[0]):
        if stands[i]:
            heights[i] -= down
    return down
