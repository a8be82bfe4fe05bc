"""Can the holds take it: cuts on the force split and their margin (docs/model.md, section 8).

On one axis the margin of a set of cuts is found as the dual of its linear programme: over every pair of a cut that
bounds lambda from below and one that bounds it from above, the smallest half distance.
"""

import itertools
import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.optimize import linprog

from .carriers import Carrier, balance, general_split, placed, strength_of, strength_rows, torque_rows
from .kinematics import EPS, Option, Point

BIG = 1e6
"""Intervals of lambda are cut off at +-BIG [N]."""
MANY_WEIGHTS = 1e4
"""The margin of three or more carriers is capped at so many times the weight [-]."""
FREE = 1e9
"""Margin of what nothing restricts [N]."""
EXACT = {"primal_feasibility_tolerance": 1e-10, "dual_feasibility_tolerance": 1e-10}
"""As fine as HiGHS goes."""


@dataclass(frozen=True)
class Cut:
    """const + slope lambda >= 0."""

    const: float
    slope: float


def cones(limb: Any, hold: Any, grab_angle: float, hook_cone: float) -> list[tuple[float, float]]:
    """Direction and half angle [rad] of every cone that the force of tip on hold must lie in."""
    found: list[tuple[float, float]] = []
    if limb.end.kind != "gripper":
        found.append((grab_angle, hook_cone if limb.end.cone is None else limb.end.cone))
    if hold.direction is not None:
        found.append((hold.direction, math.pi / 2.0 if hold.cone is None else hold.cone))
    return found


def cone_cuts(carrier: Carrier, o: Option, hook_cone: float) -> list[Point]:
    """Rows c over (Fx, Fy) with c . F >= 0; F is the force of hold on limb, so each is a cone's normal negated."""
    rows: list[Point] = []
    for direction, half in cones(carrier.limb, carrier.hold, o.grab_angle, hook_cone):
        for side in (1.0, -1.0):
            normal = direction + side * (math.pi / 2.0 - half)
            rows.append((-math.cos(normal), -math.sin(normal)))
    return rows


def pull_row(carrier: Carrier, o: Option) -> Point | None:
    """Row c over (Fx, Fy) with c . F the pull along the grab direction [N]; None for an end that pulls any way."""
    if carrier.limb.end.kind == "gripper":
        return None
    return -math.cos(o.grab_angle), -math.sin(o.grab_angle)


def strength_sides(strength: float | None, const: Point, slope: Point) -> list[Cut]:
    """|const + slope lambda| <= strength as one cut from below and one from above, at the roots of the quadratic.

    Without real roots no lambda helps: then a constant, strength minus the least |F|.
    """
    if strength is None:
        return []
    a = slope[0] ** 2 + slope[1] ** 2
    b = 2.0 * (const[0] * slope[0] + const[1] * slope[1])
    c = const[0] ** 2 + const[1] ** 2 - strength**2
    nearest = -b / (2.0 * a)
    least = math.hypot(const[0] + nearest * slope[0], const[1] + nearest * slope[1])
    if least > strength:
        return [Cut(strength - least, 0.0)]
    low, high = sorted(float(x.real) for x in np.roots([a, b, c]))
    return [Cut(-low, 1.0), Cut(high, -1.0)]


def force_cuts(
    pair: tuple[Carrier, ...], options: tuple[Option, ...], split: Any, hook_cone: float, pull: float
) -> list[Cut]:
    """Cones of ends and holds, least pulls and strengths, as cuts along lambda; torque limits are not among them."""
    cuts: list[Cut] = []
    for carrier, o, (const, slope) in zip(pair, options, split, strict=True):
        for cx, cy in cone_cuts(carrier, o, hook_cone):
            cuts.append(Cut(cx * const[0] + cy * const[1], cx * slope[0] + cy * slope[1]))
        along = pull_row(carrier, o)
        if along is not None and pull > 0.0:
            still, per_lam = along[0] * const[0] + along[1] * const[1], along[0] * slope[0] + along[1] * slope[1]
            cuts.append(Cut(still - pull, per_lam))
        cuts.extend(strength_sides(strength_of(carrier.limb, carrier.hold), const, slope))
    return cuts


