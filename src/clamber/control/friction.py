r"""Joint friction fed forward from the model: against the motion that is asked for or measured, or that a resting joint last made.

A joint that stands still does not tell which way its friction acts: anything between the Coulomb torque forwards and backwards keeps it
there. "aim" and "measured" add nothing at rest. "torque" takes the law's pull for the direction of motion, which is right as long as the
joint came to rest moving along that pull; where it came to rest the other way, up to twice the Coulomb torque is too much. "last" remembers
which way each joint moved last: what held it when it stopped holds it still, so a force that was right while the joint moved stays
right. Until a joint has moved, that is "torque".
"""

import math

from ..compiled import inlined
from .inverse_motion import damped_motion
from .law_state import FRICTION, SPARE, TORQUE, WANTED_RATE

FROM_AIM = 0
"""Friction is fed forward by the speed that the aim asks for."""
FROM_MEASURED = 1
"""By the measured speed."""
FROM_TORQUE = 2
"""By the direction in which the law pulls."""
FROM_LAST = 3
"""By the aim's speed; where that rests, by the direction of the last measured motion."""
FADE = 0.1
"""Pulls below this part of the friction feed forward less of it."""


@inlined
def feed_friction(joints, settings, qd, ways, lines, squares, report):
    """Add the modelled friction to `lines[TORQUE]`, and leave it in `lines[FRICTION]`.

    Args:
        joints: Records of `JOINT`, shape (n,).
        settings: A record of `SETTINGS`.
        qd: Sensed joint speeds, shape (n,).
        ways: Which way each joint moved last: 1, -1, or 0 if it has not; kept from tick to tick, shape (n,).
        lines, squares, report: As in `moment`.
    """
    n = joints.size
    torque = lines[TORQUE]
    known = lines[FRICTION]
    if settings.feed_friction == 0.0:
        for j in range(n):
            known[j] = 0.0
        return
    motion = lines[SPARE + 1]
    source = settings.friction_from
    if source in (FROM_AIM, FROM_LAST):
        damped_motion(n, settings, lines[WANTED_RATE], lines, squares, report)
    else:
        for j in range(n):
            motion[j] = qd[j] if source == FROM_MEASURED else 0.0
    for j in range(n):
        joint = joints[j]
        part = math.tanh(motion[j] / settings.friction_speed)
        if source >= FROM_TORQUE and joint.friction > 0.0:
            pull = math.tanh(torque[j] / (FADE * joint.friction))
            if source == FROM_LAST:
                for speed in (qd[j], motion[j]):
                    if abs(speed) > settings.friction_speed:
                        ways[j] = 1.0 if speed > 0.0 else -1.0
                pull = ways[j] if ways[j] != 0.0 else pull
            part += (1.0 - abs(part)) * pull
        known[j] = settings.feed_friction * (joint.damping * motion[j] + joint.friction * part)
        torque[j] += known[j]
