"""What is asked of a robot at a moment, and a sample of that, as kernels; for the paths of `execution.references`."""

import math

import numpy as np

from ....compiled import kernel, opened
from ....control.whole_body.programme import SWINGS
from ..control.turn_kernels import turn_by, write_quaternion
from ..statics.stance_kernels import OFF, RISE


@kernel
def quintic(u):
    """Share of the way at a share of the time, and its first and second derivative; at rest before 0 and after 1."""
    if u <= 0.0 or u >= 1.0:
        return 1.0 if u >= 1.0 else 0.0, 0.0, 0.0
    v = u * (1.0 - u)
    return u * u * u * (10.0 - 15.0 * u + 6.0 * u * u), 30.0 * v * v, 60.0 * v * (1.0 - 2.0 * u)


@kernel
def body_at(handle, time, position, rotation, velocity, acceleration):
    """A body on its way at a moment [s].

    Args:
        handle: Holds a `references.BodyPath`'s position, rotation, way, turn and seconds.
        time: The moment.
        position: Filled [m], shape (3,).
        rotation: Filled, shape (3, 3).
        velocity, acceleration: Filled, linear then angular, shape (6,) each.
    """
    start, axes, way, turn, seconds = opened(handle)
    share, speed, change = quintic(time / seconds)
    for a in range(3):
        position[a] = start[a] + share * way[a]
        velocity[a], velocity[3 + a] = speed / seconds * way[a], speed / seconds * turn[a]
        acceleration[a], acceleration[3 + a] = change / seconds**2 * way[a], change / seconds**2 * turn[a]
        for b in range(3):
            rotation[a, b] = axes[a, b]
    turn_by(share * turn[0], share * turn[1], share * turn[2], rotation)


@kernel
def tip_at(handle, u, rate, quicker, place, velocity, acceleration):
    """A tip at a share of a lifted path.

    Args:
        handle: Holds a `references.TipPath`'s start, end, normals and up.
        u: The share [-].
        rate: At which it grows [1/s].
        quicker: At which that grows [1/s^2].
        place, velocity, acceleration: Filled [m], [m/s], [m/s^2], shape (3,) each.
    """
    start, end, _, up = opened(handle)
    long = 1.0 - 2.0 * OFF
    share, speed, change = quintic((u - OFF) / long)
    height, slope, curve = quintic((u if u < 0.5 else 1.0 - u) / RISE)
    slope = slope if u < 0.5 else -slope
    for a in range(3):
        way = end[a] - start[a]
        first = speed / long * way + slope / RISE * up[a]
        second = change / long**2 * way + curve / RISE**2 * up[a]
        place[a] = start[a] + share * way + height * up[a]
        velocity[a] = rate * first
        acceleration[a] = rate * rate * second + quicker * first


@kernel
def direction_at(handle, u, out):
    """Direction of an end effector that turns from a path's one inward normal to the other, at a share of it, shape (3,).

    Args:
        handle: As in `tip_at`.
        u: The share [-].
        out: Filled.
    """
    normals = opened(handle)[2]
    share, square = quintic(u)[0], 0.0
    for a in range(3):
        out[a] = normals[0, a] + share * (normals[1, a] - normals[0, a])
        square += out[a] * out[a]
    length = math.sqrt(square)
    for a in range(3):
        out[a] = -out[a] / length if length > 1e-6 else -normals[1, a]


@kernel
def share_at(handle, time):
    """Share of a path at a moment [s], its rate and how that grows [-, 1/s, 1/s^2].

    Args:
        handle: Holds a `references.TimeScaling`'s times and rates.
        time: The moment.
    """
    times, rates = opened(handle)
    pieces = times.size - 1
    k = min(np.searchsorted(times, time, side="right"), pieces) - 1
    quicker = (rates[k + 1] - rates[k]) / (times[k + 1] - times[k])
    since = time - times[k]
    return k / pieces + since * (rates[k] + 0.5 * quicker * since), rates[k] + quicker * since, quicker


@kernel
def change_aims(handle, change, share):
    """Have loads and posture become others, at a share of that.

    Args:
        handle: As in `task_kernels.bear_loads`; aims and limbs in place.
        change: Holds the loads before and after, then the postures.
        share: The share [-].
    """
    _, aims, _, limbs, _ = opened(handle)
    before, after, leant, leans = opened(change)
    for limb in range(before.shape[0]):
        for a in range(6):
            limbs.loads[limb, a] = before[limb, a] + share * (after[limb, a] - before[limb, a])
    for k in range(leant.size):
        aims.posture[k] = leant[k] + share * (leans[k] - leant[k])


@kernel
def aim_body(handle, path, change, time):
    """A body on its way at a moment [s]: aims, and `change_aims` with it; handles as there and in `body_at`."""
    aims = opened(handle)[1]
    body_at(path, time, aims.position, aims.rotation, aims.velocity, aims.acceleration)
    change_aims(handle, change, quintic(time / opened(path)[4])[0])


@kernel
def aim_swing(handle, path, scaling, change, limb, time):
    """A limb that swings at a moment [s]: aims, with `change_aims`; handles as there, in `tip_at` and in `share_at`.

    Returns:
        The share of its path [-].
    """
    aims = opened(handle)[1]
    share, rate, quicker = share_at(scaling, time)
    tip_at(path, share, rate, quicker, aims.tip[limb], aims.tip_velocity[limb], aims.tip_acceleration[limb])
    aims.does[limb] = SWINGS
    change_aims(handle, change, quintic(share)[0])
    return share


@kernel
def write_sample(handle, row, at):
    """What is believed, asked for, commanded and felt, in the order of `run_trace.Named.titles`, into a row from `at` on; where it ends.

    Args:
        handle: As in `task_kernels.bear_loads`.
        row: Filled.
        at: The first place.
    """
    sensed, aims, state, limbs, rest = opened(handle)
    torques = rest[4]
    for of in (state.position, aims.position):
        for a in range(3):
            row[at + a] = of[a]
        at += 7
    write_quaternion(state.rotation, row[at - 11 : at - 7])
    write_quaternion(aims.rotation, row[at - 4 : at])
    n = torques.size
    for k in range(n):
        row[at + k], row[at + n + k] = sensed.joints[0, k], torques[k]
    at += 2 * n
    for limb in range(limbs.holds.size):
        for a in range(6):
            row[at] = sensed.wrenches[limb, a]
            at += 1
    for limb in range(limbs.holds.size):
        row[at] = limbs.holds[limb] + 1.0
        at += 1
    return at


@kernel
def write_truth(position, rotation, joints, wrenches, attached, row):
    """The truth of a sample in the order of `run_trace.Named.titles`, of parts of a `plant.SpatialTruth`, into a row."""
    for a in range(3):
        row[a] = position[a]
    write_quaternion(rotation, row[3:7])
    at, n, limbs = 7, joints.shape[1], attached.size
    for k in range(n):
        row[at + k] = joints[0, k]
    at += n
    for limb in range(limbs):
        for a in range(6):
            row[at + 6 * limb + a] = wrenches[limb, a]
        row[at + 6 * limbs + limb] = attached[limb] + 1.0
