r"""How two limbs share what the body needs so that their hooks stay on: the internal force along the line of their holds. Kernels.

Two holds bring a wrench with forces F_a = P_a + lambda u and F_b = P_b - lambda u, u the direction from a's hold to b's: balance fixes the
rest, and lambda is free. Each hook wants its own hold's force -F within a cone about its grab direction g, and some pull along g; each motor
has its limit. All of these are cuts c + d lambda >= 0, kept as rows (c, d) in newtons. Of the lambdas that meet them all, the one with the
least effort is taken; where none does, the one whose worst cut is best: so the forces never jump while the body moves.
"""

import math

from ..compiled import inlined, kernel

WISHED_CONE = math.radians(45.0)
"""Half angle about the grab direction within which the load of a hook that is fed forward is wished [rad]."""
WIDEST_CONE = math.radians(70.0)
"""Likewise of all that it bears for a while, feedback included: friction and the hook's walls keep it on beyond."""
WISHED_PULL = 3.0
"""Pull along the grab direction that is wished of every hook [N]."""
LEAST_PULL = 1.5
"""Likewise for a while [N]."""
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
NEAR_STRAIGHT = 0.05
"""A limb nearer to straight than this, as the sine of its elbow, is reckoned with as if it were there."""
FLAT = 1e-9
"""A cut with less slope than this says nothing about lambda."""


@kernel
def pair_forces(legs, q, a, b, pose, arms, wrench, cuts, forces):
    """Forces of two holds on their limbs, added up to a wrench, within what hooks and motors can take if there is such a split.

    Args:
        legs: Records of `LEG`, shape (n,).
        q: Joint angles, shape (n, 2) [rad].
        a, b: The limbs.
        pose: Body pose, shape (3,).
        arms: Holds less body, world frame, shape (n, 2) [m].
        wrench: On the body: Fx, Fy [N], M about its origin [N m].
        cuts: Work space, shape (MOST_CUTS, 2).
        forces: Rows a and b are filled, world frame, shape (n, 2) [N].

    Returns:
        How well the worst of hooks and motors is off [N]: negative if none of the splits meets all wishes.
    """
    dx = arms[b, 0] - arms[a, 0]
    dy = arms[b, 1] - arms[a, 1]
    length = max(math.hypot(dx, dy), 1e-6)
    ux = dx / length
    uy = dy / length
    moment = wrench[2] - 0.5 * ((arms[a, 0] + arms[b, 0]) * wrench[1] - (arms[a, 1] + arms[b, 1]) * wrench[0])
    turn = moment / length
    forces[a, 0] = 0.5 * wrench[0] + turn * uy
    forces[a, 1] = 0.5 * wrench[1] - turn * ux
    forces[b, 0] = 0.5 * wrench[0] - turn * uy
    forces[b, 1] = 0.5 * wrench[1] + turn * ux
    size = max(math.hypot(wrench[0], wrench[1]), 1.0)
    wishes = (math.sin(WISHED_CONE), math.cos(WISHED_CONE), WISHED_PULL, WISHED_TORQUE)
    count, slope, square = _add_cuts(legs[a], q[a], pose[2], forces[a], ux, uy, size, wishes, cuts, 0)
    count, slope_b, square_b = _add_cuts(legs[b], q[b], pose[2], forces[b], -ux, -uy, size, wishes, cuts, count)
    square += square_b
    easiest = -(slope + slope_b) / square if square > FLAT else 0.0
    lam, margin = best_within(cuts, count, easiest)
    forces[a, 0] += lam * ux
    forces[a, 1] += lam * uy
    forces[b, 0] -= lam * ux
    forces[b, 1] -= lam * uy
    return margin


