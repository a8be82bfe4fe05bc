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
