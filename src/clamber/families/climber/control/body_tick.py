"""A climber's whole control of one tick in two calls: where the body is, and the torques of all limbs. Kernels.

Thirty arrays cost more to hand over than a tick, so they come as one table of addresses; their owner keeps them alive. One row a limb. Laws
are numbers here only inside the settings of the limbs' controllers (`drive`).
"""

import math

import numpy as np

from ....compiled import carray, inlined, kernel, pointer
from ....control.drive import BUFFERS_TORQUES, CONTROLLER_BUFFERS, drive_packed
from ....control.records import AIM, AXES
from .backlash import follow_play, pull_torques, weight_loads, weight_moment
from .body import WRENCH, command_contact_forces, drag_tips
from .body_estimate import estimate_body
from .hook_forces import MOST_CUTS
from .planar_limb import PLANAR_LIMB

STANCE, UNLOADED_CONTACT, SWING_CARTESIAN, SWING_JOINT, CONTACT_PUSH, HANG = range(6)
"""Modes of a limb."""
CLING_DAMPING = 60.0
"""Of the tip of a limb that clings [N s/m]."""
CLING_STIFFNESS = 1500.0
"""Towards its hold from where it is more than `CLING_SLACK` off, so that friction does not leave it behind a moving body [N/m]."""
CLING_SLACK = 0.003
"""What a map and the play of joints make of a tip that is on its hold [m]."""
CLING_MOST = 15.0
"""Of that pull [N]."""
MOVING = 0.05
"""A free limb's joint that is to turn faster than this rubs with all of its Coulomb friction [rad/s]."""

BODY = np.dtype(
    [
        ("mapping", "i4"),
        ("limit", "i4"),
        ("kp", "f8", (3,)),
        ("kd", "f8", (3,)),
        ("stiffness", "f8", (3,)),
        ("damping", "f8"),
        ("joint_kp", "f8"),
        ("joint_kd", "f8"),
        ("cling", "f8"),
        ("gentle", "f8"),
        ("firm", "f8"),
        ("weight", "f8"),  # of the whole robot [N]
        ("weight_fed", "f8"),  # part of it that is fed forward
    ],
    align=True,
)
"""Gains of body and limbs."""
LIMB_TASK = np.dtype(
    [
        ("mode", "i4"),
        ("pressed", "i4"),  # of CONTACT_PUSH: whether the tip has stopped against something
        ("place", "f8", (2,)),  # of CLING: the hold, of SWING_CARTESIAN: the aim, world frame
        ("speed", "f8", (2,)),  # of that aim
        ("angles", "f8", (2,)),  # of SWING_JOINT and HANG
        ("rates", "f8", (2,)),
        ("accelerations", "f8", (2,)),  # of SWING_JOINT
        ("loads", "f8", (2,)),  # of HANG: torques besides
        ("force", "f8", (2,)),  # of CONTACT_PUSH: of the tip on what it meets, world frame
        ("tug", "f8", (2,)),  # the steady part of that, which the body leans on
        ("damping", "f8"),
    ],
    align=True,
)
"""What one limb is to do."""

# places in the table of addresses
(
    LEGS, SETTINGS, JOBS, DRIVES, Q, QD, LAGGED, HELD, WEIGHTS, HOLDS, ARMS, TIPS, TIP_SPEEDS, POSE, TWIST, AIMED, AIM_SPEED, PLAY,
    SETTLED_TIPS, SETTLED, SPARE_SPEEDS, SPARE_TWIST, CARRIERS, PULLS, FORCES, OLD_PULLS, OLD_FORCES, CUTS, DRAGS, LEAST, PRESSED,
    LOADS, LOADS_NOW, LAG, WANTED, FED, LIMB_AIM, STATES, FELT, TORQUES, SURE, LIMBS,
) = range(42)  # fmt: skip
TABLE = 42


