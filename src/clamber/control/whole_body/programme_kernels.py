"""Writing the programme of a tick, and reading torques off its solution."""

import math

from ...compiled import inlined, kernel, opened
from ..matrices import back_substitute, factor, solve_upper
from .programme import (
    ARM,
    BASE,
    BASE_RATE,
    ENDLESS,
    HOLDING,
    HOLDS,
    LIMIT_RATE,
    MOVING,
    POSTURE,
    POSTURE_RATE,
    REST_RATE,
    RESTING,
    SPEED_RATE,
    SWING,
    SWING_RATE,
    SWINGS,
    WRENCH,
)
from .tree import FREE

EQUATION, GIVES_WAY = 5, 8
"""What the solver calls such bounds."""
MET = 1e-6
"""A bound or row that is missed by no more is met, as it is for the solver [of its unit]."""
BORNE = 0.7
"""Part of a gear's friction that torques bear: less than the least that it may be, so that by this alone no joint moves [-]."""
SMALL = 1e-9
"""Of the diagonal, so that the programme is strictly convex whatever is asked for [-]."""


@inlined
def add_row(h, f, jacobian, row, wanted, weight):
    """Add `weight (row of the Jacobian . accelerations - wanted)^2 / 2`."""
    n = jacobian.shape[1]
    for i in range(n):
        left = weight * jacobian[row, i]
        if left == 0.0:
            continue
        f[i] -= left * wanted
        for j in range(n):
            h[i, j] += left * jacobian[row, j]


@inlined
def turn_between(r, d):
    """Half the sum of the cross products of two frames' axes: the sine of the angle from one to the other, about its axis."""
    ex, ey, ez = 0.0, 0.0, 0.0
    for c in range(3):
        ex += 0.5 * (r[1, c] * d[2, c] - r[2, c] * d[1, c])
        ey += 0.5 * (r[2, c] * d[0, c] - r[0, c] * d[2, c])
        ez += 0.5 * (r[0, c] * d[1, c] - r[1, c] * d[0, c])
    return ex, ey, ez


@kernel
def wanted_base(state, aims, rate, wanted):
    """Accelerations by which the base follows its aim, errors dying away without overshoot, into the first six of `wanted`."""
    for a in range(3):
        wanted[a] = aims.acceleration[a] + 2.0 * rate * (aims.velocity[a] - state.speed[a])
        wanted[a] += rate * rate * (aims.position[a] - state.position[a] + aims.base_integral[a])
    r, lasts = state.rotation, aims.base_integral
    ex, ey, ez = turn_between(r, aims.rotation)
    ex, ey, ez = ex + lasts[3], ey + lasts[4], ez + lasts[5]
    for a in range(3):
        w = r[0, a] * aims.velocity[3] + r[1, a] * aims.velocity[4] + r[2, a] * aims.velocity[5]
        turn = r[0, a] * aims.acceleration[3] + r[1, a] * aims.acceleration[4] + r[2, a] * aims.acceleration[5]
        turn += 2.0 * rate * (w - state.speed[3 + a])
        wanted[3 + a] = turn + rate * rate * (r[0, a] * ex + r[1, a] * ey + r[2, a] * ez)


@kernel
def base_tasks(state, aims, gains, h, f):
    """The base follows its aim; the first of all tasks."""
    wanted_base(state, aims, gains[BASE_RATE], f)
    for a in range(FREE):
        weight = gains[BASE] * (1.0 if a < 3 else gains[ARM] ** 2)
        h[a, a] += weight
        f[a] *= -weight


@kernel
def tip_tasks(dynamics, aims, gains, h, f):
    """Tips that swing follow their paths and point as they are to; those that hold on stay; others come to rest."""
    for limb in range(aims.does.size):
        jacobian, bias, speed = dynamics.jacobian[limb], dynamics.tip_bias[limb], dynamics.tip_speed[limb]
        does = aims.does[limb]
        if does == SWINGS:
            rate = min(gains[SWING_RATE], aims.tip_rate[limb])
            for a in range(3):
                wanted = aims.tip_acceleration[limb, a] - bias[a]
                wanted += rate * rate * (aims.tip[limb, a] - dynamics.tip[limb, a] + aims.tip_integral[limb, a])
                wanted += 2.0 * rate * (aims.tip_velocity[limb, a] - speed[a])
                add_row(h, f, jacobian, a, wanted, gains[SWING])
            point_tip(dynamics, aims, gains, limb, h, f)
        else:
            weight = gains[HOLDING] if does == HOLDS else gains[RESTING]
            for a in range(3):
                add_row(h, f, jacobian, a, -gains[REST_RATE] * speed[a] - bias[a], weight)
            if does == HOLDS and aims.components[limb] == 6:
                weight *= gains[ARM] ** 2
                for a in range(3, 6):
                    add_row(h, f, jacobian, a, -gains[REST_RATE] * speed[a] - bias[a], weight)


