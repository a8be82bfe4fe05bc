r"""Virtual potential about the body that keeps free limbs away from it (Khatib 1986; Bevly 1997, 4.4.6). Kernels.

Khatib's repulsive field acts on the point of a limb's second link (elbow to tip) that is nearest to the body,

.. math:: F = F_0 (\rho_0 / \rho - 1) (\rho_0 / \rho)^2 \quad (\rho < \rho_0), \qquad \tau = J_P^T F

with rho the gap between the surfaces of link and body. The thesis prints neither the field nor its size. Chosen: the first link, which
begins at the body, is left out; the force is at most `most`, so that a limb that is inside is pushed out and not thrown; inside, where no
point is nearest, it acts along the line from the body's origin.
"""

import math

from ....compiled import kernel
from ....plane import inside
from .swing_path import foot_on

TOUCHING = 1e-9
"""Points nearer than this have no line between them [m]."""


@kernel
def repel_limbs(legs, q, free, corners, skin, field, torques, gaps):
    """Add the torques of the potential to those of the free limbs.

    Args:
        legs: Records of `PLANAR_LIMB`, shape (n,).
        q: Joint angles, shape (n, 2) [rad].
        free: 1 for limbs that the potential acts on, shape (n,).
        corners: Of the body, body frame, a convex polygon, shape (corners, 2) [m].
        skin: How far link and body together extend beyond segment and polygon [m].
        field: rho_0 [m], F_0 [N], most [N].
        torques: Added to, shape (n, 2) [N m].
        gaps: Filled with rho of the free limbs, infinity for others, shape (n,) [m]; negative where link and body overlap.
    """
    for i in range(legs.size):
        gaps[i] = math.inf
        if not free[i]:
            continue
        leg = legs[i]
        first = leg.port_angle + q[i, 0]
        second = first + q[i, 1] + leg.beta
        ex = leg.port_x + leg.l1 * math.cos(first)
        ey = leg.port_y + leg.l1 * math.sin(first)
        tx = ex + leg.l2 * math.cos(second)
        ty = ey + leg.l2 * math.sin(second)
        far, px, py, nx, ny = _nearest_points(ex, ey, tx, ty, corners)
        gap = far - skin
        gaps[i] = gap
        if gap >= field[0]:
            continue
        if far > TOUCHING:
            ux = (px - nx) / far
            uy = (py - ny) / far
        else:
            size = max(math.hypot(px, py), TOUCHING)
            ux = px / size
            uy = py / size
        force = field[2]
        if gap > 0.0:
            ratio = field[0] / gap
            force = min(force, field[1] * (ratio - 1.0) * ratio * ratio)
        fx = force * ux
        fy = force * uy
        torques[i, 0] += (px - leg.port_x) * fy - (py - leg.port_y) * fx
        torques[i, 1] += (px - ex) * fy - (py - ey) * fx


@kernel
def _nearest_points(ax, ay, bx, by, corners):
    """Distance of a segment from a convex polygon [m], 0 inside, and the nearest points of segment and polygon."""
    n = corners.shape[0]
    best = math.inf
    px = ax
    py = ay
    nx = ax
    ny = ay
    j = n - 1
    low = 1.0
    high = 0.0
    for i in range(n):
        cx = corners[j, 0]
        cy = corners[j, 1]
        dx = corners[i, 0]
        dy = corners[i, 1]
        for end in range(2):
            x = ax if end == 0 else bx
            y = ay if end == 0 else by
            fx, fy = foot_on(cx, cy, dx, dy, x, y)
            if math.hypot(x - fx, y - fy) < best:
                best = math.hypot(x - fx, y - fy)
                px = x
                py = y
                nx = fx
                ny = fy
        fx, fy = foot_on(ax, ay, bx, by, cx, cy)
        if math.hypot(fx - cx, fy - cy) < best:
            best = math.hypot(fx - cx, fy - cy)
            px = fx
            py = fy
            nx = cx
            ny = cy
        across = (bx - ax) * (dy - cy) - (by - ay) * (dx - cx)
        if across != 0.0:
            t = ((cx - ax) * (dy - cy) - (cy - ay) * (dx - cx)) / across
            s = ((cx - ax) * (by - ay) - (cy - ay) * (bx - ax)) / across
            if 0.0 <= t <= 1.0 and 0.0 <= s <= 1.0:
                low = min(low, t)
                high = max(high, t)
        j = i
    a_in = n > 2 and inside(ax, ay, corners)
    b_in = n > 2 and inside(bx, by, corners)
    if not a_in and not b_in and low > high:
        return best, px, py, nx, ny
    # inside: the middle of the part of the link that is in the body
    low = 0.0 if a_in else low
    high = 1.0 if b_in else high
    t = 0.5 * (low + high)
    x = ax + t * (bx - ax)
    y = ay + t * (by - ay)
    return 0.0, x, y, x, y
