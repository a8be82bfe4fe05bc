r"""How two limbs share what the body needs so that their hooks stay on: the internal force along the line of their holds. Kernels.

Two holds bring a wrench with forces F_a = P_a + lambda u and F_b = P_b - lambda u, u the direction from a's hold to b's: balance
fixes the rest, and lambda is free. Each hook wants its own hold's force -F within a cone about its grab direction g, and some pull
along g; each motor has its limit. All of these are cuts c + d lambda >= 0, kept as rows (c, d) in newtons. Of the lambdas that meet
them all, the one with the least effort is taken; where none does, the one whose worst cut is best: so the forces never jump while the
body moves.
"""

import math

from ....compiled import inlined, kernel

WISHED_CONE = math.radians(45.0)
"""Half angle about the grab direction within which the load of a hook that is fed forward is wished [rad]."""
WIDEST_CONE = math.radians(70.0)
"""Likewise of all that it bears for a while, feedback included: friction and the hook's walls keep it on beyond."""
WISHED_PULL = 8.0
"""Pull along the grab direction that is wished of every hook: what friction in its joints may hide, twice [N]."""
LEAST_PULL = 1.5
"""Likewise for a while [N]."""
ASLANT = 0.3
"""What a newton beyond a cone counts where one that lacks of the pull is 1: a hook that is pulled aslant stays on while it is pulled."""
WISHED_TORQUE = 0.5
"""Part of the motors' torque that is wished to carry [-]; the rest is for motion."""
MOST_TORQUE = 0.95
"""Likewise for a while [-]."""
ACROSS = 0.3
"""What a load across the hook of the size of the wrench's force counts, where 1 is a motor at its limit."""
MOST_CUTS = 14
"""Three of each hook and four of each limb's motors."""
FAR = 1e3
"""Internal forces are looked for within this [N]."""
HALVINGS = 7
"""In the search for the part of the feedback that hooks and motors bear."""
NOTHING = (0.0, 0.0, 0.0)
"""Asked for besides a steady wrench."""
FLAT = 1e-9
"""A cut with less slope than this says nothing about lambda."""


@kernel
def pair_forces(stance, pair, wrenches, cuts, forces):
    """Forces of two holds on their limbs, added up to a wrench, within what hooks and motors can take if there is such a split.

    First comes the steady wrench, as is wished of hooks and motors. What is asked for besides, to bring the body back to its aim, may go up
    to their bounds; of more than these allow it gets a part.

    Args:
        stance: Records of `PLANAR_LIMB`, shape (n,), joint angles, shape (n, 2) [rad], body pose, shape (3,), and holds less body, world
            frame, shape (n, 2) [m].
        pair: Both limbs.
        wrenches: On the body, steady and what is asked for besides: Fx, Fy [N], M about its origin [N m] each.
        cuts: Work space, shape (MOST_CUTS, 2).
        forces: Rows a and b are filled, world frame, shape (n, 2) [N].

    Returns:
        How well the worst of hooks and motors is off under the steady wrench [N]: negative if none of the splits meets all wishes; and the
        part that is brought of what is asked for besides.
    """
    legs, q, pose, arms = stance
    a, b = pair
    more = wrenches[1]
    dx = arms[b, 0] - arms[a, 0]
    dy = arms[b, 1] - arms[a, 1]
    length = max(math.hypot(dx, dy), 1e-6)
    line = (dx / length, dy / length, length)
    loads = (a, b, arms, line, wrenches)
    lie = (_as_it_lies(legs[a], q[a], pose[2]), _as_it_lies(legs[b], q[b], pose[2]))
    wishes = (math.sin(WISHED_CONE), math.cos(WISHED_CONE), WISHED_PULL, WISHED_TORQUE)
    bounds = (math.sin(WIDEST_CONE), math.cos(WIDEST_CONE), LEAST_PULL, MOST_TORQUE)
    count, easiest = _cut_pair(legs, lie, loads, 0.0, wishes, cuts, forces)
    lam, margin = max_min_solution(cuts, count, easiest)
    part = 0.0
    if more[0] != 0.0 or more[1] != 0.0 or more[2] != 0.0:
        count, _ = _cut_pair(legs, lie, loads, 0.0, bounds, cuts, forces)
        _, floor = max_min_solution(cuts, count, lam)
        floor = min(floor, 0.0)
        count, _ = _cut_pair(legs, lie, loads, 1.0, bounds, cuts, forces)
        whole, least = max_min_solution(cuts, count, lam)
        part = 1.0
        if least < floor:
            # the worst cut is a concave function of the part, so what serves is an interval from 0
            part = 0.0
            whole = lam
            step = 0.5
            for _ in range(HALVINGS):
                count, _ = _cut_pair(legs, lie, loads, part + step, bounds, cuts, forces)
                found, least = max_min_solution(cuts, count, lam)
                if least >= floor:
                    part += step
                    whole = found
                step *= 0.5
        lam = whole
    _split(loads, part, forces)
    forces[a, 0] += lam * line[0]
    forces[a, 1] += lam * line[1]
    forces[b, 0] -= lam * line[0]
    forces[b, 1] -= lam * line[1]
    return margin, part


@inlined
def _split(loads, part, forces):
    """The split, with the least forces, of the steady wrench and a part of what is asked for besides."""
    a, b, arms, line, wrenches = loads
    wrench, more = wrenches
    ux, uy, length = line
    x = wrench[0] + part * more[0]
    y = wrench[1] + part * more[1]
    moment = wrench[2] + part * more[2] - 0.5 * ((arms[a, 0] + arms[b, 0]) * y - (arms[a, 1] + arms[b, 1]) * x)
    turn = moment / length
    forces[a, 0] = 0.5 * x + turn * uy
    forces[a, 1] = 0.5 * y - turn * ux
    forces[b, 0] = 0.5 * x - turn * uy
    forces[b, 1] = 0.5 * y + turn * ux


