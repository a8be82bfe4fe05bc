"""The identified model driven by the torques of the log: the speeds that it gives, beside the measured ones."""

import numpy as np

from ...types import Floats
from .joint import IdentifiedJoint


def model_speed(joint: IdentifiedJoint) -> Floats | None:
    """Speed of the model at every sample, by steps of one period; None where inertia, damping or friction is not known [rad/s].

    The model starts anew from the measured speed wherever the joint stands: in its stops it would turn on.
    """
    if joint.fit is None or joint.torque is None or any(e.value is None for e in joint.estimates[:3]):
        return None
    inertia, damping, friction, offset = (float(e.value or 0.0) for e in joint.estimates[:4])
    samples, motion = joint.samples, joint.motion
    period = samples.period
    late = joint.fit.lag - period / 2  # a torque held for a period is half of one late on its own
    torque = np.interp(samples.time - late, samples.time, joint.torque) - offset
    whole = np.full(samples.time.size, inertia)
    if joint.links is not None:
        torque = torque - joint.links.bias
        whole = whole + joint.links.inertia[:, joint.links.place]
    out = np.empty(samples.time.size)
    speed = float(motion.speed[0])
    for k in range(out.size):
        if motion.forward[k] == 0.0:
            speed = float(motion.speed[k])
        out[k] = speed
        pull = float(torque[k]) - damping * speed
        if abs(speed) > 0.0:
            changed = speed + period / whole[k] * (pull - friction * np.sign(speed))
            speed = changed if changed * speed > 0.0 or abs(pull) > friction else 0.0
        elif abs(pull) > friction:
            speed = period / whole[k] * (pull - friction * np.sign(pull))
    return out
