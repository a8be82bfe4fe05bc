"""Encoders and motors between a controller and a plant, as kernels: counts, speed by difference, delay, torque limits."""

import math

from ..compiled import inlined, kernel


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


@inlined
def limited(wanted, speed, limit, no_load):
    """The torque that a motor gives of what it is asked: within its limit, and below its torque-speed line."""
    high = limit
    low = -limit
    if limit < math.inf and no_load < math.inf:
        high = min(limit, max(-limit, limit * (1.0 - speed / no_load)))
        low = max(-limit, min(limit, -limit * (1.0 + speed / no_load)))
    return min(max(wanted, low), high)


@kernel
def take_torques(asked, wanted):
    """Copy the torques `asked` into `wanted`, both of shape (batch, n); the first limb with one that is not finite, or -1."""
    bad = -1
    for b in range(asked.shape[0]):
        for j in range(asked.shape[1]):
            wanted[b, j] = asked[b, j]
            if bad < 0 and not math.isfinite(asked[b, j]):
                bad = b
    return bad


@kernel
def limit_torques(wanted, speeds, limits, no_load, agility, time, out, also):
    """What the motors give at these speeds.

    Args:
        wanted: Torques asked for, shape (batch, n) [N m].
        speeds: Motor-side joint speeds, shape (batch, n) [rad/s].
        limits: Largest torque of each joint, shape (n,) [N m]; inf for none.
        no_load: Speed of each joint without load, shape (n,) [rad/s]; inf for none.
        agility: More than any joint accelerates, shape (n,) [rad/s^2].
        time: For which the torques might be held [s].
        out, also: Both filled, shape (batch, n).

    Returns:
        Whether they may be held: no motor would give another torque at any speed that it can reach within that time.
    """
    steady = True
    for b in range(wanted.shape[0]):
        for j in range(wanted.shape[1]):
            value = limited(wanted[b, j], speeds[b, j], limits[j], no_load[j])
            out[b, j] = value
            also[b, j] = value
            if limits[j] < math.inf and no_load[j] < math.inf:
                change = agility[j] * time
                slow = limited(wanted[b, j], speeds[b, j] - change, limits[j], no_load[j])
                fast = limited(wanted[b, j], speeds[b, j] + change, limits[j], no_load[j])
                steady = steady and slow == value and fast == value
    return steady