@kernel
def point_tip(dynamics, aims, gains, limb, h, f):
    """Turn a swinging end effector's z to where it is to point; turns about it are free."""
    d, lasts = aims.points[limb], aims.tip_integral[limb]
    if d[0] == 0.0 and d[1] == 0.0 and d[2] == 0.0:
        return
    rate, weight = min(gains[SWING_RATE], aims.tip_rate[limb]), gains[SWING] * gains[ARM] ** 2
    turn, jacobian = dynamics.tip_turn[limb], dynamics.jacobian[limb]
    bias, speed = dynamics.tip_bias[limb], dynamics.tip_speed[limb]
    z0, z1, z2 = turn[0, 2], turn[1, 2], turn[2, 2]
    ex, ey, ez = z1 * d[2] - z2 * d[1] + lasts[3], z2 * d[0] - z0 * d[2] + lasts[4], z0 * d[1] - z1 * d[0] + lasts[5]
    n = jacobian.shape[1]
    for axis in range(2):  # the end effector's x and y
        u0, u1, u2 = turn[0, axis], turn[1, axis], turn[2, axis]
        wanted = rate * rate * (u0 * ex + u1 * ey + u2 * ez)
        wanted -= 2.0 * rate * (u0 * speed[3] + u1 * speed[4] + u2 * speed[5])
        wanted -= u0 * bias[3] + u1 * bias[4] + u2 * bias[5]
        for i in range(n):
            left = weight * (u0 * jacobian[3, i] + u1 * jacobian[4, i] + u2 * jacobian[5, i])
            if left == 0.0:
                continue
            f[i] -= left * wanted
            for j in range(n):
                h[i, j] += left * (u0 * jacobian[3, j] + u1 * jacobian[4, j] + u2 * jacobian[5, j])


@kernel
def joint_tasks(tree, state, aims, limits, gains, programme, h):
    """Joints lean to their posture, and keep away from their limits of position and speed by bounds that give way."""
    f, lower, upper = programme.f, programme.lower, programme.upper
    rate = gains[POSTURE_RATE]
    for k in range(tree.rotor.size):
        i = FREE + k
        scale = 1.0 if tree.sliding[k + 1] else gains[ARM] ** 2
        weight = gains[POSTURE] * scale
        q, qd = state.joints[k], state.speed[i]
        h[i, i] += weight
        f[i] -= weight * rate * (rate * (aims.posture[k] - q) - 2.0 * qd)
        most = min(limits.speed[k], gains[LIMIT_RATE] * (limits.upper[k] - q))
        least = max(-limits.speed[k], gains[LIMIT_RATE] * (limits.lower[k] - q))
        lower[i] = gains[SPEED_RATE] * (min(least, 0.0) - qd)
        upper[i] = gains[SPEED_RATE] * (max(most, 0.0) - qd)


@kernel
def write_equations(tree, state, dynamics, aims, limits, gains, programme):
    """Write what of a tick's programme `solve_equations` takes: tasks, bounds of unknowns and the equations of motion.

    Of H, beside whose block of accelerations nothing but the diagonal counts, and of A all else is left to `write_rows`.

    Args:
        tree, state, dynamics, aims, limits: Records of these names, of one robot.
        gains: Of `Gains.packed`.
        programme: A `Programme`, filled.

    Returns:
        Number of unknowns and of rows.
    """
    nv = FREE + tree.rotor.size
    n, m = nv, nv
    for limb in range(aims.does.size):
        programme.at[limb] = -1
        if aims.does[limb] == HOLDS and aims.cap[limb] > 0.0:
            programme.at[limb] = n
            n += aims.components[limb]
            m += aims.n_rows[limb]
    h, a = programme.h[: n * n].reshape(n, n), programme.a[: m * n].reshape(m, n)
    f, lower, upper = programme.f, programme.lower, programme.upper
    for i in range(nv):
        f[i] = 0.0
        for j in range(nv):
            h[i, j] = 0.0
        lower[i], upper[i] = -ENDLESS, ENDLESS
    base_tasks(state, aims, gains, h, f)
    tip_tasks(dynamics, aims, gains, h, f)
    joint_tasks(tree, state, aims, limits, gains, programme, h)
    for i in range(nv):
        h[i, i] += SMALL
        for j in range(nv):
            a[i, j] = dynamics.mass[i, j]
        if i < FREE:
            lower[n + i] = upper[n + i] = -dynamics.bias[i]
        else:
            lower[n + i] = -limits.torque[i - FREE] - dynamics.bias[i]
            upper[n + i] = limits.torque[i - FREE] - dynamics.bias[i]
    for limb in range(aims.does.size):
        if programme.at[limb] >= 0:
            write_contact(dynamics, aims, gains, programme, limb, h, a)
    return n, m


