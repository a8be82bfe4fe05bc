"""The wires between a climber's electronics and its MuJoCo arrays: one call a tick each way. Kernels."""

from ....compiled import kernel
from ....sim.electronics import limit_torques, read_encoders


@kernel
def sense_climber(
    qpos, qvel, at, speed_at, offsets, angles, speeds, counts, period, tick, ring, before, states
):  # fmt: skip
    """Read the encoders of the body's angle and of all joints.

    Args:
        qpos, qvel: Coordinates and speeds of the model.
        at, speed_at: Where those of the encoders are in them, shape (n,).
        offsets: What the encoders say too much, shape (n,) [rad].
        angles, speeds: Filled with what is there, offsets included, shape (1, n).
        counts, period, tick, ring, before, states: As in `read_encoders`.
    """
    for k in range(at.size):
        angles[0, k] = qpos[at[k]] + offsets[k]
        speeds[0, k] = qvel[speed_at[k]]
    read_encoders(angles, speeds, counts, period, tick, ring, before, states)


@kernel
def command_motors(
    wanted, qvel, speed_at, speeds, limits, no_load, agility, time, given, also, motors, ctrl
):  # fmt: skip
    """Put what the motors give at the present speeds on the actuators; whether it may be held for `time` [s].

    Args:
        wanted: Torques asked for, shape (1, n) [N m].
        qvel: Speeds of the model.
        speed_at: Where the body's angle and then the joints are in them, shape (n + 1,).
        speeds: Filled with the joints' speeds, shape (1, n).
        limits, no_load, agility, time: As in `limit_torques`.
        given, also: Filled with the torques, shape (1, n).
        motors: Which actuator is which joint's, shape (n,).
        ctrl: Of the model; filled.
    """
    for k in range(motors.size):
        speeds[0, k] = qvel[speed_at[k + 1]]
    steady = limit_torques(wanted, speeds, limits, no_load, agility, time, given, also)
    for k in range(motors.size):
        ctrl[motors[k]] = given[0, k]
    return steady
