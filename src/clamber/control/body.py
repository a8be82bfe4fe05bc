r"""From the body to its limbs (Bevly 1997, 4.4): where the body is, what it should do, and what each tip must do for that. Kernels.

A held limb pushes the body by pulling on its hold. The body's controller asks for an acceleration A of (x, y, theta) and a wrench W that is
fed forward; each holding limb gets an acceleration of its tip relative to the body and a force on its hold, limited so that a hook is never
pulled off, and its own law turns both into torques. Arrays have one row per limb; places are in the world unless a name says otherwise.
"""

import math

import numpy as np

from ..compiled import inlined, kernel

LEG = np.dtype(
    [
        ("port_x", "f8"),
        ("port_y", "f8"),
        ("port_angle", "f8"),
        ("l1", "f8"),
        ("l2", "f8"),  # the effective second link
        ("beta", "f8"),  # from the second link to the tip
        ("hook_angle", "f8"),  # from the second link's direction to the grab direction
        ("hooked", "i4"),  # 1: it can only pull along its grab direction
        ("share1", "f8"),  # K' of shoulder and elbow
        ("share2", "f8"),
        ("heft1", "f8"),  # torque of its own weight about the shoulder with the first link level [N m]
        ("heft2", "f8"),  # and about the elbow with the second link level
        ("friction1", "f8"),  # Coulomb friction of shoulder and elbow [N m]
        ("friction2", "f8"),
    ],
    align=True,
)
"""What the body's control knows of a limb with two joints."""

THESIS = 0
"""The thesis's T for forces and accelerations alike."""
KINEMATIC = 1
"""Accelerations by the body's motion, -(a + alpha x r); forces by T."""
LIMIT_NONE = 0
LIMIT_THESIS = 1
"""The commanded acceleration alone is kept along the grab direction."""
LIMIT_COUNTED = 2
"""What the fed-forward force does to the tip counts too."""
LIMIT_SHARED = 3
"""As counted, after the holding limbs pull against each other as far as both hooks need: the body's wrench stays."""
FAR = 1e9
SQUEEZE = 12.0
"""Most that two limbs pull against each other [N]: a third of LIBRA's weight; more drags hooks sideways off their holds."""
SURE = 0.05
"""A load well above this puts a joint at one end of its play [N m]."""
RESTS = 0.1
"""Friction fed forward is full where a joint is to bring well above this [N m]."""
NARROW = 0.05
"""Two holds nearer in x than this share the forces by least force instead of T, which divides by their distance [m]."""


@inlined
def place_tips(legs, q, tips):
    """Tips in the body frame, shape (n, 2) [m], from joint angles q, shape (n, 2)."""
    for i in range(legs.size):
        leg = legs[i]
        first = leg.port_angle + q[i, 0]
        second = first + q[i, 1] + leg.beta
        tips[i, 0] = leg.port_x + leg.l1 * math.cos(first) + leg.l2 * math.cos(second)
        tips[i, 1] = leg.port_y + leg.l1 * math.sin(first) + leg.l2 * math.sin(second)


@inlined
def move_tips(legs, q, qd, speeds):
    """Speeds of the tips in the body frame, shape (n, 2) [m/s]."""
    for i in range(legs.size):
        leg = legs[i]
        first = leg.port_angle + q[i, 0]
        second = first + q[i, 1] + leg.beta
        w1 = qd[i, 0]
        w2 = qd[i, 0] + qd[i, 1]
        speeds[i, 0] = -leg.l1 * math.sin(first) * w1 - leg.l2 * math.sin(second) * w2
        speeds[i, 1] = leg.l1 * math.cos(first) * w1 + leg.l2 * math.cos(second) * w2


