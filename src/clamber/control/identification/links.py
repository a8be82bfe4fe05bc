"""Torques that a limb's links need, so that what is left is the joints' own: motor, gear, friction."""

from collections.abc import Sequence

import numpy as np

from ...types import Floats
from ..chain import Chain
from ..kinematics import FRAME, accelerate, place_chain
from ..records import AXES
from .motion import Motion


def link_torques(chain: Chain, angles: Sequence[Floats], motions: Sequence[Motion]) -> Floats:
    """Inverse dynamics of a chain without its motors and friction, at every sample, shape (n, rows) [N m].

    Args:
        chain: The limb as its file states it.
        angles: Of each joint, by its encoder [rad].
        motions: Of the same samples.
    """
    joints = chain.joints.copy()
    for key in ("rotor", "damping", "friction"):
        joints[key] = 0.0
    q = np.ascontiguousarray(np.stack(angles, axis=1))
    qd = np.ascontiguousarray(np.stack([motion.speed for motion in motions], axis=1))
    qdd = np.ascontiguousarray(np.stack([motion.acceleration for motion in motions], axis=1))
    frames, tip, drift = np.zeros((chain.n, FRAME)), np.zeros(12), np.zeros(AXES)
    out = np.zeros((q.shape[0], chain.n))
    for k in range(q.shape[0]):
        place_chain(joints, chain.root, q[k], frames, tip)
        accelerate(joints, chain.root, frames, tip, qd[k], qdd[k], True, drift, out[k])
    return np.ascontiguousarray(out.T)
