"""Kernels for crossing a ditch at one angle of the frames: what the feet allow, and whether slides connect both sides.

The ditch is the strip 0 < s < w along the crossing direction d; feet may stand on its edges. A frame whose origin is at s stands where no
s + f_i, with f_i its feet's places along d, is inside: in four intervals, by how many feet are across. A slide of the lifted frame takes
it anywhere within t - s in [low, high], what the frames' region allows along d, so what counts is s and t alone.
"""

import math

from ....compiled import inlined, kernel
from .arcs import extent, outline, owner_of, ray
from .curves import BELOW, reach_curves

SIDES = 4
"""Intervals of a frame: by how many of its feet are across, 0 to 3."""
FINE = 1e-10
"""How finely the widest ditch is found [m]."""


@inlined
def stand_from(places, w, k):
    """Least place along d of a frame with k feet across [m]; `places` of its feet in falling order, shape (3,)."""
    return -math.inf if k == 0 else w - places[k - 1]


@inlined
def stand_to(places, k):
    """Largest place along d of a frame with k feet across [m]."""
    return math.inf if k == 3 else -places[k]


@kernel
def connects(delta_feet, y_feet, w, low, high, seen, stack):
    """Whether slides lead from before a ditch of width w to behind it.

    A node is how many feet of each frame are across, a convex set of (s, t) that slides of both frames connect in itself. A slide of one
    frame leads to another node if the frame that stands has a place from which the lifted one may stand in either.

    Args:
        delta_feet, y_feet: Places of the frames' feet along d, in falling order, shape (3,) [m].
        w: Width of the ditch [m].
        low, high: Range of the Y-frame's place less the Delta-frame's [m].
        seen: Scratch, shape (SIDES, SIDES).
        stack: Scratch, shape (SIDES * SIDES, 2).
    """
    if not high > low:
        return False
    seen[:] = False
    seen[0, 0] = True
    stack[0, 0] = stack[0, 1] = 0
    depth = 1
    while depth > 0:
        depth -= 1
        a = stack[depth, 0]
        b = stack[depth, 1]
        if a == 3 and b == 3:
            return True
        for other in range(SIDES):
            if not seen[other, b] and slides(delta_feet, a, other, y_feet, b, w, low, high):
                seen[other, b] = True
                stack[depth, 0] = other
                stack[depth, 1] = b
                depth += 1
            if not seen[a, other] and slides(y_feet, b, other, delta_feet, a, w, -high, -low):
                seen[a, other] = True
                stack[depth, 0] = a
                stack[depth, 1] = other
                depth += 1
    return False


@inlined
def slides(lifted, k, other, standing, across, w, low, high):
    """Whether a frame with k feet across gets to another number, while one stands whose place less its own is from low to high."""
    first = max(stand_from(standing, w, across), stand_from(lifted, w, k) + low)
    first = max(first, stand_from(lifted, w, other) + low)
    last = min(stand_to(standing, across), stand_to(lifted, k) + high)
    last = min(last, stand_to(lifted, other) + high)
    return first <= last and stands(lifted, w, other) and stands(lifted, w, k)


@inlined
def stands(places, w, k):
    """Whether a frame can stand with k feet across at all."""
    return stand_from(places, w, k) <= stand_to(places, k)


@kernel
def places_along(feet, angle, dx, dy, places):
    """Write a frame's feet, turned by `angle`, along the unit direction d, in falling order, shape (3,) [m]."""
    c = math.cos(angle)
    s = math.sin(angle)
    for i in range(3):
        value = (c * feet[i, 0] - s * feet[i, 1]) * dx + (s * feet[i, 0] + c * feet[i, 1]) * dy
        slot = i
        while slot > 0 and places[slot - 1] < value:
            places[slot] = places[slot - 1]
            slot -= 1
        places[slot] = value