@inlined
def _rows(table, place, width):
    return carray(pointer(table[place]), (table[LIMBS], width), np.float64)


@inlined
def _line(table, place, size):
    return carray(pointer(table[place]), size, np.float64)


@kernel
def see_tick(table, angle, angle_speed, angle_from):
    """Estimate where the body is, by the encoders alone and with the play of the joints counted.

    Args:
        table: Addresses, shape (TABLE,).
        angle, angle_speed: Of the body by its own encoder [rad], [rad/s].
        angle_from: As in `estimate_body`.
    """
    n = table[LIMBS]
    legs = carray(pointer(table[LEGS]), n, PLANAR_LIMB)
    q = _rows(table, Q, 2)
    qd = _rows(table, QD, 2)
    lagged = _rows(table, LAGGED, 2)
    play = _rows(table, PLAY, 2)
    weights = _line(table, WEIGHTS, n)
    holds = _rows(table, HOLDS, 2)
    for i in range(n):
        for k in range(2):
            lagged[i, k] = q[i, k] - play[i, k]
    estimate_body(
        legs, q, qd, weights, holds, angle, angle_speed, angle_from,
        _rows(table, TIPS, 2), _rows(table, TIP_SPEEDS, 2), _line(table, POSE, 3), _line(table, TWIST, 3),
    )  # fmt: skip
    estimate_body(
        legs, lagged, qd, weights, holds, angle, angle_speed, angle_from,
        _rows(table, SETTLED_TIPS, 2), _rows(table, SPARE_SPEEDS, 2), _line(table, SETTLED, 3), _line(table, SPARE_TWIST, 3),
    )  # fmt: skip


@inlined
def _in_world(settled, x, y):
    """A place of the body frame in the world."""
    c = math.cos(settled[2])
    s = math.sin(settled[2])
    return settled[0] + c * x - s * y, settled[1] + s * x + c * y


@inlined
def _into_port(leg, pose, x, y):
    """A direction of the world in a limb's port frame."""
    c = math.cos(-(pose[2] + leg.port_angle))
    s = math.sin(-(pose[2] + leg.port_angle))
    return c * x - s * y, s * x + c * y


@inlined
def _feed(jobs, tips, settled, gains, moment, fed):
    """The wrench on the body that the holding limbs bring in any case: the weight, less what tugging limbs already carry."""
    fed[0] = 0.0
    fed[1] = gains.weight_fed * gains.weight
    fed[2] = gains.weight_fed * moment
    for i in range(jobs.size):
        job = jobs[i]
        if job.mode == CONTACT_PUSH:
            x, y = _in_world(settled, tips[i, 0], tips[i, 1])
            fed[0] += job.tug[0]
            fed[1] += job.tug[1]
            fed[2] += (x - settled[0]) * job.tug[1] - (y - settled[1]) * job.tug[0]


@inlined
def _aim_limb(job, leg, tip, tip_speed, settled_tip, pose, twist, settled, pull, force, aim):
    """Fill a limb's aim. To hold: a law with a gain of one, aimed one pull away, turns exactly that pull into torques."""
    c = math.cos(leg.port_angle)
    s = math.sin(leg.port_angle)
    x = tip[0] - leg.port_x
    y = tip[1] - leg.port_y
    aim.place[0] = c * x + s * y
    aim.place[1] = -s * x + c * y
    if job.mode == STANCE:
        aim.place[0] += pull[0]
        aim.place[1] += pull[1]
        aim.twist[0] = 0.0
        aim.twist[1] = 0.0
        aim.wrench[0] = force[0]
        aim.wrench[1] = force[1]
        return
    x, y = _in_world(settled, settled_tip[0], settled_tip[1])
    x, y = _into_port(leg, pose, job.place[0] - x, job.place[1] - y)
    aim.place[0] += x
    aim.place[1] += y
    # the tip's speed by the body's own motion, which its joints need not follow
    c = math.cos(pose[2])
    s = math.sin(pose[2])
    ax = tip_speed[0] - twist[2] * tip[1]
    ay = tip_speed[1] + twist[2] * tip[0]
    x = twist[0] + c * ax - s * ay - (c * tip_speed[0] - s * tip_speed[1])
    y = twist[1] + s * ax + c * ay - (s * tip_speed[0] + c * tip_speed[1])
    x, y = _into_port(leg, pose, job.speed[0] - x, job.speed[1] - y)
    aim.twist[0] = x
    aim.twist[1] = y
    aim.wrench[0] = 0.0
    aim.wrench[1] = 0.0


