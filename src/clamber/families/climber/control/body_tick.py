"""A climber's whole control of one tick in two calls: where the body is, and the torques of all limbs. Kernels.

All that a tick works on comes in one handle. Laws are numbers here only inside the settings of the limbs' controllers (`drive`).
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ....compiled import carray, inlined, kernel, opened, pointer
from ....control.drive import BUFFERS_TORQUES, drive_packed
from ....types import Floats, Records
from .backlash import follow_play, pull_torques, weight_loads, weight_moment
from .body import WRENCH, command_contact_forces, drag_tips
from .body_estimate import estimate_body, in_world, part_passed, pass_load, place_in_world
from .planar_limb import CONTACT_PUSH, HANG, STANCE, SWING_CARTESIAN, UNLOADED_CONTACT

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
BENT = math.radians(12.0)
"""Where the soft stop of an elbow begins, before it is straight [rad]."""
STOP = 6.0
"""Its torque on a straight elbow, as much as a push of a hook makes there [N m]."""

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


class BodyWork(NamedTuple):
    """What a tick works on: a row a limb, shape (n, 2), where nothing else is said; a NamedTuple, as kernels take it."""

    legs: Records
    """Of `PLANAR_LIMB`, shape (n,)."""
    gains: Records
    """Of `BODY`, shape (1,)."""
    jobs: Records
    """Of `LIMB_TASK`, shape (n,)."""
    drives: NDArray[np.int64]
    """Of the laws that hold and of those that move: `Controller.buffers`, shape (2, n, CONTROLLER_BUFFERS)."""
    q: Floats
    qd: Floats
    lagged: Floats
    """Joint angles and speeds by the encoders, and those angles with the play counted [rad], [rad/s]."""
    held: NDArray[np.int64]
    weights: Floats
    """1 for limbs that hold, and how much each says about where the body is, shape (n,)."""
    holds: Floats
    arms: Floats
    """Holds in the world, and from the body to them [m]."""
    tips: Floats
    tip_speeds: Floats
    settled_tips: Floats
    spare_speeds: Floats
    """In the body frame by the encoders, and with the play counted [m], [m/s]."""
    pose: Floats
    twist: Floats
    settled: Floats
    spare_twist: Floats
    """Of the body, likewise, shape (3,)."""
    aimed: Floats
    aim_speed: Floats
    """Of the body, shape (3,)."""
    places: Floats
    felt_places: Floats
    place_speeds: Floats
    """Of the tips in the world, the play counted, by the encoders alone, and their speeds by those [m], [m/s]."""
    grabs: Floats
    """Where the hooks pull, world frame, unit vectors."""
    play: Floats
    sure: Floats
    """Lag of each joint's output [rad], and how sure that is [-]."""
    carriers: NDArray[np.int64]
    """1 for those that carry, before and after a hand-over, shape (2, n)."""
    handed: Floats
    """Of a hand-over, the time that has passed since it began, and that of a tick, each over that of all of it, shape (2,) [-]."""
    pulls: Floats
    forces: Floats
    old_pulls: Floats
    old_forces: Floats
    """What tips do for the body: by their motion and by their torques; and what they did before a hand-over [N]."""
    cuts: Floats
    drags: Floats
    least: Floats
    """As `command_contact_forces` takes them."""
    pressed: NDArray[np.int64]
    """1 for limbs that press against something, shape (n,)."""
    loads: Floats
    loads_now: Floats
    lag: Floats
    """As `follow_play` and `pull_torques` take them."""
    wanted: Floats
    fed: Floats
    """What the body is to be given, and of that what is fed forward, shape (3,)."""
    aim: Records
    states: Floats
    felt: Floats
    """What a limb's law is given: of `AIM`, shape (1,); joints; nothing."""
    torques: Floats
    """Filled [N m]."""


@kernel
def see_tick(handle, angle, angle_speed, angle_from):
    """Estimate where the body is, by the encoders alone and with the play of the joints counted; a hand-over goes on by a tick.

    Args:
        handle: Holds `BodyWork`.
        angle, angle_speed: Of the body by its own encoder [rad], [rad/s].
        angle_from: As in `estimate_body`.

    Returns:
        Whether a hand-over has ended: limbs that hold, and do not carry after it, are held for no holders any more.
    """
    work = opened(handle)[0]
    ended = pass_load(work)
    for i in range(work.legs.size):
        for k in range(2):
            work.lagged[i, k] = work.q[i, k] - work.play[i, k]
    joints, lagged = (work.q, work.qd), (work.lagged, work.qd)
    held, told = (work.weights, work.holds), (angle, angle_speed, angle_from)
    estimate_body(work.legs, joints, held, told, work.tips, work.tip_speeds, work.pose, work.twist)
    estimate_body(work.legs, lagged, held, told, work.settled_tips, work.spare_speeds, work.settled, work.spare_twist)
    for i in range(work.legs.size):
        place_in_world(work, i)
    return ended


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
            x, y = in_world(settled, tips[i, 0], tips[i, 1])
            fed[0] += job.tug[0]
            fed[1] += job.tug[1]
            fed[2] += (x - settled[0]) * job.tug[1] - (y - settled[1]) * job.tug[0]


