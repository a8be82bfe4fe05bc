"""Where the body is, by the limbs that hold (Bevly 1997, 4.4.3), and a sample of it. Kernels."""

import math

from ....compiled import inlined, kernel, opened
from .planar_limb import HANG, STANCE, move_tips, place_tips

LINE, ENCODER, SECOND_TIP = range(3)
"""Sources of the body's angle: the line between two tips, the body's own encoder, the height of the second tip (as printed in 4.4.3)."""
UPRIGHT = 1e-3
"""Of two tips less far apart along x the second tip's height tells no angular speed [m]."""


@inlined
def pass_load(work):
    """Which limbs hold, and how much each of them says about where the body is; whether a hand-over ends with this tick."""
    held, weights, carriers, handed = work.held, work.weights, work.carriers, work.handed
    for i in range(held.size):
        job = work.jobs[i]
        held[i] = job.mode in (STANCE, HANG)
        if held[i]:
            work.holds[i, 0] = job.place[0]
            work.holds[i, 1] = job.place[1]
    ends = False
    if handed[0] < 1.0:
        # sums of steps miss 1 by rounding: a tick more, with all of the load passed, would be no hand-over to the command
        ends = handed[0] + 1.5 * handed[1] >= 1.0
        handed[0] = 1.0 if ends else handed[0] + handed[1]
    if ends:
        for i in range(held.size):
            if not carriers[1, i]:
                held[i] = 0
    part = part_passed(handed[0])
    before = 0
    after = 0
    for i in range(held.size):
        before += carriers[0, i]
        after += carriers[1, i]
    for i in range(held.size):
        if handed[0] < 1.0:
            weights[i] = (1.0 - part) / before * carriers[0, i] + part / after * carriers[1, i]
        else:
            weights[i] = held[i]
    return ends


@inlined
def part_passed(u):
    """Part of the load that has passed at a part of the time of a hand-over, smooth at both ends [-]."""
    return u * u * (3.0 - 2.0 * u)


@kernel
def estimate_body(legs, joints, held, told, tips, speeds, pose, twist):
    """Body pose and speed from the holding limbs.

    The angle is that of the seventh encoder, or that of the line between the tips of the first two holding limbs against the line of their
    holds (exact for any pair that is apart), or the one at which the second of them is as high above the first as its hold (the rule of
    4.4.3: two angles do that, and the nearer to the angle before is taken; where none does, the one that comes nearest). The place is the
    mean over the holding limbs of hold less tip, by weight: a limb that takes over from another comes in little by little, and the pose
    does not jump; with the rule of 4.4.3 it is that of the first limb alone.

    Args:
        legs: Records of `PLANAR_LIMB`, shape (n,).
        joints: Their angles and speeds, shape (n, 2) each.
        held: Weights of the limbs that hold, 0 for others, shape (n,), and the believed places of their holds, shape (n, 2) [m].
        told: Angle and speed of the body by its own encoder [rad], [rad/s]; and ENCODER, which uses those, LINE or SECOND_TIP, the tips.
        tips, speeds: Filled with the tips in the body frame and their speeds, shape (n, 2).
        pose, twist: Filled, shape (3,) [m], [rad].

    Returns:
        Number of holding limbs. With none, or one and no encoder, the pose cannot be told and is left as it was.
    """
    q, qd = joints
    weights, holds = held
    angle, angle_speed, angle_from = told
    place_tips(legs, q, tips)
    move_tips(legs, q, qd, speeds)
    count = 0
    total = 0.0
    a = -1
    b = -1
    for i in range(legs.size):
        if weights[i] > 0.0:
            count += 1
            total += weights[i]
            if a < 0:
                a = i
            elif b < 0:
                b = i
    if count == 0 or (count == 1 and angle_from != ENCODER):
        return count
    if angle_from == ENCODER:
        theta = angle
        omega = angle_speed
    elif angle_from == SECOND_TIP:
        dx = tips[b, 0] - tips[a, 0]
        dy = tips[b, 1] - tips[a, 1]
        theta = _level_second_tip(dx, dy, holds[b, 1] - holds[a, 1], pose[2])
        wide = math.cos(theta) * dx - math.sin(theta) * dy
        wx = speeds[b, 0] - speeds[a, 0]
        wy = speeds[b, 1] - speeds[a, 1]
        omega = -(math.sin(theta) * wx + math.cos(theta) * wy) / wide if abs(wide) > UPRIGHT else 0.0
    else:
        dx = tips[b, 0] - tips[a, 0]
        dy = tips[b, 1] - tips[a, 1]
        ux = holds[b, 0] - holds[a, 0]
        uy = holds[b, 1] - holds[a, 1]
        theta = math.atan2(uy * dx - ux * dy, ux * dx + uy * dy)
        # nearest to the angle before, so that a turning body keeps count
        theta += 2.0 * math.pi * math.floor((pose[2] - theta) / (2.0 * math.pi) + 0.5)
        wx = speeds[b, 0] - speeds[a, 0]
        wy = speeds[b, 1] - speeds[a, 1]
        omega = -(dx * wy - dy * wx) / (dx * dx + dy * dy)
    c = math.cos(theta)
    s = math.sin(theta)
    x = 0.0
    y = 0.0
    vx = 0.0
    vy = 0.0
    for i in range(legs.size):
        if weights[i] > 0.0 and (angle_from != SECOND_TIP or i == a):
            part = weights[i] / total if angle_from != SECOND_TIP else 1.0
            rx = c * tips[i, 0] - s * tips[i, 1]
            ry = s * tips[i, 0] + c * tips[i, 1]
            x += part * (holds[i, 0] - rx)
            y += part * (holds[i, 1] - ry)
            vx -= part * (c * speeds[i, 0] - s * speeds[i, 1] - omega * ry)
            vy -= part * (s * speeds[i, 0] + c * speeds[i, 1] + omega * rx)
    pose[0] = x
    pose[1] = y
    pose[2] = theta
    twist[0] = vx
    twist[1] = vy
    twist[2] = omega
    return count