@kernel
def estimate_body(legs, q, qd, held, holds, angle, angle_speed, with_encoder, tips, speeds, pose, twist):
    """Body pose and speed from the holding limbs.

    The angle is that of the seventh encoder, or that of the line between the tips of the first two holding limbs against the line of their
    holds (exact for any pair that is apart). The place is the mean over the holding limbs of hold less tip.

    Args:
        legs: Records of `LEG`, shape (n,).
        q, qd: Joint angles and speeds, shape (n, 2).
        held: 1 for limbs that hold, shape (n,).
        holds: Believed places of their holds, shape (n, 2) [m].
        angle, angle_speed: Of the body by its own encoder [rad], [rad/s].
        with_encoder: Whether to use those.
        tips, speeds: Filled with the tips in the body frame and their speeds, shape (n, 2).
        pose, twist: Filled, shape (3,) [m], [rad].

    Returns:
        Number of holding limbs. With none, or one and no encoder, the pose cannot be told and is left as it was.
    """
    place_tips(legs, q, tips)
    move_tips(legs, q, qd, speeds)
    count = 0
    a = -1
    b = -1
    for i in range(legs.size):
        if held[i]:
            count += 1
            if a < 0:
                a = i
            elif b < 0:
                b = i
    if count == 0 or (count == 1 and not with_encoder):
        return count
    if with_encoder:
        theta = angle
        omega = angle_speed
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
        if held[i]:
            rx = c * tips[i, 0] - s * tips[i, 1]
            ry = s * tips[i, 0] + c * tips[i, 1]
            x += holds[i, 0] - rx
            y += holds[i, 1] - ry
            vx -= c * speeds[i, 0] - s * speeds[i, 1] - omega * ry
            vy -= s * speeds[i, 0] + c * speeds[i, 1] + omega * rx
    pose[0] = x / count
    pose[1] = y / count
    pose[2] = theta
    twist[0] = vx / count
    twist[1] = vy / count
    twist[2] = omega
    return count


@kernel
def share_wrench(held, arms, wrench, forces):
    """Forces of the holds on the limbs that give the body a wrench.

    Two limbs apart in x: those of the thesis (4.8 to 4.12, with the moment of the x forces that it leaves out): x is shared evenly, y
    balances. Else the least forces; one limb carries the force and leaves the moment.

    Args:
        held: 1 for limbs that hold, shape (n,).
        arms: Holds less body, world frame, shape (n, 2) [m].
        wrench: Fx, Fy [N], M [N m].
        forces: Filled, shape (n, 2) [N].
    """
    n = held.size
    count = 0
    a = -1
    b = -1
    for i in range(n):
        forces[i, 0] = 0.0
        forces[i, 1] = 0.0
        if held[i]:
            count += 1
            if a < 0:
                a = i
            else:
                b = i
    if count == 0:
        return
    if count == 1:
        forces[a, 0] = wrench[0]
        forces[a, 1] = wrench[1]
        return
    wide = arms[a, 0] - arms[b, 0]
    if count == 2 and abs(wide) >= NARROW:
        half = 0.5 * (arms[a, 1] + arms[b, 1])
        forces[a, 0] = 0.5 * wrench[0]
        forces[b, 0] = 0.5 * wrench[0]
        forces[a, 1] = (half * wrench[0] - arms[b, 0] * wrench[1] + wrench[2]) / wide
        forces[b, 1] = (-half * wrench[0] + arms[a, 0] * wrench[1] - wrench[2]) / wide
        return
    # least forces: an even part, and a turn about the holds' middle
    mx = 0.0
    my = 0.0
    for i in range(n):
        if held[i]:
            mx += arms[i, 0] / count
            my += arms[i, 1] / count
    spread = 0.0
    for i in range(n):
        if held[i]:
            spread += (arms[i, 0] - mx) ** 2 + (arms[i, 1] - my) ** 2
    left = wrench[2] - (mx * wrench[1] - my * wrench[0])
    turn = left / spread if spread > 1e-9 else 0.0
    for i in range(n):
        if held[i]:
            forces[i, 0] = wrench[0] / count - turn * (arms[i, 1] - my)
            forces[i, 1] = wrench[1] / count + turn * (arms[i, 0] - mx)


@kernel
def command_tips(legs, q, held, pose, arms, wanted, fed, mapping, limit, least, pulls, forces):
    """What each holding tip is to do, in its port frame: an acceleration relative to the body, and a force on its hold.

    Args:
        legs: Records of `LEG`, shape (n,).
        q: Joint angles, shape (n, 2) [rad].
        held: 1 for limbs that hold, shape (n,).
        pose: Body pose, shape (3,).
        arms: Holds less body, world frame, shape (n, 2) [m].
        wanted: Acceleration of the body that is asked for, in the units of its gains, shape (3,).
        fed: Wrench that is fed forward, such as the weight, shape (3,) [N], [N m].
        mapping: THESIS or KINEMATIC.
        limit: LIMIT_NONE, LIMIT_THESIS or LIMIT_COUNTED (`limit_pull`).
        least: alpha, the least acceleration along the grab direction, shape (n,).
        pulls: Filled with accelerations, port frame, shape (n, 2).
        forces: Filled with forces of the tips on their holds, port frame, shape (n, 2) [N].
    """
    share_wrench(held, arms, wanted, pulls)
    share_wrench(held, arms, fed, forces)
    for i in range(legs.size):
        if not held[i]:
            continue
        # the hold's force on the limb moves the body; the limb's on the hold is the opposite
        if mapping == KINEMATIC:
            pulls[i, 0] = -(wanted[0] - wanted[2] * arms[i, 1])
            pulls[i, 1] = -(wanted[1] + wanted[2] * arms[i, 0])
        else:
            pulls[i, 0] = -pulls[i, 0]
            pulls[i, 1] = -pulls[i, 1]
        turn = -(pose[2] + legs[i].port_angle)
        _turn(pulls[i], turn)
        forces[i, 0] = -forces[i, 0]
        forces[i, 1] = -forces[i, 1]
        _turn(forces[i], turn)
    if limit == LIMIT_SHARED:
        _squeeze(legs, q, held, pose, arms, least, pulls, forces)
    for i in range(legs.size):
        if held[i] and limit != LIMIT_NONE and legs[i].hooked:
            limit_pull(legs[i], q[i], limit, least[i], pulls[i], forces[i])


