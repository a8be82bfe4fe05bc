"""The wires between a climber's electronics and its MuJoCo arrays: one call a tick each way. Kernels."""

from ....compiled import kernel, opened
from ....sim.electronics import limit_torques, read_encoders


@kernel
def sense_climber(handle, tick):
    """Read the encoders of the body's angle and of all joints.

    Args:
        handle: Holds coordinates and speeds of the model, where those of the encoders are in them, what these say too much, shape (n,)
            [rad], room for angles and speeds with that, shape (1, n), and counts, period, ring, `before`, states of `read_encoders`.
        tick: Number of this reading, from 0.
    """
    qpos, qvel, at, speed_at, offsets, angles, speeds, counts, period, ring, before, states = opened(handle)
    for k in range(at.size):
        angles[0, k] = qpos[at[k]] + offsets[k]
        speeds[0, k] = qvel[speed_at[k]]
    read_encoders(angles, speeds, counts, period, tick, ring, before, states)


@kernel
def command_motors(handle, time):
    """Put what the motors give at the present speeds on the actuators; whether it may be held for `time` [s].

    Args:
        handle: Holds torques asked for, shape (1, n) [N m], speeds of the model, where those of the body and the joints are in them,
            room for them, shape (1, n), limits, `no_load`, agility, `out` and `also` of `limit_torques`, actuators of the joints, and the
            model's `ctrl`, filled.
        time: The time [s].
    """
    wanted, qvel, speed_at, speeds, limits, no_load, agility, given, also, motors, ctrl = opened(handle)
    for k in range(motors.size):
        speeds[0, k] = qvel[speed_at[k + 1]]
    steady = limit_torques(wanted, speeds, limits, no_load, agility, time, given, also)
    for k in range(motors.size):
        ctrl[motors[k]] = given[0, k]
    return steady


@kernel
def tell_truth(handle, pose, q, tips, torques):
    """How a climber really is.

    Args:
        handle: Holds coordinates of the model, where those of the body's angle and of all joints are in them, 1 where a joint's play comes
            next to it, places of all sites [m], sites of the tips, and torques that the motors give, shape (1, n) [N m].
        pose: Of the body, filled, shape (3,) [m], [rad].
        q, tips, torques: Of the joints at the gears' outputs [rad], places of the tips, world frame [m], and of the motors [N m], filled,
            shape (limbs, 2).
    """
    qpos, at, plays, sites, ends, given = opened(handle)
    for k in range(3):
        pose[k] = qpos[k]
    for i in range(ends.size):
        for k in range(2):
            j = at[1 + 2 * i + k]
            q[i, k] = qpos[j] + qpos[j + 1] if plays else qpos[j]
            tips[i, k] = sites[ends[i], k]
            torques[i, k] = given[0, 2 * i + k]
