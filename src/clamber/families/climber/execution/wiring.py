"""Encoders and amplifiers of a climber, the guard that holds its posture, and the envelope of its joints."""

import numpy as np

from ....errors import SpecError
from ....execution.link.envelope import Envelope, JointLimits
from ....execution.posture_guard import PostureGuard
from ....execution.wiring import BODY_COUNTS, COMMAND_LIMIT, Wiring
from ....types import Floats
from ..robot.robot import LimbedRobot


def encoder_resolution(robot: LimbedRobot, counts: int) -> Floats:
    """Counts per radian of every joint, on the motor's side of its gear, then of the body's angle, shape (2 limbs + 1,).

    Args:
        robot: The climber.
        counts: Per motor turn; 0 for perfect encoders, whose resolution is told as 0.
    """
    gears = np.array([joint.gear for joint in robot.joints])
    return np.append(counts * gears, BODY_COUNTS if counts else 0) / (2 * np.pi)


def wiring_of(robot: LimbedRobot, counts: int | None = None) -> Wiring:
    """Wires of a climber: six joints and the body's angle make LIBRA's seven encoders.

    Args:
        robot: The climber.
        counts: Per motor turn; None: as the robot's file says.

    Raises:
        SpecError: If its motors have no amplifiers, or its encoders no counts.
    """
    motor = robot.motor
    counts = motor.encoder_counts if counts is None else counts
    if motor.amplifier_gain is None:
        raise SpecError(f"robot '{robot.name}'", "motor.amplifier_gain", None, "must be stated: commands are volts")
    if not counts:
        raise SpecError(
            f"robot '{robot.name}'", "motor.encoder_counts", counts, "must be 1 or more: sensors are counted"
        )
    per_volt = motor.amplifier_gain * motor.torque_constant * np.array([joint.gear for joint in robot.joints])
    limits = np.array([robot.torque_limit_of(joint) for joint in robot.joints])
    grippers = tuple(i for i, limb in enumerate(robot.limbs) if limb.end.kind == "gripper")
    return Wiring(encoder_resolution(robot, counts), per_volt, np.minimum(limits / per_volt, COMMAND_LIMIT), grippers)


def guard_of(robot: LimbedRobot, wiring: Wiring, period: float) -> PostureGuard:
    """The guard of a whole climber."""
    return PostureGuard(wiring, robot.inertias, period)


def envelope_of(robot: LimbedRobot, wiring: Wiring, period: float) -> Envelope:
    """The envelope of a climber's joints, as its file states them."""
    joints, motor = robot.joints, robot.motor
    none = motor.continuous_torque is None or motor.thermal_time is None
    limits = JointLimits(
        names=robot.joint_names,
        lower=np.array([joint.lower for joint in joints]),
        upper=np.array([joint.upper for joint in joints]),
        speeds=np.array([robot.no_load_speed_of(joint) for joint in joints]),
        continuous=np.full(len(joints), np.inf if none else motor.continuous_torque),
        thermal_time=motor.thermal_time or np.inf,
    )
    return Envelope(wiring, limits, period)
