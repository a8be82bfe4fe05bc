"""The records that the laws read and write: joint, root, settings, aim, report. SI and radians; frames are the chain's own.

The chain's base frame is where its first joint is mounted; a limb's is its port frame. Twists and wrenches are six numbers, the linear
three first, both at the tip and both in the base frame.
"""

import numpy as np

AXES = 6
"""Rows of a twist: x, y, z, then rotation about x, y, z."""

JOINT = np.dtype(
    [
        ("place", "f8", (3,)),  # of the joint in the frame before it
        ("turn", "f8", (3, 3)),  # of the joint's frame at zero angle, in the frame before it
        ("axis", "f8", (3,)),  # unit vector, in the joint's frame
        ("sliding", "i4"),  # 0 turns, 1 slides along the axis
        ("mass", "f8"),  # of the link after the joint
        ("centre", "f8", (3,)),  # of that mass, in the joint's frame
        ("inertia", "f8", (3, 3)),  # about that centre, in the joint's frame
        ("rotor", "f8"),  # inertia of motor and gear, reflected to the joint
        ("damping", "f8"),
        ("friction", "f8"),
        ("back_emf", "f8"),  # torque that its motor, on a voltage amplifier, loses with speed; 0: not known
        ("share", "f8"),  # the joint's entry in K', largest 1
        ("limit", "f8"),  # largest torque
        ("speed", "f8"),  # joint speed without load
        ("lower", "f8"),
        ("upper", "f8"),
        ("rest", "f8"),  # the posture that a redundant limb leans to
    ],
    align=True,
)

ROOT = np.dtype(
    [
        ("tip", "f8", (3,)),  # in the last joint's frame
        ("tip_turn", "f8", (3, 3)),
        ("gravity", "f8", (3,)),  # acceleration, base frame
    ],
    align=True,
)

SETTINGS = np.dtype(
    [
        ("law", "i4"),
        ("n_rows", "i4"),
        ("rows", "i4", (AXES,)),  # which rows of the twist are controlled, in the task frame
        ("frame", "f8", (3, 3)),  # task frame in the base frame: its columns are the task's axes
        ("kp", "f8", (AXES,)),  # by row
        ("kd", "f8", (AXES,)),
        ("period", "f8"),  # between two ticks
        ("forced", "i4", (AXES,)),  # 1: the row carries a force, not a motion
        ("weighted", "i4"),  # 1: the joints' shares, 0: all alike
        ("feed_velocity", "i4"),
        ("feed_acceleration", "i4"),
        ("feed_gravity", "i4"),
        ("feed_bias", "i4"),
        ("feed_friction", "f8"),  # part of the modelled friction fed forward
        ("feed_force", "i4"),
        # 0 the aim's speed, 1 the measured one, 2 the pull of the law, 3 the aim's, at rest the last motion
        ("friction_from", "i4"),
        ("friction_speed", "f8"),  # below it the friction fed forward fades to nothing
        ("scaled", "i4"),  # 1: all torques of a limb shrink together at a limit, 0: each is cut off
        ("sigma", "f8"),  # smallest singular value that needs no damping
        ("lambda2", "f8"),  # damping at a singular value of 0
        ("joint_kp", "f8"),
        ("joint_kd", "f8"),
        ("derivative", "f8"),  # K'_d of the implicit admittance, s
        ("derivative_time", "f8"),  # time constant of the filter of that derivative
        ("mass", "f8", (AXES,)),  # of the admittance
        ("admittance_kp", "f8", (AXES,)),
        ("admittance_kd", "f8", (AXES,)),
        ("force_gain", "f8"),  # integral gain of the force rows, 1/s
        ("force_limit", "f8"),  # most that the integral adds
        ("force_damping", "f8"),  # of the motion along force rows
        ("torque_sensor", "i4"),  # of the torque loop: 0 none, 1 at the base, 2 at the wrist
        ("torque_gain", "f8"),  # its bandwidth, 1/s
        ("torque_limit", "f8"),  # most that it adds
        ("environment", "f8"),  # stiffness that implicit force control assumes
        ("posture_kp", "f8"),
        ("posture_kd", "f8"),
    ],
    align=True,
)

AIM = np.dtype(
    [
        ("place", "f8", (3,)),
        ("turn", "f8", (3, 3)),
        ("twist", "f8", (AXES,)),
        ("acceleration", "f8", (AXES,)),
        ("wrench", "f8", (AXES,)),  # of the limb on what it touches
    ],
    align=True,
)

REPORT = np.dtype(
    [
        ("sigma", "f8"),  # smallest singular value of the task Jacobian
        ("lambda2", "f8"),  # damping that was used
        ("saturated", "i4"),  # joints at a limit
        ("place", "f8", (3,)),  # of the tip, as the law computed it
        ("error", "f8", (AXES,)),  # by row, task frame
    ],
    align=True,
)