@kernel
def write_contact(dynamics, aims, gains, programme, limb, h, a):
    """Unknowns and bounds of a contact that bears, and its part of the equations of motion."""
    nv = dynamics.bias.size
    at, frame, jacobian = programme.at[limb], aims.frame[limb], dynamics.jacobian[limb]
    per_mass = 1.0 / dynamics.mass[0, 0]
    for c in range(aims.components[limb]):
        arm = 1.0 if c < 3 else gains[ARM]
        first, axis = (0, c) if c < 3 else (3, c - 3)
        weight = gains[WRENCH] * (per_mass / arm) ** 2
        h[at + c, at + c] = weight + SMALL * per_mass**2
        programme.f[at + c] = -weight * aims.wrench[limb, c]
        most = arm * aims.cap[limb] if aims.cap[limb] < math.inf else ENDLESS
        programme.lower[at + c], programme.upper[at + c] = -most, most
        x, y, z = frame[axis, 0], frame[axis, 1], frame[axis, 2]
        for i in range(nv):
            a[i, at + c] = -(jacobian[first, i] * x + jacobian[first + 1, i] * y + jacobian[first + 2, i] * z)


@kernel
def write_rows(aims, programme, n, m, nv):
    """Write what `write_equations` has left of a programme: zeros of H, rows of the contacts' polytopes, kinds of all rows."""
    h, a, sense = programme.h[: n * n].reshape(n, n), programme.a[: m * n].reshape(m, n), programme.sense
    for i in range(n):
        for j in range(nv if i < nv else 0, n):
            if j != i:
                h[i, j] = 0.0
        sense[i] = GIVES_WAY if FREE <= i < nv else 0
    for r in range(m):
        sense[n + r] = EQUATION if r < FREE else 0
    row = nv
    for limb in range(aims.does.size):
        at = programme.at[limb]
        for k in range(aims.n_rows[limb] if at >= 0 else 0):
            for j in range(n):
                a[row, j] = 0.0
            for c in range(aims.components[limb]):
                a[row, at + c] = aims.rows[limb, k, c]
            programme.lower[n + row], programme.upper[n + row] = -ENDLESS, aims.limits[limb, k]
            row += 1


@kernel
def solve_equations(aims, programme, n, m, nv):
    """Solve a programme for its equations alone, into `programme.x`; whether that meets every bound and row, and so is the solution.

    At most moments nothing binds. H is that of the accelerations, then a diagonal; the equations are the first six rows of A x = b:

        x = -H^-1 (f + A^T l),    (A H^-1 A^T) l = -b - A H^-1 f

    With H = U^T U and the columns of A^T and f solved by U^T, Z = U^-T A^T and z = U^-T f, that is (Z^T Z) l = -b - Z^T z.
    """
    h, a, x = programme.h[: n * n].reshape(n, n), programme.a[: m * n].reshape(m, n), programme.x
    upper, z, square = programme.factor, programme.z, programme.square
    if not factor(h, nv, upper):
        return False
    for i in range(n):
        for r in range(FREE):
            z[i, r] = a[r, i]
        z[i, FREE] = programme.f[i]
    for k in range(nv):
        row = z[k]
        for r in range(FREE + 1):
            row[r] /= upper[k, k]
        for i in range(k + 1, nv):
            left, below = upper[k, i], z[i]
            for r in range(FREE + 1):
                below[r] -= left * row[r]
    for i in range(nv, n):
        root = math.sqrt(h[i, i])
        for r in range(FREE + 1):
            z[i, r] /= root
    square[:] = 0.0
    for i in range(n):
        row = z[i]
        for r in range(FREE + 1):
            sums = square[r]
            for c in range(FREE):
                sums[c] += row[r] * row[c]
    for r in range(FREE):
        square[FREE, r] = -programme.upper[n + r] - square[FREE, r]
    if not factor(square, FREE, square):
        return False
    multipliers = square[FREE]
    back_substitute(square, FREE, multipliers)
    for i in range(n):
        total = z[i, FREE]
        for r in range(FREE):
            total += multipliers[r] * z[i, r]
        x[i] = -total
    for i in range(nv, n):
        x[i] /= math.sqrt(h[i, i])
    solve_upper(upper, nv, x)
    return meets_all(aims, programme, a, n, nv)


