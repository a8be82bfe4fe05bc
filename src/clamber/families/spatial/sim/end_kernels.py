"""What a robot feels, as kernels: its sensors, which hold is nearest, wrenches on tips, and whether these hold."""

import math

import numpy as np

from ....compiled import inlined, kernel, opened
from ....sim.electronics import limit_torques
from ..control.turn_kernels import write_axes

CONE, PAD, HOOK, SPINE = range(4)
FORMS = {"cone": CONE, "pad": PAD, "hook": HOOK, "spine": SPINE}
"""Forms of `contacts.Strength`, by their words."""
HOLDS, SLIPS, PULLED, PRESSED, BENT, TWISTED, PEELED, LEFT, DRAWN = range(9)
WORDS = (
    "holds",
    "slips",
    "pulled off",
    "pressed",
    "bent off",
    "twisted off",
    "peeled off",
    "left its bed",
    "drawn off",
)
"""What became of an end effector."""
END = np.dtype(
    [
        ("form", "i8"),
        ("friction", "f8"),
        ("pull", "f8"),
        ("press", "f8"),
        ("bending", "f8"),
        ("twisting", "f8"),
        ("half1", "f8"),
        ("half2", "f8"),
        ("slope", "f8"),  # tangent of a hook's opening or of a spine's angle
        ("moments", "i8"),
        ("touch", "f8"),  # forces below it neither slip nor leave where nothing pulls [N]
        ("capture", "f8"),  # from how far it attaches [m], 0: it only pushes
        ("near", "f8"),  # from how far what is to attach is looked at [m]
        ("nearest", "i8"),  # index of the hold whose patch is nearest, -1: there is none
        ("gap", "f8"),  # distance from that patch [m]
        ("under", "i8"),  # index of the hold whose patch is beneath it
        ("wanted", "i8"),  # 1: it is to attach
        ("spent", "i8"),  # 1: its attempt has failed, or it has come off since it was told to
        ("sunk", "i8"),  # 1: its tip may come into the recess beneath it
        # while it is attached
        ("hold", "i8"),  # index, -1: to none
        ("mu", "f8"),
        ("held", "f8"),  # pull of end effector and hold [N]
        ("normal", "f8", (3,)),  # out of the surface, world frame
        ("first", "f8", (3,)),  # tangents of the contact's frame at the last reading, world frame
        ("second", "f8", (3,)),
        ("over", "i8"),  # ticks in a row for which it bore too much
    ],
    align=True,
)
"""An end effector as kernels read it."""


@kernel
def what_gives(end, n, f1, f2, mn, m1, m2):
    """What of an end effector's hold gives way under a wrench of the surface on it, in the contact's frame; `HOLDS`: nothing."""
    mu, pull = end.mu, end.held
    if end.form == HOOK:
        if math.sqrt(n * n + f1 * f1 + f2 * f2) > pull:
            return PULLED
        if abs(f2) > end.slope * n + end.touch:
            return LEFT
        return SLIPS if abs(f1) > mu * n + end.touch else HOLDS
    if end.form == SPINE:
        if f1 > pull:
            return DRAWN
        if f1 < 0.0:
            return SLIPS if math.sqrt(f1 * f1 + f2 * f2) > mu * n + end.touch else HOLDS
        hooked = n + end.slope * f1
        if hooked < -end.touch:
            return PULLED
        return SLIPS if abs(f2) > mu * hooked + end.touch else HOLDS
    pressure = n + pull
    if pressure < 0.0:
        return PULLED
    if math.sqrt(f1 * f1 + f2 * f2) > mu * pressure:
        return SLIPS
    if end.form == CONE:
        if n > end.press:
            return PRESSED
        if end.moments:
            if math.sqrt(m1 * m1 + m2 * m2) > end.bending:
                return BENT
            if abs(mn) > end.twisting:
                return TWISTED
        return HOLDS
    if abs(m1) > end.half2 * pressure or abs(m2) > end.half1 * pressure:
        return PEELED
    inside = math.sqrt(0.5)  # of the pyramid in the cone, as the rows of `contacts.pad` have it
    around = inside * (end.half1 + end.half2)
    for a in (-1.0, 1.0):
        for b in (-1.0, 1.0):
            for turn in (-1.0, 1.0):
                load = turn * mn + a * end.half2 * f1 + b * end.half1 * f2
                if load + mu * turn * inside * (a * m1 + b * m2) > mu * around * pressure:
                    return TWISTED
    return HOLDS


