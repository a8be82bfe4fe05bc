"""Tasks met one after the other in the null space of those before, and wrenches shared among contacts; for laws without a programme."""

import math

from ....compiled import inlined, kernel, opened
from ....control.kinematics import column, cross, dot, keep_three, less, plus, scaled, three
from ....control.whole_body.programme import ARM, BASE_RATE, HOLDS, INTEGRAL, SWING_RATE, SWINGS
from ....control.whole_body.programme_kernels import turn_between
from ....control.whole_body.tree import FREE
from ....control.whole_body.tree_kernels import work_out

NEAR = 0.03
"""A task of which less than this is left by those before it is met with damping, ever less the less is left [-]."""
NOTHING = 1e-4
"""Less than this is nothing [-]."""
RIDGE = 1e-10
"""Of the base's equations, so that contacts on one line can be shared among, too [-]."""
SLACK = 0.002
"""Errors that are not added up, per arm or [rad]: gears that stick would hunt about what is smaller."""
MOST = 0.03
"""What errors add up to at most, likewise: twice what gears made the base miss that rub most for its weight."""
REACTION = 0.0075
"""From a reading to the torque that answers it [s]: 5 ms of delay, as motors on a bus have, and a control period."""
STEADY = 0.4 * math.pi
"""Of a joint's damping, how many times heavier what it moves is than its rotor, and `REACTION`; gears rattle from pi / 2 on [-]."""
LEARNT = 0.5
"""Time constant with which the robot learns by its tips where its centre of mass is [s]."""
FELT = 0.25
"""Square of what all tips feel, over the weight's, from which on they tell of balance [-]."""
FARTHEST = 0.05
"""From where it believes it to be, of an arm, that it may be [-]: several times what links make that weigh a tenth more or less."""
LEAST_RATE = 7.0
"""At which errors of a swinging tip die away whatever its gears [1/s]: more slowly, what is left of their friction would keep it."""


@inlined
def meet(basis, count, row, wanted, y):
    """Change `y` so that `row . y` becomes `wanted`, across the directions of `basis`, of which it becomes one; returns their number.

    Damping near what is left of nothing is that of Maciejewski and Klein (1988): it begins at `NEAR`.
    """
    n, whole, value = row.size, 0.0, wanted
    for i in range(n):
        whole += row[i] * row[i]
        value -= row[i] * y[i]
    for k in range(count):
        along = 0.0
        for i in range(n):
            along += basis[k, i] * row[i]
        for i in range(n):
            row[i] -= along * basis[k, i]
    rest = 0.0
    for i in range(n):
        rest += row[i] * row[i]
    if count == basis.shape[0] or rest <= NOTHING * NOTHING * whole:
        return count
    damping = max(0.0, NEAR * NEAR * whole - rest)
    length = math.sqrt(rest)
    for i in range(n):
        basis[count, i] = row[i] / length
        y[i] += basis[count, i] * value * length / (rest + damping)
    return count + 1


@inlined
def tip_error(dynamics, aims, gains, limb, a):
    """Acceleration by which a swinging tip follows its path along a world axis, its bias taken off [m/s^2]."""
    rate = min(gains[SWING_RATE], aims.tip_rate[limb])
    wanted = aims.tip_acceleration[limb, a]
    wanted += rate * rate * (aims.tip[limb, a] - dynamics.tip[limb, a] + aims.tip_integral[limb, a])
    return wanted + 2.0 * rate * (aims.tip_velocity[limb, a] - dynamics.tip_speed[limb, a])


@inlined
def points(aims, limb):
    """Whether an end effector is to point somewhere."""
    d = aims.points[limb]
    return d[0] != 0.0 or d[1] != 0.0 or d[2] != 0.0


@inlined
def turn_error(dynamics, aims, limb, axis):
    """Sine of the angle about the end effector's x or y (`axis` 0 or 1) by which its z misses where it is to point [-]."""
    turn, d = dynamics.tip_turn[limb], aims.points[limb]
    ex = turn[1, 2] * d[2] - turn[2, 2] * d[1]
    ey = turn[2, 2] * d[0] - turn[0, 2] * d[2]
    ez = turn[0, 2] * d[1] - turn[1, 2] * d[0]
    return turn[0, axis] * ex + turn[1, axis] * ey + turn[2, axis] * ez