@kernel
def _squeeze(legs, q, held, pose, arms, least, pulls, forces):
    """Let two holding limbs pull against each other along the line of their holds, as little as keeps both hooks on.

    Such a force moves the body nowhere, so what the body is asked to do stays as it is; clipping one limb's pull does not.
    """
    a = -1
    b = -1
    count = 0
    for i in range(legs.size):
        if held[i]:
            count += 1
            if a < 0:
                a = i
            else:
                b = i
    if count != 2:
        return
    ux = arms[b, 0] - arms[a, 0]
    uy = arms[b, 1] - arms[a, 1]
    length = math.hypot(ux, uy)
    if length < 1e-6:
        return
    low = -FAR
    high = FAR
    line = np.empty(2)
    for k in range(2):
        i = a if k == 0 else b
        if not legs[i].hooked:
            continue
        sign = 1.0 if k == 0 else -1.0
        line[0] = sign * ux / length
        line[1] = sign * uy / length
        _turn(line, -(pose[2] + legs[i].port_angle))
        slope = along_grab(legs[i], q[i], line)
        lack = least[i] - (_dot_grab(legs[i], q[i], pulls[i]) + along_grab(legs[i], q[i], forces[i]))
        if slope > 1e-9:
            low = max(low, lack / slope)
        elif slope < -1e-9:
            high = min(high, lack / slope)
    if low > high:
        return
    size = min(min(max(0.0, low), high), SQUEEZE)
    size = max(size, -SQUEEZE)
    for k in range(2):
        i = a if k == 0 else b
        sign = 1.0 if k == 0 else -1.0
        line[0] = sign * ux / length
        line[1] = sign * uy / length
        _turn(line, -(pose[2] + legs[i].port_angle))
        forces[i, 0] += size * line[0]
        forces[i, 1] += size * line[1]


@inlined
def _turn(vector, angle):
    c = math.cos(angle)
    s = math.sin(angle)
    x = vector[0]
    vector[0] = c * x - s * vector[1]
    vector[1] = s * x + c * vector[1]


@kernel
def limit_pull(leg, q, limit, least, pull, force):
    r"""Keep a hook on its hold (4.13 to 4.19): raise the pull's part along the grab direction g to at least alpha.

    With LIMIT_COUNTED the force that is fed forward counts as the acceleration it stands for, so that with the whole weight fed forward
    the body does not float up (ours): g'' >= alpha - g . (S^-1 F), S = J^-T K' J^-1.

    Args:
        leg: A record of `LEG`.
        q: Its joint angles, shape (2,).
        limit: LIMIT_THESIS or LIMIT_COUNTED.
        least: alpha.
        pull: Acceleration of the tip, port frame, shape (2,); changed.
        force: Force of the tip on the hold that is fed forward, port frame, shape (2,).
    """
    grab = q[0] + q[1] + leg.hook_angle
    gx = math.cos(grab)
    gy = math.sin(grab)
    floor = least
    if limit != LIMIT_THESIS:
        floor -= along_grab(leg, q, force)
    along = gx * pull[0] + gy * pull[1]
    if along < floor:
        pull[0] += (floor - along) * gx
        pull[1] += (floor - along) * gy


@inlined
def _dot_grab(leg, q, pull):
    grab = q[0] + q[1] + leg.hook_angle
    return math.cos(grab) * pull[0] + math.sin(grab) * pull[1]


