"""Where a body and a swinging tip are to be at a moment, as kernels; for the paths of `execution.references`."""

import math

import numpy as np

from ....compiled import kernel, opened
from ..control.turn_kernels import turn_by
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
def tip_at(handle, u, rate, quicker, out):
    """Place, velocity and acceleration at a share of a lifted path, shape (3, 3).

    Args:
        handle: Holds a `references.TipPath`'s start, end, normals and up.
        u: The share [-].
        rate: At which it grows [1/s].
        quicker: At which that grows [1/s^2].
        out: Filled, row by row.
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
        out[0, a] = start[a] + share * way + height * up[a]
        out[1, a] = rate * first
        out[2, a] = rate * rate * second + quicker * first


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