@inlined
def turn_wanted(dynamics, aims, gains, limb, axis):
    """Angular acceleration about the end effector's x or y by which it turns to where it is to point [rad/s^2]."""
    rate, error = min(gains[SWING_RATE], aims.tip_rate[limb]), turn_error(dynamics, aims, limb, axis)
    error += about(dynamics, limb, axis, aims.tip_integral[limb])
    return rate * (rate * error - 2.0 * about(dynamics, limb, axis, dynamics.tip_speed[limb]))


@inlined
def turn_row(dynamics, limb, axis, row):
    """Angular velocity of an end effector about its x or y by generalised speeds, into `row`."""
    turn, jacobian = dynamics.tip_turn[limb], dynamics.jacobian[limb]
    for i in range(row.size):
        row[i] = turn[0, axis] * jacobian[3, i] + turn[1, axis] * jacobian[4, i] + turn[2, axis] * jacobian[5, i]


@inlined
def about(dynamics, limb, axis, motion):
    """Component of an angular motion (from 3 on) of a tip about its end effector's x or y."""
    turn = dynamics.tip_turn[limb]
    return turn[0, axis] * motion[3] + turn[1, axis] * motion[4] + turn[2, axis] * motion[5]


@kernel
def share_wrenches(dynamics, aims, gains, room, gravity):
    """Wrenches of the contacts, nearest to the wanted ones, that bear the first six of `room.forces`; whether any contact bears.

    Weighted least squares: moments count per arm, and a contact whose cap is below the robot's weight takes the less of what is shared.
    The choice among the wrenches that balance is free (Righetti et al. 2013); no contact's limits are looked at.
    """
    balance, columns, wrenches, arm = room.balance, room.columns, room.wrenches, gains[ARM]
    weight = dynamics.mass[0, 0] * gravity
    for a in range(FREE):
        for b in range(FREE):
            balance[a, b] = 0.0
        balance[a, FREE] = room.forces[a]
    some = False
    for turned in range(2):  # first the equations, then the wrenches
        for limb in range(aims.does.size):
            if turned == 0:
                for c in range(6):
                    holds = aims.does[limb] == HOLDS and c < aims.components[limb]
                    wrenches[limb, c] = aims.wrench[limb, c] if holds else 0.0
            if aims.does[limb] != HOLDS or aims.cap[limb] <= 0.0:
                continue
            some = True
            jacobian, frame = dynamics.jacobian[limb], aims.frame[limb]
            part = min(1.0, aims.cap[limb] / weight)
            for c in range(aims.components[limb]):
                first, axis = (0, c) if c < 3 else (3, c - 3)
                one = part * part * (1.0 if c < 3 else arm * arm)
                column = columns[c]
                for a in range(FREE):
                    column[a] = 0.0
                    for b in range(3):
                        column[a] += jacobian[first + b, a] * frame[axis, b]
                if turned == 0:
                    for a in range(FREE):
                        balance[a, FREE] -= column[a] * aims.wrench[limb, c]
                        for b in range(FREE):
                            balance[a, b] += one * column[a] * column[b]
                else:
                    for a in range(FREE):
                        wrenches[limb, c] += one * column[a] * balance[a, FREE]
        if turned == 0:
            for a in range(FREE):
                balance[a, a] += RIDGE * (1.0 if a < 3 else arm * arm)
            solve_balance(balance)
    return some


@kernel
def solve_balance(balance):
    """The six equations of `Room.balance`, whose matrix is symmetric and positive; the solution takes the place of the right side."""
    for i in range(FREE):
        for j in range(i + 1):
            total = balance[i, j]
            for k in range(j):
                total -= balance[i, k] * balance[j, k]
            balance[i, j] = math.sqrt(max(total, 1e-300)) if i == j else total / balance[j, j]
    for i in range(FREE):
        for j in range(i):
            balance[i, FREE] -= balance[i, j] * balance[j, FREE]
        balance[i, FREE] /= balance[i, i]
    for i in range(FREE - 1, -1, -1):
        for j in range(i + 1, FREE):
            balance[i, FREE] -= balance[j, i] * balance[j, FREE]
        balance[i, FREE] /= balance[i, i]


@kernel
def bear(dynamics, aims, limits, room):
    """Torques that are left of `room.forces` when contacts bear `room.wrenches`, within the motors' limits."""
    for limb in range(aims.does.size):
        if aims.does[limb] != HOLDS:
            continue
        jacobian, frame = dynamics.jacobian[limb], aims.frame[limb]
        for c in range(aims.components[limb]):
            first, axis = (0, c) if c < 3 else (3, c - 3)
            for b in range(3):
                force = frame[axis, b] * room.wrenches[limb, c]
                for i in range(FREE, room.forces.size):
                    room.forces[i] -= jacobian[first + b, i] * force
    for k in range(room.torques.size):
        room.torques[k] = min(limits.torque[k], max(-limits.torque[k], room.forces[FREE + k]))


