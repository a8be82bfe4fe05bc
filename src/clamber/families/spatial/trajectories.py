"""Joint trajectories and contact sequences of plans of robots in space."""

from typing import Final

import numpy as np

from ...exports.joint_trajectory import BODY, JointTrajectory, Trajectories, resting
from ...planning.problem.problem import Replay
from .contact_sequence import contact_sequence
from .pictures.geometry import joint_torques, link_frames, posed
from .planning.task import SpatialTask

SECONDS: Final = 1.0
"""Between two stances of a plan, whose model has no time [s]."""


def spatial_stances(task: SpatialTask, replay: Replay) -> JointTrajectory:
    """Joints of the limbs; efforts are the torques that hold each stance."""
    chains = task.robot.chains
    at = posed(chains, replay.stances)
    wrenches = np.array(replay.stances["wrench"][:, : len(chains.limb_names)])
    torques = joint_torques(chains, link_frames(chains, at), wrenches, np.array(task.world.gravity))
    used = np.arange(chains.lower.shape[1]) < chains.n_joints[:, None]
    names = tuple(name for limb in chains.joint_names for name in limb)
    sliding = tuple(bool(slides) for slides in chains.sliding[used])
    time = SECONDS * np.arange(len(replay.stances), dtype=np.float64)
    return resting(names, sliding, time, at.q[:, used], torques[:, used])


TRAJECTORIES: Final = Trajectories(spatial_stances, BODY.note, BODY.run, contact_sequence)