@kernel
def keep_hooked(legs, q, a, b, pose, arms, pulls, cuts, forces):
    """Let two holding limbs pull against each other as much more as their hooks need to bear the feedback too; the body's wrench stays.

    What even that leaves short is added to the feedback along the grab direction, which does move the body.

    Args:
        legs, q, a, b, pose, arms, cuts: As of `pair_forces`.
        pulls: Accelerations of the tips relative to the body, world frame, shape (n, 2); changed.
        forces: Of the holds on the limbs, fed forward, world frame, shape (n, 2) [N]; changed.
    """
    dx = arms[b, 0] - arms[a, 0]
    dy = arms[b, 1] - arms[a, 1]
    length = max(math.hypot(dx, dy), 1e-6)
    ux = dx / length
    uy = dy / length
    ax, ay = felt(legs[a], q[a], pose[2], pulls[a, 0], pulls[a, 1])
    bx, by = felt(legs[b], q[b], pose[2], pulls[b, 0], pulls[b, 1])
    bounds = (math.sin(WIDEST_CONE), math.cos(WIDEST_CONE), LEAST_PULL, MOST_TORQUE)
    whole_a = (forces[a, 0] - ax, forces[a, 1] - ay)
    whole_b = (forces[b, 0] - bx, forces[b, 1] - by)
    count, _, _ = _add_cuts(legs[a], q[a], pose[2], whole_a, ux, uy, 1.0, bounds, cuts, 0)
    count, _, _ = _add_cuts(legs[b], q[b], pose[2], whole_b, -ux, -uy, 1.0, bounds, cuts, count)
    lam, _ = best_within(cuts, count, 0.0)
    forces[a, 0] += lam * ux
    forces[a, 1] += lam * uy
    forces[b, 0] -= lam * ux
    forces[b, 1] -= lam * uy
    raise_pull(legs[a], q[a], pose[2], ax - forces[a, 0], ay - forces[a, 1], pulls[a])
    raise_pull(legs[b], q[b], pose[2], bx - forces[b, 0], by - forces[b, 1], pulls[b])


@inlined
def raise_pull(leg, q, angle, fx, fy, pull):
    """Add to a tip's acceleration, world frame, what a hook lacks along its grab direction while its load is (fx, fy) [N]."""
    if not leg.hooked:
        return
    grab = angle + leg.port_angle + q[0] + q[1] + leg.hook_angle
    gx = math.cos(grab)
    gy = math.sin(grab)
    lack = LEAST_PULL - (gx * fx + gy * fy)
    if lack > 0.0:
        j00, j01, j10, j11 = _jacobian(leg, q, angle)
        t0 = (j00 * gx + j10 * gy) / leg.share1
        t1 = (j01 * gx + j11 * gy) / leg.share2
        pull[0] += lack * (j00 * t0 + j01 * t1)
        pull[1] += lack * (j10 * t0 + j11 * t1)


@inlined
def felt(leg, q, angle, ax, ay):
    """Force of a tip that stands still on its hold for an acceleration that is asked of it: J^-T K' J^-1 a, world frame [N]."""
    j00, j01, j10, j11 = _jacobian(leg, q, angle)
    det = j00 * j11 - j01 * j10
    least = NEAR_STRAIGHT * leg.l1 * leg.l2
    if abs(det) < least:
        det = math.copysign(least, det)
    t0 = leg.share1 * (j11 * ax - j01 * ay) / det
    t1 = leg.share2 * (j00 * ay - j10 * ax) / det
    return (j11 * t0 - j10 * t1) / det, (j00 * t1 - j01 * t0) / det


@inlined
def _jacobian(leg, q, angle):
    first = angle + leg.port_angle + q[0]
    second = first + q[1] + leg.beta
    x2 = leg.l2 * math.cos(second)
    y2 = leg.l2 * math.sin(second)
    return -leg.l1 * math.sin(first) - y2, -y2, leg.l1 * math.cos(first) + x2, x2


@inlined
def _add_cuts(leg, q, angle, force, ux, uy, size, wishes, cuts, count):
    """Cuts of one limb with the force `force` + lambda (ux, uy) of its hold; and of its effort in lambda half the slope at 0, and the square.

    `wishes`: sine and cosine of the cone's half angle, pull along the grab direction [N], part of the motors' torque.
    """
    cone_sin, cone_cos, least_pull, torque_part = wishes
    j00, j01, j10, j11 = _jacobian(leg, q, angle)
    grab = angle + leg.port_angle + q[0] + q[1] + leg.hook_angle
    gx = math.cos(grab)
    gy = math.sin(grab)
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
            cuts[count, 0] = cone_sin * pull + sign * cone_cos * across
            cuts[count, 1] = cone_sin * pull_rate + sign * cone_cos * across_rate
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
def best_within(cuts, count, wished):
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
            if k == rising or k == falling:
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