@inlined
def _clinging(job, leg, q, settled_tip, pose, settled, cling):
    """What a limb that carries nothing does to its hold, world frame [N]: it pulls a little, and comes after it."""
    grab = pose[2] + leg.port_angle + q[0] + q[1] + leg.hook_angle
    x, y = _in_world(settled, settled_tip[0], settled_tip[1])
    x = job.place[0] - x
    y = job.place[1] - y
    far = math.hypot(x, y)
    slope = min(CLING_STIFFNESS * max(far - CLING_SLACK, 0.0), CLING_MOST) / max(far, 1e-9)
    return cling * math.cos(grab) + x * slope, cling * math.sin(grab) + y * slope


@inlined
def _even_out(loads, now, part):
    """Let the loads of a limb that presses against something follow those of now by a part of the way."""
    for k in range(2):
        loads[k] += part * (now[k] - loads[k])


@inlined
def _wish(table):
    """What the body is to be given: what brings it to its aim, and the weight that is fed forward."""
    n = table[LIMBS]
    legs = carray(pointer(table[LEGS]), n, PLANAR_LIMB)
    gains = carray(pointer(table[SETTINGS]), 1, BODY)[0]
    holds = _rows(table, HOLDS, 2)
    arms = _rows(table, ARMS, 2)
    pose = _line(table, POSE, 3)
    twist = _line(table, TWIST, 3)
    aimed = _line(table, AIMED, 3)
    aim_speed = _line(table, AIM_SPEED, 3)
    wanted = _line(table, WANTED, 3)
    for i in range(n):
        arms[i, 0] = holds[i, 0] - pose[0]
        arms[i, 1] = holds[i, 1] - pose[1]
    for k in range(3):
        if gains.mapping == WRENCH:
            wanted[k] = gains.stiffness[k] * (aimed[k] - pose[k])
        else:
            wanted[k] = gains.kp[k] * (aimed[k] - pose[k]) + gains.kd[k] * (aim_speed[k] - twist[k])
    if gains.mapping == WRENCH:
        drag_tips(_rows(table, TIP_SPEEDS, 2), pose[2], arms, aim_speed, gains.damping, _rows(table, DRAGS, 2))
    moment = weight_moment(legs, _rows(table, Q, 2), pose[2])
    _feed(
        carray(pointer(table[JOBS]), n, LIMB_TASK), _rows(table, SETTLED_TIPS, 2), _line(table, SETTLED, 3), gains, moment,
        _line(table, FED, 3),
    )  # fmt: skip


@inlined
def _command_contact_forces(table, carriers, pulls, forces):
    """What the tips of these carriers do for it."""
    n = table[LIMBS]
    gains = carray(pointer(table[SETTINGS]), 1, BODY)[0]
    command_contact_forces(
        carray(pointer(table[LEGS]), n, PLANAR_LIMB), _rows(table, Q, 2), carriers, _line(table, POSE, 3), _rows(table, ARMS, 2),
        _line(table, WANTED, 3), _line(table, FED, 3), gains.mapping, gains.limit, _line(table, LEAST, n),
        _rows(table, DRAGS, 2), carray(pointer(table[CUTS]), (MOST_CUTS, 2), np.float64), pulls, forces,
    )  # fmt: skip


