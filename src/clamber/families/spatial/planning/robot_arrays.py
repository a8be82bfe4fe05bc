"""What kernels need of a robot besides its task, made once a robot: its record, seeds of postures, nominal tips, reach of each limb."""

from dataclasses import dataclass

import numpy as np

from ....types import Floats, Records
from ..robot.robot import SpatialRobot
from ..statics.kinematics_kernels import limb_frames
from ..statics.records import WORK, robot_record
from ..statics.seeds import SeedTable, seed_table
from ..statics.stretch import stretched


@dataclass(frozen=True, slots=True)
class RobotArrays:
    """A robot as kernels read it."""

    robot: Records
    """One record of `ROBOT`."""
    table: SeedTable
    """Its seeds; keeps what their record points at."""
    tips: Floats
    """Of the nominal postures, base frame [m], shape (limbs, 3)."""
    reach: Floats
    """Largest distance of each tip from the base's origin [m], at most, shape (limbs,)."""


def robot_arrays(robot: SpatialRobot) -> RobotArrays:
    """The arrays of a robot."""
    records = robot_record(robot.chains, robot.contacts)
    return RobotArrays(records, seed_table(records), _tips(robot, records), reaches(robot))


def nominal_tips(robot: SpatialRobot) -> Floats:
    """Tips of the nominal postures, base frame [m], shape (limbs, 3)."""
    return _tips(robot, robot_record(robot.chains, robot.contacts))


def _tips(robot: SpatialRobot, records: Records) -> Floats:
    work = np.zeros(1, WORK)
    limbs, most = robot.chains.nominal.shape
    work["posture"][0, :limbs, :most] = robot.chains.nominal
    for limb in range(limbs):
        limb_frames(records[0], limb, work[0])
    return np.array([work["origin"][0, limb, n] for limb, n in enumerate(robot.chains.n_joints)])


def reaches(robot: SpatialRobot) -> Floats:
    """From the base to each limb's first joint and on along links that no joint bends, slides run out [m], shape (limbs,)."""
    mounts: Floats = np.linalg.norm(robot.chains.offset[:, 0], axis=1)
    return mounts + [stretched(robot.chains, limb) for limb in range(len(mounts))]
