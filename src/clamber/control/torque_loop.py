r"""Joint friction rejected by a sensor of force, at the mount (Morel and Dubowsky 1996) or at the wrist (Williams 1995; Bevly 1997, 3.3.3).

What the limb does to its mount tells the torque that each gear passes on to its link: nothing between gear and mount can hide,

.. math:: \tau_{link,j} = z_j \cdot \Big(-M + p_j \times F + \sum_{k<j} (c_k - p_j) \times m_k g\Big)

with (F, M) the wrench on the mount about the base, p_j and z_j place and axis of joint j, and the weight of the links before it; the same
sum over all links is the wrench at the tip, which then stands in for that of a wrist sensor. From the wrist it is J^T F and the links'
weight, if that is fed forward. The links' acceleration is left out: they are light and slow. What the motor's torque does not turn into
that torque or into speed of the rotor, I_j qd, is friction: r, an estimate of it with the bandwidth k, is added to the torque that the law
asks for,

.. math:: \dot s = \tau_{motor} - \tau_{link} - \hat\tau_f - r, \quad r = k (s - I \dot q),
    \quad \tau_{motor} = \tau_{law} + \hat\tau_f + r,

where \hat\tau_f is the friction that is fed forward anyhow. The rotor's own inertia is not compensated, so the law's gains keep their
meaning, and the estimate settles as 1/k whatever the limb touches.
"""

from ..compiled import inlined
from .kinematics import AXIS, CENTRE, PLACE
from .law_state import BIAS, FRICTION, JACOBIAN, LINK, TORQUE

NOWHERE = 0
AT_BASE = 1
AT_WRIST = 2


@inlined
def read_mount(joints, root, frames, tip, mount, out, wrench):
    """Torque that each gear passes on to its link, and wrench of the tip on what it touches, from that of the limb on its mount.

    Args:
        joints, root: The chain.
        frames: As `place_chain` left them.
        tip: Where the tip is.
        mount: Force and moment about the origin of the base frame, shape (6,).
        out: Filled with torques, shape (n,) [N m], or [N] where a joint slides.
        wrench: Filled with that of the tip, base frame, shape (6,).
    """
    g = root[0].gravity
    fx = -mount[0]
    fy = -mount[1]
    fz = -mount[2]
    mx = -mount[3]  # about the base's origin
    my = -mount[4]
    mz = -mount[5]
    for j in range(joints.size):
        row = frames[j]
        if joints[j].sliding:
            out[j] = fx * row[AXIS] + fy * row[AXIS + 1] + fz * row[AXIS + 2]
        else:
            px = row[PLACE]
            py = row[PLACE + 1]
            pz = row[PLACE + 2]
            out[j] = (
                (mx - py * fz + pz * fy) * row[AXIS]
                + (my - pz * fx + px * fz) * row[AXIS + 1]
                + (mz - px * fy + py * fx) * row[AXIS + 2]
            )
        mass = joints[j].mass
        cx = row[CENTRE]
        cy = row[CENTRE + 1]
        cz = row[CENTRE + 2]
        fx += mass * g[0]
        fy += mass * g[1]
        fz += mass * g[2]
        mx += mass * (cy * g[2] - cz * g[1])
        my += mass * (cz * g[0] - cx * g[2])
        mz += mass * (cx * g[1] - cy * g[0])
    wrench[0] = fx
    wrench[1] = fy
    wrench[2] = fz
    wrench[3] = mx - tip[1] * fz + tip[2] * fy
    wrench[4] = my - tip[2] * fx + tip[0] * fz
    wrench[5] = mz - tip[0] * fy + tip[1] * fx


@inlined
def link_torques_by_wrist(n, felt, lines, squares):
    """The same from the wrench of the tip on what it touches, into `lines[LINK]`."""
    jacobian = squares[JACOBIAN]
    for j in range(n):
        total = lines[BIAS, j]
        for i in range(6):
            total += jacobian[i, j] * felt[i]
        lines[LINK, j] = total


@inlined
def add_friction_felt(joints, settings, qd, sums, lines):
    """Add r to `lines[TORQUE]`; `sums` is s by joint, kept from tick to tick."""
    for j in range(joints.size):
        lines[TORQUE, j] += _felt(joints[j], settings, qd[j], sums[j])


@inlined
def sum_up(joints, settings, qd, applied, sums, lines):
    """Move s on by a tick: `applied` are the torques within the motors' limits, `lines[LINK]` those that the links got."""
    for j in range(joints.size):
        felt = _felt(joints[j], settings, qd[j], sums[j])
        sums[j] += settings.period * (applied[j] - lines[LINK, j] - lines[FRICTION, j] - felt)


@inlined
def _felt(joint, settings, speed, total):
    friction = settings.torque_gain * (total - joint.rotor * speed)
    return min(max(friction, -settings.torque_limit), settings.torque_limit)