@inlined
def _share(table, handed):
    """What each holding tip does for the body; while the load passes, between what it did before and will do after."""
    n = table[LIMBS]
    pulls = _rows(table, PULLS, 2)
    forces = _rows(table, FORCES, 2)
    if handed < 1.0:
        carriers = carray(pointer(table[CARRIERS]), (2, n), np.int64)
        old_pulls = _rows(table, OLD_PULLS, 2)
        old_forces = _rows(table, OLD_FORCES, 2)
        _command_contact_forces(table, carriers[0], old_pulls, old_forces)
        _command_contact_forces(table, carriers[1], pulls, forces)
        for i in range(n):
            for k in range(2):
                # cones are convex: between two loads that keep a hook on, all do
                pulls[i, k] += (1.0 - handed) * (old_pulls[i, k] - pulls[i, k])
                forces[i, k] += (1.0 - handed) * (old_forces[i, k] - forces[i, k])
    else:
        _command_contact_forces(table, carray(pointer(table[HELD]), n, np.int64), pulls, forces)


@inlined
def _by_law(table, i, torques):
    """Torques of a limb whose law holds or moves its tip, its own weight carried; whether the law was given what is not finite."""
    n = table[LIMBS]
    leg = carray(pointer(table[LEGS]), n, PLANAR_LIMB)[i]
    gains = carray(pointer(table[SETTINGS]), 1, BODY)[0]
    job = carray(pointer(table[JOBS]), n, LIMB_TASK)[i]
    drives = carray(pointer(table[DRIVES]), (2, n, CONTROLLER_BUFFERS), np.int64)
    aims = carray(pointer(table[LIMB_AIM]), 1, AIM)
    states = carray(pointer(table[STATES]), (1, 2, 2), np.float64)
    felt = carray(pointer(table[FELT]), (1, AXES), np.float64)
    q = _rows(table, Q, 2)
    qd = _rows(table, QD, 2)
    pose = _line(table, POSE, 3)
    states[0, 0, 0] = q[i, 0]
    states[0, 0, 1] = q[i, 1]
    states[0, 1, 0] = qd[i, 0]
    states[0, 1, 1] = qd[i, 1]
    _aim_limb(
        job, leg, _rows(table, TIPS, 2)[i], _rows(table, TIP_SPEEDS, 2)[i], _rows(table, SETTLED_TIPS, 2)[i], pose,
        _line(table, TWIST, 3), _line(table, SETTLED, 3), _rows(table, PULLS, 2)[i], _rows(table, FORCES, 2)[i], aims[0],
    )  # fmt: skip
    law = 0 if job.mode == STANCE else 1
    bad = drive_packed(drives[law, i], aims, states, felt, felt) >= 0
    given = carray(pointer(drives[law, i, BUFFERS_TORQUES]), 2, np.float64)
    part = 1.0
    if job.mode == SWING_CARTESIAN:
        # a joint cut alone would turn the force at the tip, and wedge a hook on the hold that it leaves
        part = min(1.0, gains.gentle / max(abs(given[0]), abs(given[1]), 1e-9))
    # carried however the body is turned, which the law does not know
    shoulder, elbow = weight_loads(leg, q[i], pose[2])
    torques[0] = part * given[0] + shoulder
    torques[1] = part * given[1] + elbow
    return bad


