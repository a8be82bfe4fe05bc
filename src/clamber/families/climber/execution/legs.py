"""The limbs of a climber as the body's control knows them."""

import numpy as np

from ....types import Records
from ....units import GRAVITY
from ..control.leg import LEG
from ..control.limb_chain import chain_of_limb
from ..robot.robot import LimbedRobot


def legs_of(robot: LimbedRobot) -> Records:
    """Records of `control.leg.LEG`, shape (limbs,)."""
    legs = np.zeros(len(robot.limbs), LEG)
    for i, limb in enumerate(robot.limbs):
        joints = chain_of_limb(robot, limb.name).joints
        masses, centres = joints["mass"], joints["centre"][:, 0]
        legs[i] = (
            *(limb.port_x, limb.port_y, limb.port_angle, limb.l1, limb.l2_effective, limb.hook_beta),
            *(limb.end.angle, limb.end.kind == "hook", *joints["share"]),
            *(GRAVITY * (masses[0] * centres[0] + masses[1] * limb.l1), GRAVITY * masses[1] * centres[1]),
            GRAVITY * masses.sum(),
            *joints["rotor"],
            *joints["friction"],
            *joints["damping"],
            *joints["limit"],
        )
    return legs
