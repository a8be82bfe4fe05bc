"""What loads a limb's joints, and so which side of its play each rests on; how a free limb pulls. Kernels."""

import math

from ....compiled import inlined, kernel

SURE = 0.05
"""A load well above this puts a joint at one end of its play [N m]."""
MOVES = 0.03
"""A motor well above this speed turns, and its friction is all against it [rad/s]."""
RESTS = 0.1
"""Friction fed forward is full where a joint is to bring well above this [N m]."""


@kernel
def pull_torques(leg, joints, body, force, damping, torques, loads):
    """Torques with which a free limb pulls at what its tip meets: J^T F, its own weight and friction fed forward.

    Args:
        leg: A record of `PLANAR_LIMB`.
        joints: Their angles and speeds, shape (2,) each.
        body: Its pose and twist, shape (3,) each.
        force: Of the tip on what it meets, world frame, shape (2,) [N].
        damping: Of the tip's motion in the world [N s/m].
        torques: Filled, shape (2,) [N m].
        loads: Filled with what surely loads the joints' outputs while the tip stands still: weight and force less what friction of a
            motor that stands may take of it, shape (2,) [N m].
    """
    q, qd = joints
    pose, twist = body
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
    shoulder, elbow = weight_loads(leg, q, pose[2])
    # friction is fed the way the tip is to go, whichever way the limb's own weight pulls
    shoulder += push0 + leg.friction1 * math.tanh(push0 / RESTS)
    elbow += push1 + leg.friction2 * math.tanh(push1 / RESTS)
    loads[0] = _borne(shoulder, leg.friction1, qd[0])
    loads[1] = _borne(elbow, leg.friction2, qd[1])
    torques[0] = shoulder - damping * (j00 * vx + j10 * vy)
    torques[1] = elbow - damping * (j01 * vx + j11 * vy)


@inlined
def weight_loads(leg, q, angle):
    """Torques of shoulder and elbow that carry a free limb's own weight [N m]; `angle` is the body's."""
    first = angle + leg.port_angle + q[0]
    elbow = leg.heft2 * math.cos(first + q[1])
    return leg.heft1 * math.cos(first) + elbow, elbow


@kernel
def weight_moment(legs, q, angle):
    """Moment about the body's origin with which its holds carry the limbs' own weight, counterclockwise [N m].

    Args:
        legs: Records of `PLANAR_LIMB`, shape (n,).
        q: Joint angles, shape (n, 2) [rad].
        angle: Of the body [rad].
    """
    c = math.cos(angle)
    s = math.sin(angle)
    total = 0.0
    for i in range(legs.size):
        leg = legs[i]
        first = angle + leg.port_angle + q[i, 0]
        total += leg.weight * (c * leg.port_x - s * leg.port_y)
        total += leg.heft1 * math.cos(first) + leg.heft2 * math.cos(first + q[i, 1])
    return total


@kernel
def follow_play(legs, joints, angle, holding, pressing, rate, play, sure):
    """Let each joint's believed side of its play follow what loads it.

    A limb that holds is told no friction, so what loads a joint of it is its torque less the friction of a motor that turns, and anything
    within its friction of that while it stands: where this may be nothing, it says nothing of the side. The belief stays then, unsure.

    Args:
        legs: Records of `PLANAR_LIMB`, shape (n,).
        joints: Their angles and speeds, shape (n, 2) each.
        angle: Of the body [rad].
        holding: 1 for limbs that hold, shape (n,), and the forces of their tips on the holds, port frame, shape (n, 2) [N].
        pressing: 1 for limbs that press against something, shape (n,), and the torques at their joints' outputs, shape (n, 2) [N m];
            others bear their own weight.
        rate: Part of the rest of the way that it goes at a tick, and half the whole play [rad], shape (2,) or more.
        play: Changed, shape (n, 2) [rad].
        sure: How sure each side is, 0 to 1, changed, shape (n, 2) [-].
    """
    q, qd = joints
    held, forces = holding
    pressed, loads = pressing
    for i in range(legs.size):
        leg = legs[i]
        if held[i]:
            first = q[i, 0]
            second = q[i, 0] + q[i, 1] + leg.beta
            outer = leg.l2 * (math.cos(second) * forces[i, 1] - math.sin(second) * forces[i, 0])
            shoulder, elbow = weight_loads(leg, q[i], angle)
            inner = outer + leg.l1 * (math.cos(first) * forces[i, 1] - math.sin(first) * forces[i, 0])
            load = (_borne(shoulder + inner, leg.friction1, qd[i, 0]), _borne(elbow + outer, leg.friction2, qd[i, 1]))
        elif pressed[i]:
            load = (loads[i, 0], loads[i, 1])
        else:
            load = weight_loads(leg, q[i], angle)
        for k in range(2):
            side = math.tanh(load[k] / SURE)
            part = abs(side) if held[i] or pressed[i] else 1.0
            play[i, k] += part * rate[0] * (rate[1] * side - play[i, k])
            sure[i, k] += rate[0] * (abs(side) - sure[i, k])


@inlined
def _borne(torque, friction, speed):
    """What a motor's torque surely loads its joint with: less the friction of one that turns, or any up to it of one that stands."""
    turns = math.tanh(speed / MOVES)
    load = torque - friction * turns
    unknown = friction * (1.0 - abs(turns))
    return load - min(max(load, -unknown), unknown)
