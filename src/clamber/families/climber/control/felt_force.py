r"""What a limb's tip feels, told from its motors and encoders alone: what the motors give less what turns the rotors and rubs. Kernels.

A geared motor's own inertia takes most of its torque when nothing holds the tip, so how little the joints turn does not tell; what is left
over does. The left-over :math:`\tau - I \ddot q - b \dot q - c\,\mathrm{sgn}\,\dot q`, smoothed, is the torque at the joint's output, and
:math:`J^{-T}` makes of it the force of the tip on what it touches.
"""

import math

import numpy as np

from ....compiled import inlined, kernel, opened
from .planar_limb import HANG, STANCE, SWING_CARTESIAN, SWING_JOINT, UNLOADED_CONTACT

SLOW = 0.05
"""Friction acts fully against joints that turn faster than this [rad/s]; of a joint at rest it is not known, and left out."""
FLAT = 0.15
"""Sine of the angle between both links below which joint torques do not tell the force along them."""
LOAD = np.dtype(
    [
        ("period", "f8"),  # of the control [s]
        ("rate", "f8"),  # part of the way to the newest force that the smoothed one goes at a tick
        ("least", "f8"),  # sum of the forces' sizes that carries the robot [N]
        ("carried", "f8"),  # that sum now
        ("loose", "f8"),  # how long it has been too little [s]
        ("turning", "f8"),  # fastest joint of a limb that holds, now ...
        ("fastest", "f8"),  # ... and since it has been too little [rad/s]
    ]
)
"""What the tips carry together."""

ASTRAY = 0.08
"""A body this far from its aim has fallen, or is about to [m]."""
TURNED = 0.6
"""Likewise turned this far from it [rad]."""
BEHIND = 0.05
"""A body this far from its aim may be held there by what it cannot overcome [m]."""
STRAIN = 0.03
"""Two holding tips whose distance differs that much from that of their holds are not both on them [m]."""
UNBALANCED = 1.5
"""Sum of the forces of all tips and the weight, over the weight, beyond which something else pushes, or a motor does not give what it is
told [-]. Climbs without a fault come to 0.7 while joints cross their play, and to 3 where a link is caught at a peg."""
UNHELD, STRAINED, HANGING, SLACK, PINNED, LOST, PUSHED = (1 << k for k in range(7))
"""Signs that a tick may end the climb: no limb holds, two holding tips are as `STRAIN` says, one limb holds the body, which swings, jaws
that are to hold are closed about nothing, the body is `BEHIND`, it is `ASTRAY` or `TURNED` (where it does not swing), and the tips are
`UNBALANCED`."""


@kernel
def feel_forces(work, before, felt, forces, period, rate):
    """Forces of the tips on what they touch.

    Args:
        work: `BodyWork`, with the motors' torques since the tick before.
        before: Joint speeds then, set to those of now, shape (n, 2) [rad/s].
        felt: Torques at the joints' outputs, smoothed and changed, shape (n, 2) [N m].
        forces: Filled, world frame, shape (n, 2) [N]; of a limb that is stretched or folded, infinite: nobody can tell.
        period: Between both ticks [s].
        rate: Part of the way to the newest value that the smoothed one goes at a tick.

    Returns:
        Sum of the forces' sizes [N]; infinite where a limb that holds cannot tell, others that cannot count as none.
    """
    legs, held, q, qd, torques, angle = work.legs, work.held, work.q, work.qd, work.torques, work.pose[2]
    total = 0.0
    for i in range(legs.size):
        leg = legs[i]
        for k in range(2):
            dry, wet, rotor = (
                (leg.friction1, leg.damping1, leg.rotor1) if k == 0 else (leg.friction2, leg.damping2, leg.rotor2)
            )
            rub = wet * qd[i, k] + dry * min(1.0, max(-1.0, qd[i, k] / SLOW))
            now = torques[i, k] - rub - rotor * (qd[i, k] - before[i, k]) / period
            felt[i, k] += rate * (now - felt[i, k])
            before[i, k] = qd[i, k]
        first = angle + leg.port_angle + q[i, 0]
        second = first + q[i, 1] + leg.beta
        own = leg.heft2 * math.cos(first + q[i, 1])
        t1 = felt[i, 0] - leg.heft1 * math.cos(first) - own
        t2 = felt[i, 1] - own
        bend = math.sin(q[i, 1] + leg.beta)
        if abs(bend) < FLAT:
            forces[i, 0] = math.inf
            forces[i, 1] = math.inf
            if held[i]:
                total = math.inf
            continue
        j00 = -leg.l1 * math.sin(first) - leg.l2 * math.sin(second)
        j10 = leg.l1 * math.cos(first) + leg.l2 * math.cos(second)
        j01 = -leg.l2 * math.sin(second)
        j11 = leg.l2 * math.cos(second)
        det = leg.l1 * leg.l2 * bend
        forces[i, 0] = (j11 * t1 - j10 * t2) / det
        forces[i, 1] = (-j01 * t1 + j00 * t2) / det
        total += math.hypot(forces[i, 0], forces[i, 1])
    return total