@inlined
def _by_pull(table, i, torques):
    """Torques of a limb that pulls on something with a force, and what they say of the play's sides."""
    n = table[LIMBS]
    leg = carray(pointer(table[LEGS]), n, PLANAR_LIMB)[i]
    gains = carray(pointer(table[SETTINGS]), 1, BODY)[0]
    job = carray(pointer(table[JOBS]), n, LIMB_TASK)[i]
    q = _rows(table, Q, 2)
    qd = _rows(table, QD, 2)
    pose = _line(table, POSE, 3)
    loads_now = _line(table, LOADS_NOW, 2)
    if job.mode == UNLOADED_CONTACT:
        force = _clinging(
            job, leg, q[i], _rows(table, SETTLED_TIPS, 2)[i], pose, _line(table, SETTLED, 3), gains.cling
        )  # fmt: skip
        damping = CLING_DAMPING
    else:
        force = (job.force[0], job.force[1])
        damping = job.damping
    pull_torques(leg, q[i], qd[i], pose, _line(table, TWIST, 3), force, damping, torques, loads_now)
    _even_out(_rows(table, LOADS, 2)[i], loads_now, _line(table, LAG, 3)[2])
    most = gains.firm if job.pressed else gains.gentle
    for k in range(2):
        torques[k] = min(max(torques[k], -most), most)


@inlined
def _rub(damping, friction, rate):
    """Torque that a joint's friction takes at a rate that is asked for [N m]."""
    return damping * rate + friction * math.tanh(rate / MOVING)


@inlined
def _by_joints(table, i, torques):
    """Torques of a limb whose joints go to angles, or hang there under a load."""
    n = table[LIMBS]
    leg = carray(pointer(table[LEGS]), n, PLANAR_LIMB)[i]
    gains = carray(pointer(table[SETTINGS]), 1, BODY)[0]
    job = carray(pointer(table[JOBS]), n, LIMB_TASK)[i]
    q = _rows(table, Q, 2)
    qd = _rows(table, QD, 2)
    torques[0] = leg.share1 * (gains.joint_kp * (job.angles[0] - q[i, 0]) + gains.joint_kd * (job.rates[0] - qd[i, 0]))
    torques[1] = leg.share2 * (gains.joint_kp * (job.angles[1] - q[i, 1]) + gains.joint_kd * (job.rates[1] - qd[i, 1]))
    if job.mode == HANG:
        torques[0] += job.loads[0]
        torques[1] += job.loads[1]
    else:
        # by its model: a limb that lags leaves its way, and knocks against what it was to go round
        shoulder, elbow = weight_loads(leg, q[i], _line(table, POSE, 3)[2])
        torques[0] += leg.rotor1 * job.accelerations[0] + shoulder + _rub(leg.damping1, leg.friction1, job.rates[0])
        torques[1] += leg.rotor2 * job.accelerations[1] + elbow + _rub(leg.damping2, leg.friction2, job.rates[1])


@kernel
def command_tick(table, handed):
    """Torques of all limbs.

    Args:
        table: Addresses, shape (TABLE,).
        handed: Part of the load that has passed from the carriers of before to those of after; 1 where it is not passing.

    Returns:
        The first limb whose law was given something that is not finite, -1 where there is none.
    """
    n = table[LIMBS]
    jobs = carray(pointer(table[JOBS]), n, LIMB_TASK)
    pressed = carray(pointer(table[PRESSED]), n, np.int64)
    torques = _rows(table, TORQUES, 2)
    _wish(table)
    _share(table, handed)
    bad = -1
    for i in range(n):
        mode = jobs[i].mode
        if mode in (STANCE, SWING_CARTESIAN):
            if _by_law(table, i, torques[i]) and bad < 0:
                bad = i
        elif mode in (UNLOADED_CONTACT, CONTACT_PUSH):
            _by_pull(table, i, torques[i])
        else:
            _by_joints(table, i, torques[i])
        pressed[i] = mode == UNLOADED_CONTACT or (mode == CONTACT_PUSH and jobs[i].pressed != 0)
    follow_play(
        carray(pointer(table[LEGS]), n, PLANAR_LIMB), _rows(table, Q, 2), _rows(table, QD, 2),
        carray(pointer(table[HELD]), n, np.int64), _rows(table, FORCES, 2), _line(table, POSE, 3)[2], pressed,
        _rows(table, LOADS, 2), _line(table, LAG, 3), _rows(table, PLAY, 2), _rows(table, SURE, 2),
    )  # fmt: skip
    return bad