@inlined
def _level_second_tip(dx, dy, height, before):
    """Angle at which a tip (dx, dy) from the first in the body frame is `height` above it, of two the nearer to `before` [rad]."""
    far = math.hypot(dx, dy)
    rise = math.asin(min(max(height / far, -1.0), 1.0)) if far > 0.0 else 0.0
    line = math.atan2(dy, dx)
    one = _nearest_turn(rise - line, before)
    other = _nearest_turn(math.pi - rise - line, before)
    return one if abs(one - before) <= abs(other - before) else other


@inlined
def _nearest_turn(angle, before):
    """The angle, by whole turns as near to another as can be [rad]."""
    return angle + 2.0 * math.pi * math.floor((before - angle) / (2.0 * math.pi) + 0.5)


@inlined
def place_in_world(work, i):
    """Where a limb's tip is in the world, how it moves, and where its hook pulls."""
    pose, twist, leg, tip, speed = work.pose, work.twist, work.legs[i], work.tips[i], work.tip_speeds[i]
    work.places[i, 0], work.places[i, 1] = in_world(work.settled, work.settled_tips[i, 0], work.settled_tips[i, 1])
    work.felt_places[i, 0], work.felt_places[i, 1] = in_world(pose, tip[0], tip[1])
    c = math.cos(pose[2])
    s = math.sin(pose[2])
    ax = speed[0] - twist[2] * tip[1]
    ay = speed[1] + twist[2] * tip[0]
    work.place_speeds[i, 0] = twist[0] + c * ax - s * ay
    work.place_speeds[i, 1] = twist[1] + s * ax + c * ay
    grab = pose[2] + leg.port_angle + work.q[i, 0] + work.q[i, 1] + leg.hook_angle
    work.grabs[i, 0] = math.cos(grab)
    work.grabs[i, 1] = math.sin(grab)


@inlined
def in_world(settled, x, y):
    """A place of the body frame in the world."""
    c = math.cos(settled[2])
    s = math.sin(settled[2])
    return settled[0] + c * x - s * y, settled[1] + s * x + c * y


@kernel
def sample_tick(handle, time, step, pose, q, row):
    """A sample of now, in the order of `climb_titles`.

    Args:
        handle: Holds `BodyWork`, and how many times larger the torques are that are given.
        time: Since the start [s].
        step: Number of the action that is carried out.
        pose, q: Of the body and of all joints as they really are, shape (3,) [m], [rad] and (n, 2) [rad]; without rows where nobody tells.
        row: Filled, shape (columns,).
    """
    work, load = opened(handle)
    row[0] = time
    row[1] = step
    at = 2
    for part in (work.settled, work.aimed, pose):
        row[at : at + part.size] = part
        at += part.size
    for joints, times in ((work.q, 1.0), (q, 1.0), (work.torques, load)):
        for i in range(joints.shape[0]):
            row[at] = times * joints[i, 0]
            row[at + 1] = times * joints[i, 1]
            at += 2
    n = work.jobs.size
    for i in range(n):
        row[at + i] = work.jobs[i].hold
        row[at + n + i] = work.jobs[i].mode == STANCE