def signed_half_width(cuts: list[Cut]) -> float:
    """Half the width of the interval that the cuts leave, minus half the gap if none; at most the worst constant."""
    everything = [*cuts, Cut(BIG, 1.0), Cut(BIG, -1.0)]
    from_below = [-c.const / c.slope for c in everything if c.slope >= 1e-12]
    from_above = [-c.const / c.slope for c in everything if c.slope <= -1e-12]
    halves = [(high - low) / 2.0 for low, high in itertools.product(from_below, from_above)]
    broken = [c.const for c in cuts if abs(c.slope) < 1e-12 and c.const < -EPS]
    return min(halves + broken)


def lam_interval(cuts: list[Cut]) -> tuple[float, float] | None:
    """The lambdas that satisfy every cut [N], or None."""
    if signed_half_width(cuts) < -EPS:
        return None
    low = max([-BIG] + [-c.const / c.slope for c in cuts if c.slope >= 1e-12])
    high = min([BIG] + [-c.const / c.slope for c in cuts if c.slope <= -1e-12])
    return (low, high) if low <= high else ((low + high) / 2.0,) * 2


def pair_margins(
    a: Carrier, b: Carrier, weight: float, hook_cone: float, pull: float = 0.0
) -> dict[tuple[int, int], float]:
    """Margin [N] of two carriers for every combination of their branches."""
    split = general_split(a, b, weight)
    found: dict[tuple[int, int], float] = {}
    for combo in itertools.product(a.options, b.options):
        key = (combo[0].branch, combo[1].branch)
        if split is None:
            found[key] = -FREE
            continue
        cuts = force_cuts((a, b), combo, split, hook_cone, pull)
        for carrier, o, (const, slope) in zip((a, b), combo, split, strict=True):
            for row, limit in zip(torque_rows(carrier, o), carrier.limits, strict=True):
                still = limit * (row[0] * const[0] + row[1] * const[1])
                per_lam = limit * (row[0] * slope[0] + row[1] * slope[1])
                cuts += [Cut(limit - still, -per_lam), Cut(limit + still, per_lam)]
        found[key] = signed_half_width(cuts)
    return found


def hang_margins(carrier: Carrier, weight: float, turn: float, hook_cone: float, pull: float) -> dict[int, float]:
    """Margin [N] of the one carrier for every branch; `turn` is what the hang has just turned the robot by [rad]."""
    found: dict[int, float] = {}
    for o in carrier.options:
        terms = [FREE]
        ends = cones(carrier.limb, carrier.hold, o.grab_angle, hook_cone)
        on_hold = 1 if carrier.hold.direction is not None else 0
        for direction, half in ends[: len(ends) - on_hold]:
            for angle in (direction, direction - turn):
                terms.append(weight * (-math.sin(angle) - math.cos(half)))
                terms += [-weight * math.sin(angle) - pull] if pull > 0.0 else []
        for direction, half in ends[len(ends) - on_hold :]:
            terms.append(weight * (-math.sin(direction) - math.cos(half)))
        strength = strength_of(carrier.limb, carrier.hold)
        if strength is not None:
            terms.append(strength - weight)
        found[o.branch] = min(terms)
    return found


def many_margin(carriers: list[Carrier], options: list[Option], weight: float, hook_cone: float, pull: float) -> float:
    """The largest s [N] with every cone cut at s or more, pulls s above the least, torques and strengths met, in the given branches."""
    n = len(carriers)
    rows: list[list[float]] = []
    right: list[float] = []
    for i, (c, o) in enumerate(zip(carriers, options, strict=True)):
        for cut in cone_cuts(c, o, hook_cone):
            rows.append([-x for x in placed(cut, i, n)] + [1.0])
            right.append(0.0)
        along = pull_row(c, o)
        if along is not None and pull > 0.0:
            rows.append([-x for x in placed(along, i, n)] + [1.0])
            right.append(-pull)
        for row, sign in itertools.product(torque_rows(c, o), (1.0, -1.0)):
            rows.append([sign * x for x in placed(row, i, n)] + [0.0])
            right.append(1.0)
        normals, distance = strength_rows(strength_of(c.limb, c.hold))
        for normal in normals:
            rows.append([*placed(normal, i, n), 0.0])
            right.append(distance)
    A_eq, b_eq = balance(carriers, weight)
    answer = linprog(
        [0.0] * (2 * n) + [-1.0],
        A_ub=rows,
        b_ub=right,
        A_eq=[[*row, 0.0] for row in A_eq],
        b_eq=b_eq,
        bounds=[(None, None)] * (2 * n) + [(None, MANY_WEIGHTS * weight)],
        method="highs",
        options=EXACT,
    )
    return -FREE if answer.status != 0 else float(answer.x[-1])