@kernel
def largest_share(torques, limits):
    """The largest part of its limit that any joint is driven with [-]."""
    most = 0.0
    for k in range(torques.size):
        most = max(most, abs(torques[k]) / limits[k])
    return most


@inlined
def turned(axes, vector):
    """A vector in the frame of some axes, in the world frame."""
    return dot(axes[0], vector), dot(axes[1], vector), dot(axes[2], vector)


@inlined
def add_up(integral, at, error, share, arm):
    """Add a share of an error vector, less its slack, to three components of an integral from `at` on."""
    length = math.sqrt(error[0] ** 2 + error[1] ** 2 + error[2] ** 2)
    share *= max(0.0, 1.0 - SLACK * arm / length) if length > 0.0 else 0.0
    total = 0.0
    for a in range(3):
        integral[at + a] += share * error[a]
        total += integral[at + a] ** 2
    if total > (MOST * arm) ** 2:
        for a in range(3):
            integral[at + a] *= MOST * arm / math.sqrt(total)


@inlined
def steady_rate(tree, dynamics, limb):
    """Largest rate at which errors of a limb's tip may die away without a rattle of its gears [1/s].

    In the play of its gear a motor turns its rotor alone, with torques that are meant for all that its joint moves, r times as heavy.
    Of a joint with damping d the rotor then follows v' = -r d v(t - T), T late, which is steady up to r d T = pi / 2.
    """
    heavier, body = 1.0, tree.end[limb]
    while body > 0:
        i, rotor = FREE + body - 1, tree.rotor[body - 1]
        if rotor > 0.0:
            heavier = max(heavier, dynamics.mass[i, i] / rotor)
        body = tree.parent[body]
    # errors that die away without overshoot are damped by twice the rate
    return max(LEAST_RATE, 0.5 * STEADY / (heavier * REACTION))


@kernel
def steady_errors(state, aims, rest):
    """Let errors of the base and of swinging tips add up, for friction and weights that nobody knows make them last.

    Those of the base wait while a motor gives all it can: more could not be given, and would be too much once it can.

    Args:
        state: Of the robot.
        aims: The law's, in place.
        rest: Tree, dynamics, gains, the control period [s], torques of the tick before, and the motors' largest ones first.
    """
    tree, dynamics, gains, period, torques, most = rest[:6]
    share, arm = period * gains[INTEGRAL] * gains[BASE_RATE], gains[ARM]
    p, q, integral = state.position, aims.position, aims.base_integral
    if largest_share(torques, most) < 1.0:
        add_up(integral, 0, (q[0] - p[0], q[1] - p[1], q[2] - p[2]), share, arm)
        add_up(integral, 3, turn_between(state.rotation, aims.rotation), share, 1.0)
    for limb in range(aims.does.size):
        integral = aims.tip_integral[limb]
        if aims.does[limb] != SWINGS:
            for a in range(6):
                integral[a] = 0.0
            continue
        aims.tip_rate[limb] = steady_rate(tree, dynamics, limb)
        share = period * gains[INTEGRAL] * min(gains[SWING_RATE], aims.tip_rate[limb])
        p, q = dynamics.tip[limb], aims.tip[limb]
        add_up(integral, 0, (q[0] - p[0], q[1] - p[1], q[2] - p[2]), share, arm)
        if points(aims, limb):
            d, turn = aims.points[limb], dynamics.tip_turn[limb]
            x, y, z = turn[0, 2], turn[1, 2], turn[2, 2]
            add_up(integral, 3, (y * d[2] - z * d[1], z * d[0] - x * d[2], x * d[1] - y * d[0]), share, 1.0)