@kernel
def balance_curves(delta_feet, y_feet, theta, share, load_x, load_y, margin, curves, n):
    """Add the lines between which the centre of mass is inside either frame's feet; return how many curves there are then.

    Args:
        delta_feet, y_feet: Feet of the frames, each in its own frame, anticlockwise, shape (3, 2) [m].
        theta: Angle of the Y-frame in the Delta-frame [rad].
        share: Of the whole mass, at the Y-frame's origin; the rest is with the Delta-frame [-].
        load_x, load_y: The mass with the Delta-frame times its centre's place there, over the whole mass [m].
        margin: How far inside [m].
        curves: Shape (MOST_CURVES, CURVE_NUMBERS).
        n: Curves in use.
    """
    c = math.cos(theta)
    s = math.sin(theta)
    for i in range(3):
        j = (i + 1) % 3
        ex, ey = delta_feet[j, 0] - delta_feet[i, 0], delta_feet[j, 1] - delta_feet[i, 1]
        length = math.hypot(ex, ey)
        nx, ny = ey / length, -ex / length  # outwards
        spare = nx * (delta_feet[i, 0] - load_x) + ny * (delta_feet[i, 1] - load_y) - margin
        if share > 0.0:
            curves[n, 0], curves[n, 1], curves[n, 2], curves[n, 3] = BELOW, nx, ny, spare / share
            n += 1
        ex, ey = y_feet[j, 0] - y_feet[i, 0], y_feet[j, 1] - y_feet[i, 1]
        length = math.hypot(ex, ey)
        nx, ny = (c * ey + s * ex) / length, (s * ey - c * ex) / length
        foot_x, foot_y = c * y_feet[i, 0] - s * y_feet[i, 1], s * y_feet[i, 0] + c * y_feet[i, 1]
        spare = nx * (foot_x - load_x) + ny * (foot_y - load_y) - margin
        if share < 1.0:  # seen from the Y-frame's origin the mass is at lean - (1 - share) p
            curves[n, 0], curves[n, 1], curves[n, 2], curves[n, 3] = BELOW, -nx, -ny, spare / (1.0 - share)
            n += 1
    return n


@kernel
def widest(delta_feet, y_feet, low, high, seen, stack):
    """The widest ditch that slides cross, to FINE [m]; arguments as of `connects`."""
    least = 0.0
    most = high - low  # a foot goes over it in one slide, and no slide is longer
    if not connects(delta_feet, y_feet, 0.0, low, high, seen, stack):
        return 0.0
    if connects(delta_feet, y_feet, most, low, high, seen, stack):
        return most
    while most - least > FINE:
        middle = 0.5 * (least + most)
        if connects(delta_feet, y_feet, middle, low, high, seen, stack):
            least = middle
        else:
            most = middle
    return least


@kernel
def widest_map(
    delta, y, shortest, longest, guard, delta_feet, y_feet, share, load_x, load_y, margin, aside, thetas, directions, out,
    curves, arcs, areas, owners, room, seen, stack, places,
):  # fmt: skip
    """Write the widest ditch for each angle of the frames and each direction of crossing, shape (n_thetas, n_directions) [m].

    Args:
        delta, y, shortest, longest, guard: As of `reach_curves`.
        delta_feet, y_feet, share, load_x, load_y, margin: As of `balance_curves`.
        aside: Whether frames may also slide along the ditch; else they keep to the line along d through each other's origins.
        thetas: Angles of the Y-frame in the Delta-frame [rad], shape (n_thetas,).
        directions: Of crossing, in the Delta-frame [rad], shape (n_directions,).
        out: Written; 0 where the frames' origins may not be on each other.
        curves, arcs, areas, owners, room: As of `outline`.
        seen, stack: As of `connects`.
        places: Scratch, shape (2, 3).
    """
    for i in range(thetas.shape[0]):
        n = reach_curves(delta, y, thetas[i], shortest, longest, guard, curves)
        n = balance_curves(delta_feet, y_feet, thetas[i], share, load_x, load_y, margin, curves, n)
        count, loops = outline(curves, n, arcs, areas, owners, room)
        centre = owner_of(curves, n, arcs, count, loops, areas, 0.0, 0.0)
        for j in range(directions.shape[0]):
            out[i, j] = 0.0
            if centre < 0:
                continue
            dx = math.cos(directions[j])
            dy = math.sin(directions[j])
            places_along(delta_feet, 0.0, dx, dy, places[0])
            places_along(y_feet, thetas[i], dx, dy, places[1])
            if aside:
                high = extent(curves, arcs, count, owners, centre, dx, dy)
                low = -extent(curves, arcs, count, owners, centre, -dx, -dy)
            else:
                high = ray(curves, n, 0.0, 0.0, dx, dy)
                low = -ray(curves, n, 0.0, 0.0, -dx, -dy)
            out[i, j] = widest(places[0], places[1], low, high, seen, stack)
