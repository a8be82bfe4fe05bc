r"""From the body to its limbs (Bevly 1997, 4.4): what each holding tip must do for what the body should do. Kernels.

A held limb pushes the body by pulling on its hold. The body's controller asks for an acceleration A of (x, y, theta) and a wrench W that is
fed forward; each holding limb gets an acceleration of its tip relative to the body and a force on its hold, limited so that a hook is never
pulled off, and its own law turns both into torques. Arrays have one row per limb; places are in the world unless a name says otherwise.
"""

import math

from ....compiled import inlined, kernel
from .hook_forces import pair_forces

THESIS = 0
"""The thesis's T for forces and accelerations alike."""
KINEMATIC = 1
"""Accelerations by the body's motion, -(a + alpha x r); forces by T."""
WRENCH = 2
"""What brings the body back to its aim is a wrench like the weight, shared with it; each limb damps by its own joints (ours)."""
LIMIT_NONE = 0
LIMIT_THESIS = 1
"""The commanded acceleration alone is kept along the grab direction."""
LIMIT_COUNTED = 2
"""What the fed-forward force does to the tip counts too."""
LIMIT_SHARED = 3
"""As counted, after the holding limbs pull against each other as far as both hooks need: the body's wrench stays."""
LIMIT_FEASIBLE = 4
"""Of forces only: two holding limbs share what is fed, and of what brings the body back a part, as hooks and motors can take it."""
FAR = 1e9
SQUEEZE = 12.0
"""Most that two limbs pull against each other [N]: a third of LIBRA's weight; more drags hooks sideways off their holds."""
NARROW = 0.05
"""Two holds nearer in x than this share the forces by least force instead of T, which divides by their distance [m]."""


@kernel
def distribute_wrench(held, arms, wrench, forces):
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
    for i in range(n):
        forces[i, 0] = 0.0
        forces[i, 1] = 0.0
    count, a, b = _pair(held)
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
def command_contact_forces(stance, held, asked, least, drags, cuts, pulls, forces):
    """What each holding tip is to do, in its port frame: an acceleration relative to the body, and a force on its hold.

    Args:
        stance: As `pair_forces` takes it.
        held: 1 for limbs that hold, shape (n,).
        asked: Acceleration of the body that is asked for, in the units of its gains, shape (3,), with WRENCH a wrench [N], [N m]; the
            wrench that is fed forward, such as the weight, shape (3,) [N], [N m]; THESIS, KINEMATIC or WRENCH; and LIMIT_NONE,
            LIMIT_THESIS, LIMIT_COUNTED, LIMIT_SHARED or LIMIT_FEASIBLE.
        least: alpha, the least acceleration along the grab direction, shape (n,).
        drags: Accelerations of the tips relative to the body that are asked for besides, world frame, shape (n, 2).
        cuts: Work space of `pair_forces`.
        pulls: Filled with accelerations, port frame, shape (n, 2).
        forces: Filled with forces of the tips on their holds, port frame, shape (n, 2) [N].
    """
    legs, q, pose, arms = stance
    wanted, fed, mapping, limit = asked
    distribute_wrench(held, arms, fed, forces)
    distribute_wrench(held, arms, wanted, pulls)
    count, a, b = _pair(held)
    feasible = limit == LIMIT_FEASIBLE and count == 2
    if feasible:
        pair_forces(stance, (a, b), ((fed[0], fed[1], fed[2]), _asked(mapping, wanted)), cuts, forces)
    for i in range(legs.size):
        if not held[i]:
            continue
        # the hold's force on the limb moves the body; the limb's on the hold is the opposite
        if mapping == THESIS:
            pulls[i, 0] = -pulls[i, 0]
            pulls[i, 1] = -pulls[i, 1]
        elif mapping == KINEMATIC:
            pulls[i, 0] = -(wanted[0] - wanted[2] * arms[i, 1])
            pulls[i, 1] = -(wanted[1] + wanted[2] * arms[i, 0])
        else:
            if not feasible:
                forces[i, 0] += pulls[i, 0]
                forces[i, 1] += pulls[i, 1]
            pulls[i, 0] = 0.0
            pulls[i, 1] = 0.0
    for i in range(legs.size):
        if held[i]:
            # a limb's own inertia takes up what damps it, so hooks do not feel it
            pulls[i, 0] += drags[i, 0]
            pulls[i, 1] += drags[i, 1]
            turn = -(pose[2] + legs[i].port_angle)
            _turn(pulls[i], turn)
            forces[i, 0] = -forces[i, 0]
            forces[i, 1] = -forces[i, 1]
            _turn(forces[i], turn)
    if limit == LIMIT_SHARED and count == 2:
        _squeeze(stance, (a, b), least, pulls, forces)
    for i in range(legs.size):
        if held[i] and limit not in (LIMIT_NONE, LIMIT_FEASIBLE) and legs[i].hooked:
            limit_pull(legs[i], q[i], limit, least[i], pulls[i], forces[i])


