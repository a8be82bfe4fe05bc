"""How the holds share the weight, and the joint torques that follow (docs/model.md, section 7).

Two carriers under `min_torque` are a linear programme in (lambda, s) given to HiGHS, under `min_norm` one least
squares problem; three or more are a programme in all force components. No breakpoint is searched for by hand.
"""

import itertools
import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.optimize import linprog

from .carriers import (
    Carrier,
    balance,
    best_option,
    general_split,
    placed,
    strength_of,
    strength_rows,
    torque_rows,
    torques,
)
from .hook import BIG, EXACT, cone_cuts, force_cuts, lam_interval, pull_row
from .kinematics import Option, Point

BETTER = 1e-7
"""By how much a split of three or more must be better for other branches to be taken, in units of the limits or of the weight."""
NO_SPLIT_TORQUE = 1e6
"""What every joint counts when no force split exists [N m]."""


def is_push_pull(a: Carrier, b: Carrier, robot: Any) -> bool:
    """Whether the thesis would let both forces pass through the centre of gravity."""
    names = {a.limb.name, b.limb.name}
    opposed = any(set(pair) == names for pair in robot.opposed)
    return not (opposed or a.r[0] * b.r[0] < 0.0)


def thesis_split(a: Carrier, b: Carrier, robot: Any) -> list[Point] | None:
    W, (ax, ay), (bx, by) = robot.weight, a.r, b.r
    if abs(ax) < 1e-9 and abs(bx) < 1e-9:
        return [(0.0, W / 2.0), (0.0, W / 2.0)]
    if not is_push_pull(a, b, robot) and abs(ax - bx) >= 1e-9:
        return [(0.0, -W * bx / (ax - bx)), (0.0, W * ax / (ax - bx))]
    D = ax * by - bx * ay  # also for opposed limbs on one vertical line beside the centre
    if abs(D) < 1e-12:
        return None
    A, B = -W * bx / D, W * ax / D
    return [(A * ax, A * ay), (B * bx, B * by)]


@dataclass(frozen=True)
class Load:
    """How carriers share the weight."""

    forces: list[Point] | None
    """Of each hold on its limb [N], world; None when no split exists."""
    options: list[Option]
    """The branches that go with it; none: each limb takes the one that is best for its force."""
    value: float = 0.0
    """What was made least over the branches."""
    met: bool = True
    """Whether the cuts of ends and holds are met, or not asked for."""


def two_carrier_split(a: Carrier, b: Carrier, task: Any, norm: bool) -> Load:
    """Least torque (or least norm) over branches and lambda, within the cuts if they can be met; and the branches."""
    split = general_split(a, b, task.robot.weight)
    if split is None:
        return Load(None, [], math.inf, False)
    combos = list(itertools.product(a.options, b.options))
    windows = [
        lam_interval(force_cuts((a, b), combo, split, task.rules.hook_cone, task.rules.hook_pull)) for combo in combos
    ]
    kept = [(combo, w) for combo, w in zip(combos, windows, strict=True) if w is not None]
    met = bool(kept)
    if not kept:
        kept = [(combo, (-BIG, BIG)) for combo in combos]
    best, best_lam, taken = math.inf, 0.0, kept[0][0]
    for combo, (low, high) in kept:
        const: list[float] = []
        slope: list[float] = []
        for carrier, o, (c, s) in zip((a, b), combo, split, strict=True):
            for row in torque_rows(carrier, o):
                const.append(row[0] * c[0] + row[1] * c[1])
                slope.append(row[0] * s[0] + row[1] * s[1])
        lam = least_norm_lam(const, slope) if norm else least_largest_lam(const, slope, low, high)
        lam = max(low, min(high, lam))
        ratios = [c + s * lam for c, s in zip(const, slope, strict=True)]
        cost = sum(x * x for x in ratios) if norm else max(abs(x) for x in ratios)
        if cost < best - 1e-9:
            best, best_lam, taken = cost, lam, combo
    forces = [(c[0] + best_lam * s[0], c[1] + best_lam * s[1]) for c, s in split]
    return Load(forces, list(taken), best, met)


def least_norm_lam(const: list[float], slope: list[float]) -> float:
    solution = np.linalg.lstsq(np.array(slope)[:, None], -np.array(const), rcond=None)[0]
    return float(solution[0])


def least_largest_lam(const: list[float], slope: list[float], low: float, high: float) -> float:
    """Minimise s subject to |const + slope lam| <= s and low <= lam <= high."""
    rows = [[sign * s, -1.0] for s in slope for sign in (1.0, -1.0)]
    bounds = [-sign * c for c in const for sign in (1.0, -1.0)]
    answer = linprog(
        [0.0, 1.0], A_ub=rows, b_ub=bounds, bounds=[(low, high), (0.0, None)], method="highs", options=EXACT
    )
    assert answer.status == 0, answer.message
    return float(answer.x[0])


