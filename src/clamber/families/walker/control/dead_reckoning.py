"""Where a walker is, by its own lengths: the feet that stand do not move, so they tell where the plate is. Kernels.

Nothing here knows the true heading or place: errors of the feet's places stay, and each landing adds one.
"""

import math

from ....compiled import kernel
from ....plane import wrap
from .posture import plate_on_legs


@kernel
def orient(alpha, beta, gamma, matrix):
    """Write R = Rz(alpha) Ry(beta) Rx(gamma), shape (3, 3)."""
    ca = math.cos(alpha)
    sa = math.sin(alpha)
    cb = math.cos(beta)
    sb = math.sin(beta)
    cg = math.cos(gamma)
    sg = math.sin(gamma)
    matrix[0, 0] = ca * cb
    matrix[0, 1] = ca * sb * sg - sa * cg
    matrix[0, 2] = ca * sb * cg + sa * sg
    matrix[1, 0] = sa * cb
    matrix[1, 1] = sa * sb * sg + ca * cg
    matrix[1, 2] = sa * sb * cg - ca * sg
    matrix[2, 0] = -sb
    matrix[2, 1] = cb * sg
    matrix[2, 2] = cb * cg


@kernel
def leg_places(rest, place, places):
    """Write where the legs of both frames are in the plate.

    Args:
        rest: Of the feet, each in its frame, shape (2, 3, 2) [m].
        place: Of the Y-frame in the Delta-frame, shape (3,) [m], [rad].
        places: Output, shape (6, 2) [m].
    """
    c = math.cos(place[2])
    s = math.sin(place[2])
    for i in range(3):
        places[i, 0] = rest[0, i, 0]
        places[i, 1] = rest[0, i, 1]
        places[3 + i, 0] = place[0] + c * rest[1, i, 0] - s * rest[1, i, 1]
        places[3 + i, 1] = place[1] + s * rest[1, i, 0] + c * rest[1, i, 1]


@kernel
def soles_in_world(pose, places, lengths, soles, matrix):
    """Write where the soles are in the world.

    Args:
        pose: Of the plate, shape (6,) [m], [rad].
        places: Of the legs in the plate, shape (n, 2) [m].
        lengths: Of the legs, shape (n,) [m].
        soles: Output, shape (n, 3) [m].
        matrix: Output, the plate's orientation, shape (3, 3).
    """
    orient(pose[3], pose[4], pose[5], matrix)
    for i in range(lengths.shape[0]):
        for k in range(3):
            soles[i, k] = (
                pose[k] + matrix[k, 0] * places[i, 0] + matrix[k, 1] * places[i, 1] - matrix[k, 2] * lengths[i]
            )


@kernel
def reckon(places, lengths, anchors, heights, stands, pose, soles, matrix):
    """Move the plate's pose to where its legs' lengths put it over the feet that stand.

    Height and tilt are those of `plate_on_legs`. Heading and place are those that bring the soles nearest to the anchors, seen from
    above, by the sum of squares: a plate that tilts on rigid legs changes the distances of its soles, and they give way alike.

    Args:
        places: Of the legs in the plate, shape (n, 2) [m].
        lengths: Of the legs, shape (n,) [m].
        anchors: Where in the world feet stand, seen from above, shape (n, 2) [m].
        heights: Their heights in the world, shape (n,) [m].
        stands: 1 for feet that stand, shape (n,).
        pose: Of the plate, changed, shape (6,) [m], [rad]; its heading chooses among whole turns.
        soles: Output, in the world, shape (n, 3) [m].
        matrix: Output, the plate's orientation, shape (3, 3).

    Returns:
        Whether three feet or more stand that are not in a line; if not, the pose stays.
    """
    found, z, beta, gamma = plate_on_legs(places, lengths, heights, stands)
    if found:
        cb = math.cos(beta)
        sb = math.sin(beta)
        cg = math.cos(gamma)
        sg = math.sin(gamma)
        n = vx = vy = ax = ay = dot = cross = 0.0
        for i in range(stands.shape[0]):
            if stands[i]:
                x = cb * places[i, 0] + sb * (sg * places[i, 1] - cg * lengths[i])
                y = cg * places[i, 1] + sg * lengths[i]
                n += 1.0
                vx += x
                vy += y
                ax += anchors[i, 0]
                ay += anchors[i, 1]
                dot += x * anchors[i, 0] + y * anchors[i, 1]
                cross += x * anchors[i, 1] - y * anchors[i, 0]
        dot -= (vx * ax + vy * ay) / n
        cross -= (vx * ay - vy * ax) / n
        alpha = math.atan2(cross, dot)
        pose[3] += wrap(alpha - pose[3])
        c = math.cos(pose[3])
        s = math.sin(pose[3])
        pose[0] = (ax - c * vx + s * vy) / n
        pose[1] = (ay - s * vx - c * vy) / n
        pose[2] = z
        pose[4] = beta
        pose[5] = gamma
    soles_in_world(pose, places, lengths, soles, matrix)
    return found
