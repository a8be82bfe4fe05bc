"""How two carriers share the weight: the thesis's two rules, and the general split with its one free number (page "The model", 7)."""

import math

from ....compiled import inlined, kernel
from ....planning.problem.check import TOLERANCE

NO_SPLIT = 1.0e6
"""Torque that stands for "no such split exists" [N m]."""
FAR = 1.0e6
"""Where intervals of the internal force are cut off [N]."""


@inlined
def thesis_split(weight, opposed, rax, ray, rbx, rby):
    """Forces of two holds on the robot by the thesis's rules (2.9 to 2.13 in their right form; 2.14 to 2.16 without the division).

    Args:
        weight: Weight W [N].
        opposed: Whether the robot names the two limbs as one on each side, whatever their holds.
        rax, ray, rbx, rby: Holds from the body's origin, world axes [m].

    Returns:
        Whether a split exists, whether it is push-pull, and fax, fay, fbx, fby [N].
    """
    push_pull = not (opposed or rax * rbx < 0.0)
    span = rax - rbx
    if not push_pull and abs(span) >= 1e-9:
        return True, False, 0.0, -weight * rbx / span, 0.0, weight * rax / span
    if abs(rax) < 1e-9 and abs(rbx) < 1e-9:
        return True, push_pull, 0.0, 0.5 * weight, 0.0, 0.5 * weight
    # opposed limbs on one vertical line beside the centre: vertical forces can't balance the moment either
    cross = rax * rby - rbx * ray
    if abs(cross) >= 1e-12:
        a = -weight * rbx / cross
        b = weight * rax / cross
        return True, True, a * rax, a * ray, b * rbx, b * rby
    return False, push_pull, 0.0, 0.0, 0.0, 0.0


@kernel
def general_split(weight, pax, pay, pbx, pby, cx, out):
    """Every split over two holds: force = out[0:2] + lam out[2:4] at the first, out[4:6] + lam out[6:8] at the second [N].

    `lam` is the internal force along the line between the holds; the rest is fixed by balance. Returns False if the holds coincide.
    """
    dx = pbx - pax
    dy = pby - pay
    d = math.sqrt(dx * dx + dy * dy)
    if d < 1e-9:
        return False
    ux = dx / d
    uy = dy / d
    fa = weight * (pbx - cx) / d
    half = 0.5 * weight * uy
    out[0] = -fa * uy + half * ux
    out[1] = fa * ux + half * uy
    out[2] = ux
    out[3] = uy
    fb = weight * ux - fa
    out[4] = -fb * uy + half * ux
    out[5] = fb * ux + half * uy
    out[6] = -ux
    out[7] = -uy
    return True


@inlined
def cut(lo, hi, flat, c0, c1):
    """Intersect the interval [lo, hi] of lam with c0 + c1 lam >= 0; `flat` keeps the worst constant cut that is violated."""
    if abs(c1) < 1e-12:
        if c0 < -TOLERANCE:
            flat = min(flat, c0)
    elif c1 > 0.0:
        lo = max(lo, -c0 / c1)
    else:
        hi = min(hi, -c0 / c1)
    return lo, hi, flat


@kernel
def cut_cone(lo, hi, flat, mx, my, c_cone, s_cone, f):
    """Keep the lam for which the force on the hold, -F, lies within a cone about (mx, my); f is F's constant and slope (4 floats)."""
    for side in range(2):
        turn = c_cone if side == 0 else -c_cone  # rot(m, +-(pi/2 - a)): cosine s_cone, sine +-c_cone
        nx = mx * s_cone - my * turn
        ny = my * s_cone + mx * turn
        lo, hi, flat = cut(lo, hi, flat, -(nx * f[0] + ny * f[1]), -(nx * f[2] + ny * f[3]))
    return lo, hi, flat


@kernel
def cut_strength(lo, hi, flat, strength, f):
    """Keep the lam for which |F| <= strength."""
    along = f[0] * f[2] + f[1] * f[3]
    square = f[0] * f[0] + f[1] * f[1] - strength * strength
    root = along * along - square  # the slope is a unit vector
    if root < 0.0:
        least = math.sqrt(max(f[0] * f[0] + f[1] * f[1] - along * along, 0.0))
        return lo, hi, min(flat, strength - least)
    root = math.sqrt(root)
    return max(lo, -along - root), min(hi, -along + root), flat
