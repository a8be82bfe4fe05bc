"""Posture of a plate on legs of one freedom each: its inclination both ways, and its legs' lengths both ways. Kernels.

The plate's orientation in the world is R = Rz(alpha) Ry(beta) Rx(gamma); its legs are along its normal, their places are in the plate.
Equations as in `docs/walking.md`, after Hoshino and others (1995), section 4, whose equations 4, 5 and 7 are illegible and whose
equation 6 loses the quadrant.
"""

import math

from ....compiled import inlined, kernel


@kernel
def slope_of(beta, gamma):
    """Direction of the steepest ascent, from the plate's heading alpha [rad], and its angle [rad]; level: 0, 0."""
    return math.atan2(math.tan(gamma) / math.cos(beta), -math.tan(beta)), math.acos(
        min(1.0, max(-1.0, math.cos(beta) * math.cos(gamma)))
    )


@kernel
def tilt_of(eta, xi):
    """beta, gamma [rad] of a plate that rises steepest by the angle `xi` in the direction `eta` from its heading: `slope_of` undone."""
    beta = -math.atan(math.tan(xi) * math.cos(eta))
    return beta, math.atan(math.tan(xi) * math.sin(eta) * math.cos(beta))


@kernel
def tilt_of_inclines(along, across):
    """beta, gamma [rad] from how far the plate's x axis and its y axis rise above the horizontal [rad]."""
    sine = math.sin(across) / math.cos(along)
    return -along, math.asin(min(1.0, max(-1.0, sine)))


@kernel
def inclines_of_tilt(beta, gamma):
    """How far the plate's x axis and its y axis rise above the horizontal [rad]: what two inclinometers read."""
    return -beta, math.asin(math.cos(beta) * math.sin(gamma))


@inlined
def rise(beta, gamma, x, y, length):
    """Height of the sole of a leg at x, y in the plate over that of the plate's origin [m]."""
    return -math.sin(beta) * x + math.cos(beta) * (math.sin(gamma) * y - math.cos(gamma) * length)


@kernel
def leg_lengths(z, beta, gamma, places, heights, lengths):
    """Write the legs' lengths with which the plate is at a height and a tilt over its footholds.

    l_i = (z - h_i) / (cos(beta) cos(gamma)) - tan(beta) / cos(gamma) x_i + tan(gamma) y_i.

    Args:
        z: Height of the plate's origin [m].
        beta, gamma: Its tilt [rad].
        places: Of the legs in the plate, shape (n, 2) [m].
        heights: Of their footholds in the world, shape (n,) [m].
        lengths: Output, shape (n,) [m].
    """
    normal = math.cos(beta) * math.cos(gamma)
    for i in range(lengths.shape[0]):
        lengths[i] = (
            (z - heights[i]) / normal - math.tan(beta) / math.cos(gamma) * places[i, 0] + math.tan(gamma) * places[i, 1]
        )


@kernel
def plate_on_legs(places, lengths, heights, stands):
    """Where legs of known lengths on footholds of known heights hold the plate; with more than three, the plane that fits best.

    With b = -tan(beta) / cos(gamma), c = tan(gamma) and s = sqrt(1 + b^2 + c^2) the lengths are linear: l_i + h_i s = z s + b x_i + c y_i.
    So b and c are linear in s, and the equation of s is a quadratic, of which one root is positive while the plane through the
    footholds, taken at their places in the plate, rises by less than 45 deg. With equal heights b and c do not depend on s.

    Args:
        places: Of the legs in the plate, shape (n, 2) [m].
        lengths: Of the legs, shape (n,) [m].
        heights: Of the footholds in the world, shape (n,) [m].
        stands: 1 for legs that count, shape (n,).

    Returns:
        Whether there is such a plate, its height [m], beta, gamma [rad].
    """
    n = sx = sy = sl = sh = 0.0
    for i in range(stands.shape[0]):
        if stands[i]:
            n += 1.0
            sx += places[i, 0]
            sy += places[i, 1]
            sl += lengths[i]
            sh += heights[i]
    if n < 3.0:
        return False, 0.0, 0.0, 0.0
    xx = xy = yy = xl = yl = xh = yh = 0.0
    for i in range(stands.shape[0]):
        if stands[i]:
            x = places[i, 0] - sx / n
            y = places[i, 1] - sy / n
            xx += x * x
            xy += x * y
            yy += y * y
            xl += x * lengths[i]
            yl += y * lengths[i]
            xh += x * heights[i]
            yh += y * heights[i]
    spread = xx * yy - xy * xy
    if spread <= 1e-9 * (xx + yy) * (xx + yy):  # the feet are in a line
        return False, 0.0, 0.0, 0.0
    b0 = (yy * xl - xy * yl) / spread
    c0 = (xx * yl - xy * xl) / spread
    b1 = (yy * xh - xy * yh) / spread
    c1 = (xx * yh - xy * xh) / spread
    square = 1.0 - b1 * b1 - c1 * c1
    if square <= 0.0:
        return False, 0.0, 0.0, 0.0
    half = b0 * b1 + c0 * c1
    s = (half + math.sqrt(half * half + square * (1.0 + b0 * b0 + c0 * c0))) / square
    b = b0 + s * b1
    c = c0 + s * c1
    z = (sl + s * sh - b * sx - c * sy) / (n * s)
    gamma = math.atan(c)
    return True, z, -math.atan(b * math.cos(gamma)), gamma


