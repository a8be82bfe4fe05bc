"""Inverse kinematics of a two-joint limb, as kernels: both branches, hook offset included; one arc cosine per branch, for the margin."""

import math

from ....compiled import inlined

SOLUTION = 11
"""Floats of one limb's solution: distance, then per branch joint margin, elbow x, y, grab direction x, y."""


@inlined
def off(c, s):
    """Size of the angle with this cosine and sine [rad], exact at either end."""
    if abs(c) < 0.7:
        return math.acos(c)
    lean = math.asin(min(1.0, abs(s)))
    return lean if c > 0.0 else math.pi - lean


@inlined
def solve_limb(limb, px, py, c_phi, s_phi, tip_x, tip_y, out):
    """Solve one limb for a tip place, both branches (page "The model", section 1).

    Args:
        limb: Record of the limb (`statics.records.LIMB`).
        px, py: Its port in the world [m].
        c_phi, s_phi: Cosine and sine of body angle plus port angle.
        tip_x, tip_y: Where its tip is, world [m].
        out: Row of `SOLUTION` floats: distance port to tip [m]; then per branch joint margin [rad], elbow x, y in the world [m], grab
            direction x, y in the world [-].
    """
    dx = tip_x - px
    dy = tip_y - py
    vx = c_phi * dx + s_phi * dy
    vy = c_phi * dy - s_phi * dx
    square = vx * vx + vy * vy
    l1 = limb.l1
    l2 = limb.l2
    c = (square - l1 * l1 - l2 * l2) * limb.per_product
    distance = math.sqrt(square)
    rho = distance  # the stretch that the joints can give: that of the tip, unless it is out of reach
    if c > 1.0:
        c = 1.0
        rho = l1 + l2
    elif c < -1.0:
        c = -1.0
        rho = abs(l1 - l2)
    s = math.sqrt(1.0 - c * c)
    out[0] = distance
    if distance > 0.0 and rho > 0.0:
        scale = 1.0 / (distance * rho)
        along = (l1 + l2 * c) * scale
        across = l2 * s * scale
    else:  # tip on port: the first link points anywhere
        vx = 1.0
        along = 1.0
        across = 0.0
    for branch in range(2):
        side = 1.0 if branch == 0 else -1.0
        ex = vx * along + side * vy * across  # direction of the first link, port frame
        ey = vy * along - side * vx * across
        bend = side * s
        wx = ex * c - ey * bend  # direction of the effective second link
        wy = ey * c + ex * bend
        gx = wx * limb.c_hook - wy * limb.s_hook
        gy = wy * limb.c_hook + wx * limb.s_hook
        # cosine and sine of each joint angle from the centre of its range: no angle is needed but for the margin
        c1 = ex * limb.c_centre1 + ey * limb.s_centre1
        s1 = ey * limb.c_centre1 - ex * limb.s_centre1
        c2 = c * limb.c_centre2 + bend * limb.s_centre2
        s2 = bend * limb.c_centre2 - c * limb.s_centre2
        at = 1 + 5 * branch
        if limb.half1 == limb.half2:
            out[at] = limb.half1 - (off(c1, s1) if c1 < c2 else off(c2, s2))
        else:
            out[at] = min(limb.half1 - off(c1, s1), limb.half2 - off(c2, s2))
        out[at + 1] = px + l1 * (c_phi * ex - s_phi * ey)
        out[at + 2] = py + l1 * (c_phi * ey + s_phi * ex)
        out[at + 3] = c_phi * gx - s_phi * gy
        out[at + 4] = c_phi * gy + s_phi * gx