@inlined
def _aim_limb(work, i):
    """Fill a limb's aim. To hold: a law with a gain of one, aimed one pull away, turns exactly that pull into torques."""
    job, leg, tip, aim, pose, twist = work.jobs[i], work.legs[i], work.tips[i], work.aim[0], work.pose, work.twist
    c = math.cos(leg.port_angle)
    s = math.sin(leg.port_angle)
    x = tip[0] - leg.port_x
    y = tip[1] - leg.port_y
    aim.place[0] = c * x + s * y
    aim.place[1] = -s * x + c * y
    if job.mode == STANCE:
        for k in range(2):
            aim.place[k] += work.pulls[i, k]
            aim.twist[k] = 0.0
            aim.wrench[k] = work.forces[i, k]
        return
    x, y = in_world(work.settled, work.settled_tips[i, 0], work.settled_tips[i, 1])
    x, y = _into_port(leg, pose, job.place[0] - x, job.place[1] - y)
    aim.place[0] += x
    aim.place[1] += y
    # the tip's speed by the body's own motion, which its joints need not follow
    c = math.cos(pose[2])
    s = math.sin(pose[2])
    vx, vy = work.tip_speeds[i, 0], work.tip_speeds[i, 1]
    ax = vx - twist[2] * tip[1]
    ay = vy + twist[2] * tip[0]
    x = twist[0] + c * ax - s * ay - (c * vx - s * vy)
    y = twist[1] + s * ax + c * ay - (s * vx + c * vy)
    x, y = _into_port(leg, pose, job.speed[0] - x, job.speed[1] - y)
    aim.twist[0] = x
    aim.twist[1] = y
    aim.wrench[0] = 0.0
    aim.wrench[1] = 0.0


@inlined
def _clinging(job, leg, q, settled_tip, pose, settled, cling):
    """What a limb that carries nothing does to its hold, world frame [N]: it pulls a little, and comes after it."""
    grab = pose[2] + leg.port_angle + q[0] + q[1] + leg.hook_angle
    x, y = in_world(settled, settled_tip[0], settled_tip[1])
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
def _wish(work):
    """What the body is to be given: what brings it to its aim, and the weight that is fed forward."""
    gains, pose, wanted = work.gains[0], work.pose, work.wanted
    for i in range(work.legs.size):
        for k in range(2):
            work.arms[i, k] = work.holds[i, k] - pose[k]
    for k in range(3):
        if gains.mapping == WRENCH:
            wanted[k] = gains.stiffness[k] * (work.aimed[k] - pose[k])
        else:
            wanted[k] = gains.kp[k] * (work.aimed[k] - pose[k]) + gains.kd[k] * (work.aim_speed[k] - work.twist[k])
    if gains.mapping == WRENCH:
        drag_tips(work.tip_speeds, pose[2], work.arms, work.aim_speed, gains.damping, work.drags)
    moment = weight_moment(work.legs, work.q, pose[2])
    _feed(work.jobs, work.settled_tips, work.settled, gains, moment, work.fed)


@inlined
def _command_contact_forces(work, carriers, pulls, forces):
    """What the tips of these carriers do for it."""
    gains, stance = work.gains[0], (work.legs, work.q, work.pose, work.arms)
    asked = work.wanted, work.fed, gains.mapping, gains.limit
    command_contact_forces(stance, carriers, asked, work.least, work.drags, work.cuts, pulls, forces)


@inlined
def _share(work):
    """What each holding tip does for the body; while the load passes, between what it did before and will do after."""
    pulls, forces, old_pulls, old_forces = work.pulls, work.forces, work.old_pulls, work.old_forces
    if work.handed[0] < 1.0:
        passed = part_passed(work.handed[0])
        _command_contact_forces(work, work.carriers[0], old_pulls, old_forces)
        _command_contact_forces(work, work.carriers[1], pulls, forces)
        for i in range(work.legs.size):
            for k in range(2):
                # cones are convex: between two loads that keep a hook on, all do
                pulls[i, k] += (1.0 - passed) * (old_pulls[i, k] - pulls[i, k])
                forces[i, k] += (1.0 - passed) * (old_forces[i, k] - forces[i, k])
    else:
        _command_contact_forces(work, work.held, pulls, forces)