@inlined
def meets(row, x, first, lower, upper):
    """Whether a row times what begins at `first` in `x` is within bounds."""
    total = 0.0
    for i in range(row.size):
        total += row[i] * x[first + i]
    return lower - MET <= total <= upper + MET


@kernel
def meets_all(aims, programme, a, n, nv):
    """Whether `programme.x` meets every bound, every equation of `a` and every row of the contacts' polytopes."""
    x, lower, upper = programme.x, programme.lower, programme.upper
    for i in range(n):
        if not lower[i] - MET <= x[i] <= upper[i] + MET:
            return False
    for r in range(nv):
        if not meets(a[r], x, 0, lower[n + r], upper[n + r]):
            return False
    for limb in range(aims.does.size):
        at, c = programme.at[limb], aims.components[limb]
        for k in range(aims.n_rows[limb] if at >= 0 else 0):
            if not meets(aims.rows[limb, k, :c], x, at, -ENDLESS, aims.limits[limb, k]):
                return False
    return True


@kernel
def write_and_solve(handle):
    """Read a tick's torques off the equations alone or, where something binds, write its whole programme.

    Args:
        handle: Holds what `write_equations` takes, and torques and wrenches, filled where nothing binds.

    Returns:
        Number of unknowns, of rows, and whether the torques are there.
    """
    tree, state, dynamics, aims, limits, gains, programme = opened(handle)[:7]
    nv = FREE + tree.rotor.size
    n, m = write_equations(tree, state, dynamics, aims, limits, gains, programme)
    solved = solve_equations(aims, programme, n, m, nv)
    if solved:
        read_solution(handle, m, programme.x[:n])
    else:
        write_rows(aims, programme, n, m, nv)
    return n, m, solved


@kernel
def read_solution(handle, m, x):
    """`read_torques` of what the handle of `write_and_solve` holds, from a programme of so many rows and its solution."""
    tree, state, dynamics, aims, limits, gains, programme, torques, wrenches = opened(handle)
    read_torques(dynamics, aims, limits, programme, programme.a[: m * x.size].reshape(m, x.size), x, torques, wrenches)
    bear_friction(tree, state, limits, gains, x, torques)


@kernel
def bear_friction(tree, state, limits, gains, accelerations, torques):
    """Add what gears take by their friction, as joints move and are about to, within the motors' limits; `accelerations` are asked for."""
    for k in range(torques.size):
        ahead = state.speed[FREE + k] + accelerations[FREE + k] / gains[SPEED_RATE]
        slow = gains[MOVING] * (gains[ARM] if tree.sliding[k + 1] else 1.0)
        total = torques[k] + BORNE * limits.friction[k] * min(1.0, max(-1.0, ahead / slow))
        torques[k] = min(limits.torque[k], max(-limits.torque[k], total))


@kernel
def read_torques(dynamics, aims, limits, programme, a, x, torques, wrenches):
    """Torques that the solution `x` takes, within the motors' limits, and its wrenches; `a` is the programme's matrix."""
    for limb in range(wrenches.shape[0]):
        for c in range(6):
            bears = programme.at[limb] >= 0 and c < aims.components[limb]
            wrenches[limb, c] = x[programme.at[limb] + c] if bears else 0.0
    for k in range(torques.size):
        total = dynamics.bias[FREE + k]
        for j in range(a.shape[1]):
            total += a[FREE + k, j] * x[j]
        torques[k] = min(limits.torque[k], max(-limits.torque[k], total))


@kernel
def hold_torques(dynamics, aims, limits, damping, state, torques):
    """Torques that hold the robot by the wrenches that are wanted, with damping [N m s]: what is left where no programme can be solved."""
    for k in range(torques.size):
        i = FREE + k
        total = dynamics.weight[i] - damping * state.speed[i]
        for limb in range(aims.does.size):
            if aims.does[limb] != HOLDS:
                continue
            for c in range(aims.components[limb]):
                first, axis = (0, c) if c < 3 else (3, c - 3)
                for b in range(3):
                    total -= dynamics.jacobian[limb, first + b, i] * aims.frame[limb, axis, b] * aims.wrench[limb, c]
        torques[k] = min(limits.torque[k], max(-limits.torque[k], total))
