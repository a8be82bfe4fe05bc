"""What a limb's links ask of its joints, so that what is left is the joints' own: motor, gear, friction."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...types import Floats
from ..chain import Chain
from ..kinematics import FRAME, accelerate, fill_inertia, place_chain
from ..records import AXES


@dataclass(frozen=True, slots=True, eq=False)
class LinkLoad:
    """The torque of the links at one joint: inertia . qdd + bias, at every sample."""

    inertia: Floats
    """The joint's row of the links' inertia matrix, shape (rows, n) [kg m^2]."""
    place: int
    """Which of the n joints it is, from 0."""
    bias: Floats
    """Coriolis, centrifugal and weight, shape (rows,) [N m]."""
    angles: Floats
    """Of all joints, behind the gear where that is measured, for links move with what is behind the play, shape (n, rows) [rad]."""


def link_loads(chain: Chain, angles: Sequence[Floats], speeds: Sequence[Floats]) -> list[LinkLoad]:
    """The load of a chain's links, without motors and friction, on each of its joints.

    Args:
        chain: The limb as its file states it.
        angles: Of each joint, behind the gear where that is measured [rad].
        speeds: Of each joint [rad/s].
    """
    joints = chain.joints.copy()
    for key in ("rotor", "damping", "friction"):
        joints[key] = 0.0
    q, qd = (np.ascontiguousarray(np.stack(list(parts), axis=1)) for parts in (angles, speeds))
    rows, n = q.shape
    frames, tip, drift, still = np.zeros((n, FRAME)), np.zeros(12), np.zeros(AXES), np.zeros(n)
    inertia, bias = np.zeros((rows, n, n)), np.zeros((rows, n))
    for k in range(rows):
        place_chain(joints, chain.root, q[k], frames, tip)
        fill_inertia(joints, frames, inertia[k])
        place_chain(joints, chain.root, q[k], frames, tip)
        accelerate(joints, chain.root, frames, tip, qd[k], still, True, drift, bias[k])
    together = np.ascontiguousarray(q.T)
    return [LinkLoad(inertia[:, j], j, np.ascontiguousarray(bias[:, j]), together) for j in range(n)]
