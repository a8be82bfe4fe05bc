"""Where body and limbs of a stance are, and which way their elbows bend (page "The model", sections 1, 2 and 6)."""

import math

from ....compiled import inlined
from ....plane import wrap
from ....planning.problem.check import TOLERANCE
from ..robot.kinematics import solve_limb
from .records import holds, limbs


@inlined
def port_of(limb, s):
    """Port of a limb in the world [m]."""
    return s.x + s.c * limb.port_x - s.s * limb.port_y, s.y + s.s * limb.port_x + s.c * limb.port_y


@inlined
def place(p, s):
    """World pose of the stance from its ticks."""
    s.x = p.x0 + s.ix * p.tick
    s.y = p.y0 + s.iy * p.tick
    s.angle = wrap(p.a0 + s.ia * p.tick_angle)
    s.c = math.cos(s.angle)
    s.s = math.sin(s.angle)


@inlined
def tip_of(p, s, i):
    """Tip of limb i in the world [m]: at its hold, or where its foot rides with the body."""
    h = s.hold[i]
    if h >= 0:
        return holds(p)[h].x, holds(p)[h].y
    fx = s.foot[i, 0]
    fy = s.foot[i, 1]
    return s.x + s.c * fx - s.s * fy, s.y + s.s * fx + s.c * fy


@inlined
def solve(p, s, i):
    """Inverse kinematics of limb i at its present tip."""
    limb = limbs(p)[i]
    px, py = port_of(limb, s)
    tx, ty = tip_of(p, s, i)
    c_phi = s.c * limb.c_port - s.s * limb.s_port
    s_phi = s.s * limb.c_port + s.c * limb.s_port
    solve_limb(limb, px, py, c_phi, s_phi, tx, ty, s.solved[i])


@inlined
def count_holders(p, s):
    """Number of limbs on holds, and the last of them."""
    holders = 0
    last = -1
    for i in range(p.n_limbs):
        if s.hold[i] >= 0:
            holders += 1
            last = i
    return holders, last


@inlined
def usable(s, i, assignment):
    """Branches of limb i to choose from (bit set): a holder's of the assignment of elbows, if there is one, else those within limits.

    Where none is within joint limits: both.
    """
    if assignment >= 0 and s.hold[i] >= 0:
        return 1 << ((assignment >> i) & 1)
    within = 0
    for branch in range(2):
        if s.solved[i, 1 + 5 * branch] >= -TOLERANCE:
            within |= 1 << branch
    return within if within else 3


@inlined
def joint_torques(p, s, i, branch, fx, fy):
    """Torques of shoulder and elbow [N m] for a force of the hold on the tip: minus the moment about each joint."""
    px, py = port_of(limbs(p)[i], s)
    tx, ty = tip_of(p, s, i)
    at = 1 + 5 * branch
    ex = s.solved[i, at + 1]
    ey = s.solved[i, at + 2]
    return (ty - py) * fx - (tx - px) * fy, (ty - ey) * fx - (tx - ex) * fy


@inlined
def take_branch(p, s, i, options, fx, fy):
    """The branch of limb i that a force makes least of: less torque, then hook on top, then less at the elbow."""
    if options == 1:
        return 0
    if options == 2:
        return 1
    a1, a2 = joint_torques(p, s, i, 0, fx, fy)
    b1, b2 = joint_torques(p, s, i, 1, fx, fy)
    a = max(abs(a1), abs(a2))
    b = max(abs(b1), abs(b2))
    if abs(a - b) >= 1e-9:
        return 0 if a < b else 1
    down_a = s.solved[i, 5]
    down_b = s.solved[i, 10]
    if abs(down_a - down_b) > 1e-9:
        return 0 if down_a < down_b else 1
    return 1 if abs(b2) < abs(a2) - 1e-9 else 0


@inlined
def held(p, s, h):
    """Whether any limb holds hold h."""
    for i in range(p.n_limbs):
        if s.hold[i] == h:
            return True
    return False