@inlined
def along_grab(leg, q, force):
    """What a force of the tip, port frame, comes to as an acceleration along the grab direction: g . (J K'^-1 J^T F)."""
    first = q[0]
    second = q[0] + q[1] + leg.beta
    j10 = leg.l1 * math.cos(first) + leg.l2 * math.cos(second)
    j00 = -leg.l1 * math.sin(first) - leg.l2 * math.sin(second)
    j01 = -leg.l2 * math.sin(second)
    j11 = leg.l2 * math.cos(second)
    t0 = (j00 * force[0] + j10 * force[1]) / leg.share1
    t1 = (j01 * force[0] + j11 * force[1]) / leg.share2
    grab = q[0] + q[1] + leg.hook_angle
    return math.cos(grab) * (j00 * t0 + j01 * t1) + math.sin(grab) * (j10 * t0 + j11 * t1)


@kernel
def pull_torques(leg, q, qd, pose, twist, force, damping, torques, loads):
    """Torques with which a free limb pulls at what its tip meets: J^T F, its own weight and friction fed forward.

    Args:
        leg: A record of `LEG`.
        q, qd: Its joint angles and speeds, shape (2,).
        pose, twist: Of the body, shape (3,).
        force: Of the tip on what it meets, world frame, shape (2,) [N].
        damping: Of the tip's motion in the world [N s/m].
        torques: Filled, shape (2,) [N m].
        loads: Filled with the part that reaches the joints' outputs while the tip stands still, shape (2,) [N m].
    """
    first = pose[2] + leg.port_angle + q[0]
    second = first + q[1] + leg.beta
    j00 = -leg.l1 * math.sin(first) - leg.l2 * math.sin(second)
    j10 = leg.l1 * math.cos(first) + leg.l2 * math.cos(second)
    j01 = -leg.l2 * math.sin(second)
    j11 = leg.l2 * math.cos(second)
    c = math.cos(pose[2])
    s = math.sin(pose[2])
    px = c * leg.port_x - s * leg.port_y
    py = s * leg.port_x + c * leg.port_y
    vx = twist[0] + twist[2] * (j00 - py) + j00 * qd[0] + j01 * qd[1]
    vy = twist[1] + twist[2] * (j10 + px) + j10 * qd[0] + j11 * qd[1]
    push0 = j00 * force[0] + j10 * force[1]
    push1 = j01 * force[0] + j11 * force[1]
    weight_loads(leg, q, pose[2], loads)
    loads[0] += push0
    loads[1] += push1
    # friction is fed the way the tip is to go, whichever way the limb's own weight pulls
    torques[0] = loads[0] - damping * (j00 * vx + j10 * vy) + leg.friction1 * math.tanh(push0 / RESTS)
    torques[1] = loads[1] - damping * (j01 * vx + j11 * vy) + leg.friction2 * math.tanh(push1 / RESTS)


@inlined
def weight_loads(leg, q, angle, loads):
    """Torques that carry a free limb's own weight, shape (2,) [N m]; `angle` is the body's."""
    first = angle + leg.port_angle + q[0]
    loads[1] = leg.heft2 * math.cos(first + q[1])
    loads[0] = leg.heft1 * math.cos(first) + loads[1]


@kernel
def follow_play(legs, q, held, forces, angle, pressed, loads, rate, play):
    """Let each joint's believed side of its play follow what loads it.

    Args:
        legs: Records of `LEG`, shape (n,).
        q: Joint angles, shape (n, 2).
        held: 1 for limbs that hold, loaded by `forces`, shape (n,).
        forces: Of the tips on their holds, port frame, shape (n, 2) [N].
        angle: Of the body [rad].
        pressed: 1 for limbs that press against something with `loads`; others bear their own weight, shape (n,).
        loads: Torques at the joints' outputs, shape (n, 2) [N m].
        rate: Part of the rest of the way that it goes at a tick, and half the whole play [rad], shape (2,).
        play: Changed, shape (n, 2) [rad].
    """
    load = np.empty(2)
    for i in range(legs.size):
        leg = legs[i]
        if held[i]:
            first = q[i, 0]
            second = q[i, 0] + q[i, 1] + leg.beta
            load[1] = leg.l2 * (math.cos(second) * forces[i, 1] - math.sin(second) * forces[i, 0])
            load[0] = load[1] + leg.l1 * (math.cos(first) * forces[i, 1] - math.sin(first) * forces[i, 0])
        elif pressed[i]:
            load[:] = loads[i]
        else:
            weight_loads(leg, q[i], angle, load)
        for k in range(2):
            play[i, k] += rate[0] * (rate[1] * math.tanh(load[k] / SURE) - play[i, k])