@kernel
def see_load(handle):
    """Feel the forces of a tick, and for how long they have carried too little.

    Args:
        handle: Holds `BodyWork`, then `before`, `felt` and `forces` of `feel_forces`, their sum, filled, shape (2,) [N], and a record of
            `LOAD`, changed, shape (1,).

    Returns:
        For how long [s].
    """
    work, before, felt, forces, force, loads = opened(handle)
    load = loads[0]
    load.carried = feel_forces(work, before, felt, forces, load.period, load.rate)
    # a torque that jumps for a tick looks like a force, so one tick that says otherwise does not start the time anew
    little = load.carried < load.least
    load.loose = load.loose + load.period if little else max(load.loose - 2.0 * load.period, 0.0)
    load.turning = 0.0
    force[:] = 0.0
    for i in range(work.legs.size):
        force[0] += forces[i, 0]
        force[1] += forces[i, 1]
        if work.held[i]:
            load.turning = max(load.turning, abs(work.qd[i, 0]), abs(work.qd[i, 1]))
    load.fastest = max(load.fastest, load.turning) if load.loose > 0.0 else 0.0
    return load.loose


@kernel
def see_slips(handle):
    """How far the tips of pairs of limbs on holds have moved against each other of late.

    Args:
        handle: Holds `BodyWork`, and a row a pair: the limbs, their holds when it was looked at last, -1 where they were not both on
            some, shape (pairs, 2) each; the first tip less the second as it lately was, by the encoders and with the play counted,
            world frame [m], changed, shape (pairs, 4); the lesser of both changes since then, and how much the encoders say beyond
            the other belief, filled, zero where nothing is known, shape (pairs, 2) each; and the part of a change that is forgotten
            at a tick [-].

    Returns:
        The largest of the changes [m].
    """
    work, pairs, holds, lately, changes, beyond, rate = opened(handle)
    most = 0.0
    for k in range(pairs.shape[0]):
        a, b = pairs[k]
        one, other = work.jobs[a], work.jobs[b]
        changes[k] = 0.0
        if one.mode not in (STANCE, UNLOADED_CONTACT) or other.mode not in (STANCE, UNLOADED_CONTACT):
            holds[k] = -1
            continue
        felt = _apart(work.pose[2], work.tips, a, b)
        settled = _apart(work.settled[2], work.settled_tips, a, b)
        if holds[k, 0] != one.hold or holds[k, 1] != other.hold:
            holds[k, 0], holds[k, 1] = one.hold, other.hold
            lately[k, 0], lately[k, 1] = felt
            lately[k, 2], lately[k, 3] = settled
            continue
        beyond[k, 0], beyond[k, 1] = felt[0] - lately[k, 2], felt[1] - lately[k, 3]
        fx, fy = felt[0] - lately[k, 0], felt[1] - lately[k, 1]
        sx, sy = settled[0] - lately[k, 2], settled[1] - lately[k, 3]
        lately[k, 0] += rate * fx
        lately[k, 1] += rate * fy
        lately[k, 2] += rate * sx
        lately[k, 3] += rate * sy
        by_encoders = math.hypot(fx, fy)
        by_outputs = math.hypot(sx, sy)
        changes[k, 0], changes[k, 1] = (fx, fy) if by_encoders <= by_outputs else (sx, sy)
        most = max(most, min(by_encoders, by_outputs))
    return most