def many_carrier_split(
    carriers: list[Carrier], options: list[Option], task: Any, *, within: bool
) -> list[Point] | None:
    """Three or more carriers in given branches, within the cuts or without them (under `min_norm` there are none)."""
    n = len(carriers)
    A_eq, b_eq = balance(carriers, task.robot.weight)
    torque = [
        placed(row, i, n) for i, (c, o) in enumerate(zip(carriers, options, strict=True)) for row in torque_rows(c, o)
    ]
    if task.rules.force_rule == "min_norm":
        return in_pairs(least_squares_split(torque, A_eq, b_eq))
    cuts: list[list[float]] = []  # cuts . F <= right
    right: list[float] = []
    for i, (c, o) in enumerate(zip(carriers, options, strict=True)):
        for cut in cone_cuts(c, o, task.rules.hook_cone):
            cuts.append([-x for x in placed(cut, i, n)])
            right.append(0.0)
        along = pull_row(c, o)
        if along is not None and task.rules.hook_pull > 0.0:
            cuts.append([-x for x in placed(along, i, n)])
            right.append(-task.rules.hook_pull)
        normals, distance = strength_rows(strength_of(c.limb, c.hold))
        for normal in normals:
            cuts.append(placed(normal, i, n))
            right.append(distance)
    return in_pairs(least_largest_split(torque, A_eq, b_eq, cuts if within else [], right if within else []))


def best_many_split(carriers: list[Carrier], task: Any) -> Load:
    """Three or more carriers over all branches, those that are best at equal shares first; the cuts hold if they can be met."""
    norm = task.rules.force_rule == "min_norm"
    share = (0.0, task.robot.weight / len(carriers))
    ordered = []
    for c in carriers:
        first = best_option([(o, torques(c, o, share)) for o in c.options])
        ordered.append([first, *(o for o in c.options if o is not first)])
    for cut in (True, False):
        best = Load(None, [], math.inf, cut)
        for combo in itertools.product(*ordered):
            forces = many_carrier_split(carriers, list(combo), task, within=cut)
            if forces is None:
                continue
            ratios = [
                t / limit
                for c, o, f in zip(carriers, combo, forces, strict=True)
                for t, limit in zip(torques(c, o, f), c.limits, strict=True)
            ]
            value = sum(x * x for x in ratios) if norm else max(abs(x) for x in ratios)
            if value < best.value - BETTER:
                best = Load(forces, list(combo), value, cut)
        if best.forces is not None or norm:
            return best
    return best


def in_pairs(flat: list[float] | None) -> list[Point] | None:
    return None if flat is None else list(zip(flat[::2], flat[1::2], strict=True))


def least_largest_split(
    torque: list[list[float]], A_eq: list[list[float]], b_eq: list[float], cuts: list[list[float]], right: list[float]
) -> list[float] | None:
    width = len(A_eq[0])
    rows = [[sign * x for x in row] + [-1.0] for row in torque for sign in (1.0, -1.0)]
    rows += [[*cut, 0.0] for cut in cuts]
    answer = linprog(
        [0.0] * width + [1.0],
        A_ub=rows,
        b_ub=[0.0] * (2 * len(torque)) + right,
        A_eq=[[*row, 0.0] for row in A_eq],
        b_eq=b_eq,
        bounds=[(None, None)] * width + [(0.0, None)],
        method="highs",
        options=EXACT,
    )
    return None if answer.status != 0 else [float(x) for x in answer.x[:width]]


def least_squares_split(torque: list[list[float]], A_eq: list[list[float]], b_eq: list[float]) -> list[float] | None:
    """Least |torque F|^2 on the balance."""
    E, e, T = np.array(A_eq), np.array(b_eq), np.array(torque)
    F0 = np.linalg.lstsq(E, e, rcond=None)[0]
    if not np.allclose(E @ F0, e, atol=1e-9):
        return None
    null = np.linalg.svd(E)[2][np.linalg.matrix_rank(E) :].T
    z0 = np.linalg.lstsq(T @ null, -T @ F0, rcond=None)[0]
    return [float(x) for x in F0 + null @ z0]


def shared_load(carriers: list[Carrier], task: Any) -> Load:
    """How the carriers share the weight, by the task's rule."""
    W = task.robot.weight
    if len(carriers) == 1:
        return Load([(0.0, W)], [])
    if len(carriers) == 2:
        a, b = carriers
        if task.rules.force_rule == "thesis":
            return Load(thesis_split(a, b, task.robot), [])
        return two_carrier_split(a, b, task, norm=task.rules.force_rule == "min_norm")
    return best_many_split(carriers, task)


def split_forces(carriers: list[Carrier], task: Any) -> list[Point] | None:
    """Force of each hold on its limb [N], world; None when no split exists."""
    return shared_load(carriers, task).forces