@inlined
def dot(a, b):
    """Of two vectors."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@kernel
def feel_ends(handle):
    """What acts on every tip, and what gives way, of what the handle of an `ends.Seen` holds.

    Returns:
        Whether anything does; -1: the simulation has lost its numbers.
    """
    seen = opened(handle)[0]
    total = 0.0
    for k in range(seen.numbers.size):
        total += seen.numbers[k]
    if not math.isfinite(total):
        return -1
    ends, axes, sites, readings, given = seen.ends, seen.axes, seen.sites, seen.readings, seen.given
    shutting, wrenches, local = seen.shutting, seen.wrenches, seen.local
    some = 0
    for limb in range(ends.shape[0]):
        end = ends[limb]
        turn = axes[sites[limb]]
        for part in range(0, 6, 3):
            for i in range(3):
                local[limb, part + i] = -readings[limb, part + i]
                total = 0.0
                for k in range(3):
                    total -= turn[3 * i + k] * readings[limb, part + k]
                wrenches[limb, part + i] = total
        given[limb] = HOLDS
        if end.hold < 0:
            continue
        normal, first, second = end.normal, end.first, end.second
        along = 0
        if abs(normal[0] * turn[0] + normal[1] * turn[3] + normal[2] * turn[6]) > 0.9:
            along = 1
        for i in range(3):
            first[i] = turn[3 * i + along]
        across = dot(first, normal)
        for i in range(3):
            first[i] -= across * normal[i]
        scale = 1.0 / math.sqrt(dot(first, first))
        for i in range(3):
            first[i] *= scale
        second[0] = normal[1] * first[2] - normal[2] * first[1]
        second[1] = normal[2] * first[0] - normal[0] * first[2]
        second[2] = normal[0] * first[1] - normal[1] * first[0]
        force, moment = wrenches[limb, :3], wrenches[limb, 3:]
        given[limb] = what_gives(
            end, dot(force, normal), dot(force, first), dot(force, second), dot(moment, normal), dot(moment, first),
            dot(moment, second),
        )  # fmt: skip
        end.over = 0 if given[limb] == HOLDS or shutting[limb] > 0 else end.over + 1
        some |= end.over > 0
    return some


@kernel
def held_by(handle, found):
    """The hold that each end effector is attached to, or that what only pushes pushes on, -1: none, of a handle of an `ends.Seen`.

    Args:
        handle: Of what is seen.
        found: Filled: indices of holds, shape (limbs,).
    """
    seen = opened(handle)[0]
    for limb in range(found.size):
        end, force = seen.ends[limb], seen.wrenches[limb]
        pushes = end.capture == 0.0 and abs(force[0]) + abs(force[1]) + abs(force[2]) > 0.0
        found[limb] = end.nearest if pushes else end.hold


@kernel
def nearest_holds(handle):
    """The hold whose patch is nearest each tip, of what the handle of an `ends.Seen` holds: one that is attached stays at its own.

    Returns:
        Bits of the limbs to look at: that is another than before, one that is to attach is near it, it lies deeper than was believed and
        one that attaches is near it or was, or jaws shut.
    """
    seen = opened(handle)[0]
    tips, sites, ends, places, normals, radii = seen.tips, seen.sites, seen.ends, seen.places, seen.normals, seen.radii
    some = 0
    for limb in range(sites.size):
        end = ends[limb]
        if end.hold >= 0:
            if end.nearest != end.under or seen.shutting[limb] > 0:
                some |= 1 << limb
            continue
        tip = tips[sites[limb]]
        nearest = -1
        best = math.inf
        for k in range(places.shape[0]):
            if radii[k] < 0.0:
                continue
            x, y, z = tip[0] - places[k, 0], tip[1] - places[k, 1], tip[2] - places[k, 2]
            square = x * x + y * y + z * z
            if square > (best + radii[k]) * (best + radii[k]):
                continue
            out = x * normals[k, 0] + y * normals[k, 1] + z * normals[k, 2]
            aside = max(0.0, math.sqrt(max(0.0, square - out * out)) - radii[k])
            gap = math.sqrt(out * out + aside * aside)
            if gap < best:
                best = gap
                nearest = k
        end.nearest, end.gap = nearest, best
        near = end.capture > 0.0 and best < end.near
        tries = end.wanted and not end.spent and best <= 2.0 * end.capture
        if nearest != end.under or (near and (tries or end.sunk or seen.recessed[nearest])):
            some |= 1 << limb
    return some


@kernel
def true_motion(handle, turn, velocity, joints):
    """How a robot really is and moves.

    Args:
        handle: Holds MuJoCo's `qpos` and `qvel`, the joints' places in both, and those of the plays of joints; -1: it has none.
        turn: Filled: the base's axes, as columns, shape (3, 3).
        velocity: Filled: of the base's origin, then angular, world frame, shape (6,).
        joints: Filled: positions and speeds at the outputs of the gears, shape (2, n).
    """
    qpos, qvel, at, speed_at, play_at, play_speed_at = opened(handle)
    write_axes(qpos[3:7], turn)
    for a in range(3):
        velocity[a], velocity[3 + a] = qvel[a], 0.0
        for b in range(3):
            velocity[3 + a] += turn[a, b] * qvel[3 + b]
    for k in range(at.size):
        joints[0, k], joints[1, k] = qpos[at[k]], qvel[speed_at[k]]
        if play_at[k] >= 0:
            joints[0, k] += qpos[play_at[k]]
            joints[1, k] += qvel[play_speed_at[k]]


@kernel
def drive_motors(handle, time):
    """What motors give at their joints' speeds, onto the joints; whether that may be held for a time [s], as `limit_torques` has it.

    Args:
        handle: Holds MuJoCo's `qvel`, the joints' places in it, speeds as scratch, torques asked for, limits, speeds without load and
            agility as in `limit_torques`, what it fills, and MuJoCo's `ctrl`, filled.
        time: The time [s].
    """
    qvel, at, speeds, wanted, limits, no_load, agility, given, also, control = opened(handle)
    for k in range(at.size):
        speeds[0, k] = qvel[at[k]]
    steady = limit_torques(wanted, speeds, limits, no_load, agility, time, given, also)
    for k in range(at.size):
        control[k] = given[0, k]
    return steady


@kernel
def mean_motion(read, seconds):
    """Mean angular velocity [rad/s] and specific force [m/s^2] of a base over the time since the reading before, base frame."""
    turn, now, velocity, mean = read.turn, read.turned, read.velocity, read.mean
    write_axes(read.qpos[3:7], now)
    for a in range(3):
        b, c = (a + 1) % 3, (a + 2) % 3
        up, down = 0.0, 0.0
        for k in range(3):
            up += turn[k, c] * now[k, b]
            down += turn[k, b] * now[k, c]
        mean[a] = (up - down) / (2.0 * seconds)
    for a in range(3):
        total = 0.0
        for k in range(3):
            push = (read.qvel[k] - velocity[k]) / seconds - read.gravity[k]
            total += push * 0.5 * (turn[k, a] + now[k, a])
        mean[3 + a] = total
    for a in range(3):
        velocity[a] = read.qvel[a]
        for k in range(3):
            turn[a, k] = now[a, k]


@kernel
def read_sensors(handle, row, tick, passed, period):
    """What all sensors say at a tick, after their delay.

    Args:
        handle: Holds what is read, and what is kept of readings (`sensing.Read`), and what is said, filled.
        row: Of the noise, that this reading has.
        tick: Number of this reading, from 0.
        passed: Time since the reading before [s]; 0: this is that one again.
        period: Of the control [s].
    """
    read, sensed = opened(handle)
    depth = read.joints.shape[0]
    now, late = tick % depth, max(0, tick - depth + 1) % depth
    for k in range(read.at.size):
        angle, speed, counts = read.qpos[read.at[k]], read.qvel[read.speed_at[k]], read.counts[k]
        if counts > 0.0:
            angle = math.floor(angle * counts + 0.5) / counts
            speed = 0.0 if tick == 0 else (angle - read.before[k]) / period
            read.before[k] = angle
        read.joints[now, 0, k], read.joints[now, 1, k] = angle, speed
    if passed > 0.0:
        mean_motion(read, passed)
    for a in range(6):
        read.motions[now, a] = read.mean[a] + read.noise[row, a]
    for limb in range(read.closed.size):
        for a in range(6):
            read.wrenches[now, limb, a] = read.felt[limb, a] + read.force_noise[row, limb, a]
    for k in range(read.at.size):
        sensed.joints[0, k], sensed.joints[1, k] = read.joints[late, 0, k], read.joints[late, 1, k]
        sensed.torques[k] = read.given[k]
    for a in range(3):
        sensed.gyro[a], sensed.accelerometer[a] = read.motions[late, a], read.motions[late, 3 + a]
    for limb in range(read.closed.size):
        for a in range(6):
            sensed.wrenches[limb, a] = read.wrenches[late, limb, a]
        sensed.closed[limb], sensed.shutting[limb] = read.closed[limb], read.shutting[limb] > 0
    sensed.number[0] = tick