@inlined
def _asked(mapping, wanted):
    """What is asked for in newtons."""
    part = 1.0 if mapping == WRENCH else 0.0
    return part * wanted[0], part * wanted[1], part * wanted[2]


@kernel
def drag_tips(speeds, angle, arms, aim_speed, kd, drags):
    """What damps each tip's motion relative to the body towards the one that the body's aim has.

    Args:
        speeds: Of the tips in the body frame, shape (n, 2) [m/s].
        angle: Of the body [rad].
        arms: Holds less body, world frame, shape (n, 2) [m].
        aim_speed: Of the body's aim, shape (3,).
        kd: In the units of the gains.
        drags: Filled, world frame, shape (n, 2).
    """
    c = math.cos(angle)
    s = math.sin(angle)
    for i in range(arms.shape[0]):
        vx = c * speeds[i, 0] - s * speeds[i, 1]
        vy = s * speeds[i, 0] + c * speeds[i, 1]
        drags[i, 0] = -kd * (aim_speed[0] - aim_speed[2] * arms[i, 1] + vx)
        drags[i, 1] = -kd * (aim_speed[1] + aim_speed[2] * arms[i, 0] + vy)


@inlined
def _pair(held):
    """How many limbs hold, and the first and the last of them."""
    count = 0
    a = -1
    b = -1
    for i in range(held.size):
        if held[i]:
            count += 1
            b = i
            if a < 0:
                a = i
    return count, a, b


@kernel
def _squeeze(stance, pair, least, pulls, forces):
    """Let two holding limbs pull against each other along the line of their holds, as little as keeps both hooks on.

    Such a force moves the body nowhere, so what the body is asked to do stays as it is; clipping one limb's pull does not.
    """
    legs, q, pose, arms = stance
    a, b = pair
    ux = arms[b, 0] - arms[a, 0]
    uy = arms[b, 1] - arms[a, 1]
    length = math.hypot(ux, uy)
    if length < 1e-6:
        return
    low = -FAR
    high = FAR
    for i in (a, b):
        if not legs[i].hooked:
            continue
        lx, ly = _line(legs[i], pose, ux / length, uy / length, 1.0 if i == a else -1.0)
        slope = along_grab(legs[i], q[i], (lx, ly))
        lack = least[i] - (_dot_grab(legs[i], q[i], pulls[i]) + along_grab(legs[i], q[i], forces[i]))
        if slope > 1e-9:
            low = max(low, lack / slope)
        elif slope < -1e-9:
            high = min(high, lack / slope)
    if low > high:
        return
    size = min(min(max(0.0, low), high), SQUEEZE)
    size = max(size, -SQUEEZE)
    for i in (a, b):
        lx, ly = _line(legs[i], pose, ux / length, uy / length, 1.0 if i == a else -1.0)
        forces[i, 0] += size * lx
        forces[i, 1] += size * ly


@inlined
def _line(leg, pose, ux, uy, sign):
    """A world direction, times a sign, in a limb's port frame."""
    c = math.cos(pose[2] + leg.port_angle)
    s = math.sin(pose[2] + leg.port_angle)
    return sign * (c * ux + s * uy), sign * (c * uy - s * ux)


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
        leg: A record of `PLANAR_LIMB`.
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
