"""Joint trajectories of climbers: of plans and of runs."""

import math
from typing import Final

import numpy as np

from ...execution.log import Log
from ...exports.joint_trajectory import JointTrajectory, Trajectories, moved, resting
from ...planning.problem.problem import Replay
from .execution.climb_trace import JOINTS, ClimbTrace
from .pictures.geometry import joint_angles, stance_posture
from .planning.task import LimbedTask
from .robot.robot import Joint


def climb_trajectory(log: Log) -> JointTrajectory:
    """The joints of a climb: angles by the encoders, torques as commanded, before motors saturate."""
    trace = ClimbTrace.from_log(log)
    rows, names = len(trace.time), tuple(f"{limb}_{joint}" for limb in trace.limbs for joint in JOINTS)
    flat = (array.reshape(rows, -1) for array in (trace.angles, trace.torques))
    angles, torques = flat
    return moved(names, (False,) * len(names), trace.time, angles, log.label, torques)


def climb_stances(task: LimbedTask, replay: Replay) -> JointTrajectory:
    """Joints of a climber; efforts are the static torques of each stance."""
    limbs, rows = task.robot.limbs, len(replay.stances)
    angles = np.empty((rows, len(limbs), 2))
    for k, stance in enumerate(replay.stances):
        posture = stance_posture(task.robot, task.world, stance)
        for i, limb in enumerate(limbs):
            chain = tuple(complex(*point) for point in posture.chains[i])
            for j, (joint, angle) in enumerate(
                zip((limb.shoulder, limb.elbow), joint_angles(limb, posture.angle, chain), strict=True)
            ):
                angles[k, i, j] = in_range(joint, angle)
    names = tuple(f"{limb.name}_{joint}" for limb in limbs for joint in ("shoulder", "elbow"))
    time = np.arange(rows, dtype=np.float64) * task.step.duration
    torques = np.array(replay.stances["torques"][:, : len(limbs)]).reshape(rows, -1)
    return resting(names, (False,) * len(names), time, angles.reshape(rows, -1), torques)


def in_range(joint: Joint, angle: float) -> float:
    """The angle by whole turns brought nearest to the middle of a joint's range [rad]."""
    middle = 0.5 * (joint.lower + joint.upper)
    return middle + math.remainder(angle - middle, math.tau)


TRAJECTORIES: Final = Trajectories(climb_stances, "limbs", climb_trajectory)
