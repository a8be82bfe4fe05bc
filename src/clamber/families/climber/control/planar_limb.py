"""A limb with two joints as the body's control knows it, and where its tip is. Kernels.

Arrays have one row per limb; places are in the body frame.
"""

import math

import numpy as np

from ....compiled import inlined

PLANAR_LIMB = np.dtype(
    [
        ("port_x", "f8"),
        ("port_y", "f8"),
        ("port_angle", "f8"),
        ("l1", "f8"),
        ("l2", "f8"),  # the effective second link
        ("beta", "f8"),  # from the second link to the tip
        ("hook_angle", "f8"),  # from the second link's direction to the grab direction
        ("hooked", "i4"),  # 1: it can only pull along its grab direction
        ("share1", "f8"),  # K' of shoulder and elbow
        ("share2", "f8"),
        ("heft1", "f8"),  # torque of its own weight about the shoulder with the first link level [N m]
        ("heft2", "f8"),  # and about the elbow with the second link level
        ("weight", "f8"),  # of its links [N]
        ("rotor1", "f8"),  # inertia of motor and gear at shoulder and elbow [kg m^2]
        ("rotor2", "f8"),
        ("friction1", "f8"),  # Coulomb friction of shoulder and elbow [N m]
        ("friction2", "f8"),
        ("damping1", "f8"),  # their viscous friction [N m s/rad]
        ("damping2", "f8"),
        ("limit1", "f8"),  # largest torque of their motors [N m]
        ("limit2", "f8"),
    ],
    align=True,
)
"""What the body's control knows of a limb with two joints."""

STANCE, UNLOADED_CONTACT, SWING_CARTESIAN, SWING_JOINT, CONTACT_PUSH, HANG = range(6)
"""Modes of a limb."""
LIMB_TASK = np.dtype(
    [
        ("mode", "i4"),
        ("hold", "i4"),  # number of its hold, 0 without one
        ("side", "i4"),  # on which its elbow is kept by a soft stop, +1 or -1; 0 where it may pass
        ("pressed", "i4"),  # of CONTACT_PUSH: whether the tip has stopped against something
        ("place", "f8", (2,)),  # of CLING: the hold, of SWING_CARTESIAN: the aim, world frame
        ("speed", "f8", (2,)),  # of that aim
        ("angles", "f8", (2,)),  # of SWING_JOINT and HANG
        ("rates", "f8", (2,)),
        ("accelerations", "f8", (2,)),  # of SWING_JOINT
        ("loads", "f8", (2,)),  # of HANG: torques besides
        ("force", "f8", (2,)),  # of CONTACT_PUSH: of the tip on what it meets, world frame
        ("tug", "f8", (2,)),  # the steady part of that, which the body leans on
        ("damping", "f8"),
    ],
    align=True,
)
"""What one limb is to do."""


@inlined
def place_tips(legs, q, tips):
    """Tips in the body frame, shape (n, 2) [m], from joint angles q, shape (n, 2)."""
    for i in range(legs.size):
        leg = legs[i]
        first = leg.port_angle + q[i, 0]
        second = first + q[i, 1] + leg.beta
        tips[i, 0] = leg.port_x + leg.l1 * math.cos(first) + leg.l2 * math.cos(second)
        tips[i, 1] = leg.port_y + leg.l1 * math.sin(first) + leg.l2 * math.sin(second)


@inlined
def move_tips(legs, q, qd, speeds):
    """Speeds of the tips in the body frame, shape (n, 2) [m/s]."""
    for i in range(legs.size):
        leg = legs[i]
        first = leg.port_angle + q[i, 0]
        second = first + q[i, 1] + leg.beta
        w1 = qd[i, 0]
        w2 = qd[i, 0] + qd[i, 1]
        speeds[i, 0] = -leg.l1 * math.sin(first) * w1 - leg.l2 * math.sin(second) * w2
        speeds[i, 1] = leg.l1 * math.cos(first) * w1 + leg.l2 * math.cos(second) * w2