@kernel
def feel_balance(sensed, aims, state, limbs, rest):
    """Learn by what tips feel where the centre of mass truly is, while the body is to stay where it is; along the weight nobody feels it.

    At rest the tips' moments about the base's origin are those of all that they bear at the centre of mass.

    Args:
        sensed: The readings.
        aims: The law's.
        state: Of the robot.
        limbs: `limbed_body.Limbs`; `lean` is changed.
        rest: As in `steady_errors`.
    """
    _, dynamics, gains, period = rest[:4]
    for a in range(6):
        if aims.velocity[a] != 0.0:
            return
    force, moment = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
    for limb in range(limbs.holds.size):
        wrench, axes = sensed.wrenches[limb], dynamics.tip_turn[limb]
        push = turned(axes, three(wrench, 0))
        force = plus(force, push)
        lever = less(three(dynamics.tip[limb], 0), three(state.position, 0))
        moment = plus(moment, plus(turned(axes, three(wrench, 3)), cross(lever, push)))
    weight, square = three(dynamics.weight, 0), dot(force, force)
    heavy = dot(weight, weight)
    if heavy == 0.0 or square < FELT * heavy:
        return
    believed = turned(state.rotation, three(dynamics.weight, 3))  # the base's speeds of turning are along its own axes
    missed = less(moment, scaled(dot(force, weight) / heavy, believed))
    away = scaled(1.0 / square, cross(force, missed))
    lean, share, most = limbs.lean, period / LEARNT, FARTHEST * gains[ARM]
    for a in range(3):
        lean[a] += share * (dot(column(state.rotation, a), away) - lean[a])
    length = math.sqrt(dot(lean, lean))
    if length > most:
        keep_three(lean, 0, scaled(most / length, three(lean, 0)))


@kernel
def bear_loads(handle, touch, fading, stand, tick):
    """Work out the dynamics, count which tips feel something, write what contacts are to bear in their own frames, let errors add up.

    Args:
        handle: Holds the readings, the law's aims, in place, the state, the limbs (`limbed_body.Limbs`), in place, and what
            `steady_errors` takes, with the dynamics in place; last of that what `count_open` keeps.
        touch: Force above which a tip feels something [N].
        fading: The limb whose load fades before it lets go; -1: none.
        stand: Least force with which others of these press: one that bears next to nothing lifts off as soon as anything gives way [N].
        tick: Number of this one.

    Returns:
        How far the base is from where it is to be [m].
    """
    sensed, aims, state, limbs, rest = opened(handle)
    felt, loads, pushing = limbs.felt, limbs.loads, limbs.pushing
    work_out(rest[0], state, rest[1])
    for limb in range(felt.size):
        x, y, z = sensed.wrenches[limb, 0], sensed.wrenches[limb, 1], sensed.wrenches[limb, 2]
        felt[limb] = felt[limb] + 1 if math.sqrt(x * x + y * y + z * z) > touch else 0
        if felt[limb] > 0:
            limbs.met[limb] = tick
        if aims.does[limb] != HOLDS:
            continue
        for axis in range(3):
            force, moment = 0.0, 0.0
            for b in range(3):
                force += aims.frame[limb, axis, b] * loads[limb, b]
                moment += aims.frame[limb, axis, b] * loads[limb, 3 + b]
            aims.wrench[limb, axis], aims.wrench[limb, 3 + axis] = force, moment
        if pushing[limb] and limb != fading:
            aims.wrench[limb, 0] = max(aims.wrench[limb, 0], stand)
    feel_balance(sensed, aims, state, limbs, rest)
    steady_errors(state, aims, rest)
    off = 0.0
    for a in range(3):
        off += (aims.position[a] - state.position[a]) ** 2
    return math.sqrt(off)


@kernel
def find_resting(handle):
    """The holds that tips stay on, of what the handle of `bear_loads` holds; an end effector that is open stays nowhere."""
    sensed, aims, _, limbs, _ = opened(handle)
    for limb in range(aims.does.size):
        stays = aims.does[limb] == HOLDS and (limbs.pushing[limb] or sensed.closed[limb] != 0)
        limbs.resting[limb] = limbs.holds[limb] if stays else -1


@kernel
def count_open(handle, fading, off):
    """Count the ticks for which each limb that is to hold on has not; whether any is to be looked at.

    Args:
        handle: As in `bear_loads`. Its last array keeps the largest `off` and share of a motor's torque so far.
        fading: The limb whose load fades before it lets go; -1: none.
        off: How far the base is from where it is to be [m].
    """
    sensed, _, _, limbs, rest = opened(handle)
    torques, most, peaks = rest[4:]
    peaks[0], peaks[1] = max(peaks[0], off), max(peaks[1], largest_share(torques, most))
    pushing, ticks, some = limbs.pushing, limbs.open, False
    for limb in range(ticks.size):
        if limbs.holds[limb] < 0 or (pushing[limb] and limb == fading):
            ticks[limb] = 0
        elif not math.isnan(limbs.sought[limb]):
            some = True
        else:
            on = limbs.felt[limb] if pushing[limb] else sensed.closed[limb]
            ticks[limb] = 0 if on else ticks[limb] + 1
            some = some or ticks[limb] > 0
    return some