@kernel
def move_together(lengths, targets, moving, most):
    """Move legs towards their targets at speeds proportional to what is left to each, the fastest by `most`: all end together.

    Args:
        lengths: Changed, shape (n,) [m].
        targets: Shape (n,) [m].
        moving: 1 for legs that take part, shape (n,).
        most: Largest change of a leg [m].

    Returns:
        The largest way that is left [m].
    """
    far = 0.0
    for i in range(lengths.shape[0]):
        if moving[i]:
            far = max(far, abs(targets[i] - lengths[i]))
    share = 1.0 if far <= most else most / far
    for i in range(lengths.shape[0]):
        if moving[i]:
            lengths[i] += share * (targets[i] - lengths[i])
    return (1.0 - share) * far


@kernel
def trim_lag(lengths, sensed, was, stands, still, slack, share, trims):
    """Make up for a part of what loaded legs give way, where they are at rest: change what is added to their commands.

    Args:
        lengths: As wanted, shape (n,) [m].
        sensed: As they are, shape (n,) [m].
        was: As wanted a tick ago, shape (n,), and by how much all legs were to grow since then [m].
        stands: 1 for legs that stand, shape (n,).
        still: A leg that was to move by less beyond that is at rest [m].
        slack: Smaller errors stay [m].
        share: Of the error that is made up for now [-].
        trims: Changed, shape (n,) [m].
    """
    before, raised = was
    for i in range(lengths.shape[0]):
        if stands[i] and abs(lengths[i] - before[i] - raised) < still:
            short = lengths[i] - sensed[i]
            if abs(short) >= slack:
                trims[i] += share * short


@kernel
def move_each(lengths, aims, most, stands):
    """Move legs that do not stand towards their aims, each by `most` at most, shape (n,) [m]."""
    for i in range(lengths.shape[0]):
        if not stands[i]:
            lengths[i] += min(most[i], max(-most[i], aims[i] - lengths[i]))


@kernel
def whole_steps(lengths, resolution, shortest, longest, most, steps):
    """Turn lengths into whole steps of the legs' motors, inside their stroke; a motor stays where it is while that is near enough.

    A motor makes one step at least, or as many as fit into `most`.

    Args:
        lengths: Wanted, shape (n,) [m].
        resolution: One step [m].
        shortest, longest: Ends of the stroke [m].
        most: Largest change of a leg [m].
        steps: Lengths in whole steps as they are, changed, shape (n,) [m].
    """
    low = math.ceil(shortest / resolution - 1e-6)
    high = math.floor(longest / resolution + 1e-6)
    fast = max(1.0, math.floor(most / resolution + 1e-6))
    for i in range(lengths.shape[0]):
        if abs(lengths[i] - steps[i]) > 0.75 * resolution:
            now = math.floor(steps[i] / resolution + 0.5)
            change = math.floor(lengths[i] / resolution + 0.5) - now
            steps[i] = resolution * min(high, max(low, now + min(fast, max(-fast, change))))


@kernel
def level_heights(beta, gamma, places, lengths, stands, turn_beta, turn_gamma, heights):
    """Change the footholds' heights as they follow from the plate's tilt being another: the legs stay, their mean height stays.

    Args:
        beta, gamma: Tilt as it was believed [rad].
        places: Of the legs in the plate, shape (n, 2) [m].
        lengths: Of the legs, shape (n,) [m].
        stands: 1 for legs that stand, shape (n,).
        turn_beta, turn_gamma: By how much it is another [rad].
        heights: Of the footholds, changed where legs stand, shape (n,) [m].
    """
    n = 0
    mean = 0.0
    for i in range(stands.shape[0]):
        if stands[i]:
            x = places[i, 0]
            y = places[i, 1]
            n += 1
            mean += rise(beta + turn_beta, gamma + turn_gamma, x, y, lengths[i]) - rise(beta, gamma, x, y, lengths[i])
    for i in range(stands.shape[0]):
        if stands[i]:
            x = places[i, 0]
            y = places[i, 1]
            change = rise(beta + turn_beta, gamma + turn_gamma, x, y, lengths[i]) - rise(beta, gamma, x, y, lengths[i])
            heights[i] += change - mean / n