@kernel
def see_pairs(handle, angle, fresh, far):
    """How the tips of pairs of limbs on holds lie to each other, and how far the line of those that hold the body has turned.

    Args:
        handle: Holds `BodyWork`, and a row a pair: the limbs, the holds on which its tips are known and those on which its line
            is, -1 where they are not, shape (pairs, 2) each; directions of its line by the encoders and with the play counted, when
            it was known first, shape (pairs, 2) [rad]; the first tip less the second, likewise, as the body's encoder has turned it,
            when it was known first, shape (pairs, 4), when each of its joints' readings changed last since, shape (pairs, 4, 4), and
            now, shape (pairs, 4) [m]; the least turn of all lines, filled, shape (1,) [rad]; and for how many ticks each joint's
            reading is unchanged, shape (2 n,) or more, and between two looks.
        angle: Of the body by its encoder [rad].
        fresh: Whether that has changed since the look before: the lines' first directions are those of now.
        far: Beyond this, by the encoders and with the play counted, tips have moved from where they came to their holds [m].

    Returns:
        Whether those of any pair have.
    """
    work, pairs, came_to, lined, lines, came, lay, between, turned, unchanged, every = opened(handle)
    shift = angle - work.pose[2]
    least = math.inf
    moved = False
    for k in range(pairs.shape[0]):
        a, b = pairs[k]
        one, other = work.jobs[a], work.jobs[b]
        if one.mode != STANCE or other.mode != STANCE:
            lined[k] = -1
        else:
            by_encoders = _direction(work.tips, a, b)
            by_outputs = _direction(work.settled_tips, a, b)
            if fresh or lined[k, 0] != one.hold or lined[k, 1] != other.hold:
                lined[k, 0], lined[k, 1] = one.hold, other.hold
                lines[k, 0], lines[k, 1] = by_encoders, by_outputs
            least = min(least, _turn(by_encoders - lines[k, 0]), _turn(by_outputs - lines[k, 1]))
        if one.mode not in (STANCE, UNLOADED_CONTACT) or other.mode not in (STANCE, UNLOADED_CONTACT):
            came_to[k] = -1
            continue
        between[k, 0], between[k, 1] = _apart(angle, work.tips, a, b)
        between[k, 2], between[k, 3] = _apart(work.settled[2] + shift, work.settled_tips, a, b)
        new = came_to[k, 0] != one.hold or came_to[k, 1] != other.hold
        if new:
            came_to[k, 0], came_to[k, 1] = one.hold, other.hold
            came[k] = between[k]
        for row in range(4):
            if new or unchanged[2 * pairs[k, row // 2] + row % 2] < every:
                lay[k, row] = between[k]
        felt = math.hypot(between[k, 0] - came[k, 0], between[k, 1] - came[k, 1])
        moved |= min(felt, math.hypot(between[k, 2] - came[k, 2], between[k, 3] - came[k, 3])) > far
    turned[0] = least if least < math.inf else 0.0
    return moved


@inlined
def _direction(tips, a, b):
    """Of the line between two tips, body frame [rad]."""
    return math.atan2(tips[a, 1] - tips[b, 1], tips[a, 0] - tips[b, 0])


@inlined
def _turn(angle):
    """Size of an angle, whole turns apart [rad]."""
    return abs(angle - 2.0 * math.pi * math.floor(angle / (2.0 * math.pi) + 0.5))


@inlined
def _apart(angle, tips, a, b):
    """One tip less another, given in the frame of a body at that angle, world frame [m]."""
    c = math.cos(angle)
    s = math.sin(angle)
    x = tips[a, 0] - tips[b, 0]
    y = tips[a, 1] - tips[b, 1]
    return c * x - s * y, c * y + s * x


@kernel
def see_signs(handle):
    """Which of the signs there are, from `UNHELD` on, their sum; and which limbs are held at one end alone, if at all.

    Args:
        handle: Holds `BodyWork`; the sum of the tips' forces, shape (2,) [N]; 1 for limbs that end in jaws, and for jaws that are closed
            about something, shape (n,) each; and 1 for joints of limbs that are not held at both ends, filled, shape (n, 2).
    """
    work, force, jawed, gripped, free = opened(handle)
    weight = work.gains[0].weight
    signs = PUSHED if UNBALANCED * weight < math.hypot(force[0], force[1] + weight) < math.inf else 0
    first = -1
    last = -1
    for i in range(work.legs.size):
        mode = work.jobs[i].mode
        free[i] = mode in (SWING_CARTESIAN, SWING_JOINT, HANG)
        if mode in (STANCE, HANG):
            last = i
            if first < 0:
                first = i
        if mode == STANCE and jawed[i] and not gripped[i]:
            signs |= SLACK
    if first < 0:
        return signs | UNHELD
    one, other, tips = work.jobs[first], work.jobs[last], work.tips
    apart = math.hypot(tips[first, 0] - tips[last, 0], tips[first, 1] - tips[last, 1])
    if abs(apart - math.hypot(one.place[0] - other.place[0], one.place[1] - other.place[1])) > STRAIN:
        signs |= STRAINED
    if work.jobs[first].mode == HANG:
        return signs | HANGING
    off = math.hypot(work.aimed[0] - work.pose[0], work.aimed[1] - work.pose[1])
    if off > BEHIND:
        signs |= PINNED
    if off > ASTRAY or abs(work.pose[2] - work.aimed[2]) > TURNED:
        signs |= LOST
    return signs


@kernel
def see_push(handle):
    """Whether a free limb may be pushing the body away: 2 where it is for sure, 1 where it is unless the body only sways, else 0.

    Args:
        handle: Holds the body's pose and its aim, shape (3,) each; records of `LIMB_TASK`; the least that the body has been off its aim,
            changed, and how much more may be swaying, and is pushed for sure, shape (2,) each [m], [rad].
    """
    pose, aim, jobs, least, sways, surely = opened(handle)
    for i in range(jobs.size):
        if jobs[i].mode == HANG:
            return 0
    off = math.hypot(pose[0] - aim[0], pose[1] - aim[1])
    aside = abs(pose[2] - aim[2])
    least[0] = min(off, least[0])
    least[1] = min(aside, least[1])
    moved = off - least[0]
    turned = aside - least[1]
    if moved > surely[0] or turned > surely[1]:
        return 2
    return 1 if moved > sways[0] or turned > sways[1] else 0
