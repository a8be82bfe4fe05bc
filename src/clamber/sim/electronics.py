"""Encoders and motors between a controller and a plant, as kernels: counts, speed by difference, delay, torque limits."""

import math

from ..compiled import kernel


@kernel
def read_encoders(angles, speeds, counts, period, tick, delayed, before, states):
    """What the encoders say, after their delay.

    Args:
        angles, speeds: True motor-side joint angles and speeds, shape (batch, n).
        counts: Counts per radian of each joint, shape (n,); 0 for a perfect encoder that tells the speed too.
        period: Of the control [s].
        tick: Number of this reading, from 0.
        delayed: Ring of past readings, shape (delay + 1, batch, 2, n).
        before: Angles of the reading before, shape (batch, n).
        states: Filled, shape (batch, 2, n).
    """
    depth = delayed.shape[0]
    now = delayed[tick % depth]
    for b in range(angles.shape[0]):
        for j in range(angles.shape[1]):
            if counts[j] > 0.0:
                angle = math.floor(angles[b, j] * counts[j] + 0.5) / counts[j]
                now[b, 0, j] = angle
                now[b, 1, j] = 0.0 if tick == 0 else (angle - before[b, j]) / period
                before[b, j] = angle
            else:
                now[b, 0, j] = angles[b, j]
                now[b, 1, j] = speeds[b, j]
    then = delayed[max(0, tick - depth + 1) % depth]
    for b in range(angles.shape[0]):
        for k in range(2):
            for j in range(angles.shape[1]):
                states[b, k, j] = then[b, k, j]


@kernel
def limit_torques(wanted, speeds, limits, no_load, out):
    """What the motors give: within their limit and below their torque-speed line.

    Args:
        wanted: Torques asked for, shape (batch, n) [N m].
        speeds: Motor-side joint speeds, shape (batch, n) [rad/s].
        limits: Largest torque of each joint, shape (n,) [N m]; inf for none.
        no_load: Speed of each joint without load, shape (n,) [rad/s]; inf for none.
        out: Filled, shape (batch, n).

    Returns:
        Whether a limit is so near that the torque may depend on the speed within a few milliseconds.
    """
    near = False
    for b in range(wanted.shape[0]):
        for j in range(wanted.shape[1]):
            high = min(limits[j], limits[j] * (1.0 - speeds[b, j] / no_load[j]))
            low = max(-limits[j], -limits[j] * (1.0 + speeds[b, j] / no_load[j]))
            out[b, j] = min(max(wanted[b, j], low), high)
            near = near or wanted[b, j] > 0.7 * high or wanted[b, j] < 0.7 * low
    return near