@kernel
def _cut_pair(legs, lie, loads, part, wishes, cuts, forces):
    """Fill the cuts of both limbs, by `_as_it_lies` of each; how many, and the lambda with the least effort."""
    a, b, _, line, wrenches = loads
    _split(loads, part, forces)
    size = max(math.hypot(wrenches[0][0], wrenches[0][1]), 1.0)
    along, against = (line[0], line[1]), (-line[0], -line[1])
    count, slope, square = _add_cuts(legs[a], lie[0], forces[a], along, size, wishes, cuts, 0)
    count, slope_b, square_b = _add_cuts(legs[b], lie[1], forces[b], against, size, wishes, cuts, count)
    square += square_b
    return count, -(slope + slope_b) / square if square > FLAT else 0.0


@inlined
def _as_it_lies(leg, q, angle):
    """Jacobian of a limb's tip, row by row, and the direction in which its hook pulls, world frame."""
    first = angle + leg.port_angle + q[0]
    second = first + q[1] + leg.beta
    x2 = leg.l2 * math.cos(second)
    y2 = leg.l2 * math.sin(second)
    grab = angle + leg.port_angle + q[0] + q[1] + leg.hook_angle
    return -leg.l1 * math.sin(first) - y2, -y2, leg.l1 * math.cos(first) + x2, x2, math.cos(grab), math.sin(grab)


@inlined
def _add_cuts(leg, lies, force, along, size, wishes, cuts, count):
    """Cuts of a limb, as it lies, whose hold gives `force` + lambda `along`; of its effort in lambda half the slope at 0 and the square.

    `lies`: see `_as_it_lies`.
    `wishes`: sine and cosine of the cone's half angle, pull along the grab direction [N], part of the motors' torque.
    """
    ux, uy = along
    cone_sin, cone_cos, least_pull, torque_part = wishes
    j00, j01, j10, j11, gx, gy = lies
    # of the limb on its hold, along the grab direction and across it
    pull = -(gx * force[0] + gy * force[1])
    pull_rate = -(gx * ux + gy * uy)
    across = -(gx * force[1] - gy * force[0])
    across_rate = -(gx * uy - gy * ux)
    slope = 0.0
    square = 0.0
    if leg.hooked:
        for side in range(2):
            sign = 1.0 - 2.0 * side
            cuts[count, 0] = ASLANT * (cone_sin * pull + sign * cone_cos * across)
            cuts[count, 1] = ASLANT * (cone_sin * pull_rate + sign * cone_cos * across_rate)
            count += 1
        cuts[count, 0] = pull - least_pull
        cuts[count, 1] = pull_rate
        count += 1
        slope += ACROSS * across * across_rate / size**2
        square += ACROSS * across_rate * across_rate / size**2
    for joint in range(2):
        x = j10 if joint == 0 else j11
        y = -j00 if joint == 0 else -j01
        limit = leg.limit1 if joint == 0 else leg.limit2
        torque = y * force[0] - x * force[1]
        rate = y * ux - x * uy
        slope += torque * rate / limit**2
        square += rate * rate / limit**2
        arm = leg.l1 if joint == 0 else leg.l2  # torques weigh like the forces that they bring at a link's length
        for side in range(2):
            sign = 1.0 - 2.0 * side
            cuts[count, 0] = (torque_part * limit + sign * torque) / arm
            cuts[count, 1] = sign * rate / arm
            count += 1
    return count, slope, square


@kernel
def max_min_solution(cuts, count, wished):
    """The lambda nearest to `wished` that meets all cuts c + d lambda >= 0, or the one whose worst cut is best; and that cut's value there.

    Args:
        cuts: Rows (c, d), shape (at least count, 2).
        count: How many of them count.
        wished: Where lambda is to be.

    Returns:
        lambda, and the least c + d lambda.
    """
    low = -FAR
    high = FAR
    for k in range(count):
        c = cuts[k, 0]
        d = cuts[k, 1]
        if d > FLAT:
            low = max(low, -c / d)
        elif d < -FLAT:
            high = min(high, -c / d)
    lam = min(max(wished, low), high)
    if low > high:
        # the best worst cut: the crossing of a rising and a falling one that no other lies below there
        rising = _least_cut(cuts, count, high)
        falling = _least_cut(cuts, count, low)
        lam = 0.5 * (low + high)
        for _ in range(count):
            slope = cuts[rising, 1] - cuts[falling, 1]
            if cuts[rising, 1] <= FLAT or cuts[falling, 1] >= -FLAT or slope <= FLAT:
                break
            lam = (cuts[falling, 0] - cuts[rising, 0]) / slope
            k = _least_cut(cuts, count, lam)
            if k in (rising, falling):
                break
            if cuts[k, 1] > FLAT:
                rising = k
            elif cuts[k, 1] < -FLAT:
                falling = k
            else:
                break
    least = math.inf
    for k in range(count):
        least = min(least, cuts[k, 0] + cuts[k, 1] * lam)
    return lam, least


@inlined
def _least_cut(cuts, count, lam):
    """Index of the cut that is lowest at a lambda, of those that it changes."""
    best = 0
    least = math.inf
    for k in range(count):
        if abs(cuts[k, 1]) <= FLAT:
            continue
        value = cuts[k, 0] + cuts[k, 1] * lam
        if value < least:
            least = value
            best = k
    return best