@inlined
def _by_law(work, i, torques):
    """Torques of a limb whose law holds or moves its tip, its own weight carried; whether the law was given what is not finite."""
    leg, gains, job, q, qd = work.legs[i], work.gains[0], work.jobs[i], work.q, work.qd
    states, pose = work.states, work.pose
    states[0, 0, 0] = q[i, 0]
    states[0, 0, 1] = q[i, 1]
    states[0, 1, 0] = qd[i, 0]
    states[0, 1, 1] = qd[i, 1]
    _aim_limb(work, i)
    law = 0 if job.mode == STANCE else 1
    bad = drive_packed(work.drives[law, i], work.aim, states, work.felt, work.felt) >= 0
    given = carray(pointer(work.drives[law, i, BUFFERS_TORQUES]), 2, np.float64)
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
def _by_pull(work, i, torques):
    """Torques of a limb that pulls on something with a force, and what they say of the play's sides."""
    leg, gains, job, q, pose, loads_now = work.legs[i], work.gains[0], work.jobs[i], work.q, work.pose, work.loads_now
    if job.mode == UNLOADED_CONTACT:
        force = _clinging(job, leg, q[i], work.settled_tips[i], pose, work.settled, gains.cling)
        damping = CLING_DAMPING
    else:
        force = (job.force[0], job.force[1])
        damping = job.damping
    pull_torques(leg, (q[i], work.qd[i]), (pose, work.twist), force, damping, torques, loads_now)
    _even_out(work.loads[i], loads_now, work.lag[2])
    most = gains.firm if job.pressed else gains.gentle
    for k in range(2):
        torques[k] = min(max(torques[k], -most), most)


@inlined
def _rub(damping, friction, rate):
    """Torque that a joint's friction takes at a rate that is asked for [N m]."""
    return damping * rate + friction * math.tanh(rate / MOVING)


@inlined
def _by_joints(work, i, torques):
    """Torques of a limb whose joints go to angles, or hang there under a load."""
    leg, gains, job, q, qd = work.legs[i], work.gains[0], work.jobs[i], work.q, work.qd
    torques[0] = leg.share1 * (gains.joint_kp * (job.angles[0] - q[i, 0]) + gains.joint_kd * (job.rates[0] - qd[i, 0]))
    torques[1] = leg.share2 * (gains.joint_kp * (job.angles[1] - q[i, 1]) + gains.joint_kd * (job.rates[1] - qd[i, 1]))
    if job.mode == HANG:
        torques[0] += job.loads[0]
        torques[1] += job.loads[1]
    else:
        # by its model: a limb that lags leaves its way, and knocks against what it was to go round
        shoulder, elbow = weight_loads(leg, q[i], work.pose[2])
        torques[0] += leg.rotor1 * job.accelerations[0] + shoulder + _rub(leg.damping1, leg.friction1, job.rates[0])
        torques[1] += leg.rotor2 * job.accelerations[1] + elbow + _rub(leg.damping2, leg.friction2, job.rates[1])


@kernel
def command_tick(handle):
    """Torques of all limbs.

    Args:
        handle: Holds `BodyWork`.

    Returns:
        The first limb whose law was given something that is not finite, -1 where there is none.
    """
    work = opened(handle)[0]
    _wish(work)
    _share(work)
    bad = -1
    for i in range(work.legs.size):
        mode = work.jobs[i].mode
        if mode in (STANCE, SWING_CARTESIAN):
            if _by_law(work, i, work.torques[i]) and bad < 0:
                bad = i
        elif mode in (UNLOADED_CONTACT, CONTACT_PUSH):
            _by_pull(work, i, work.torques[i])
        else:
            _by_joints(work, i, work.torques[i])
        work.pressed[i] = mode == UNLOADED_CONTACT or (mode == CONTACT_PUSH and work.jobs[i].pressed != 0)
        side = work.jobs[i].side
        if side != 0:
            work.torques[i, 1] += side * STOP * max(0.0, 1.0 - side * work.q[i, 1] / BENT)
    holding, pressing = (work.held, work.forces), (work.pressed, work.loads)
    follow_play(work.legs, (work.q, work.qd), work.pose[2], holding, pressing, work.lag, work.play, work.sure)
    return bad
