"""The mirror image of a limbed climber's stance, where robot, board, rules and goals are their own mirror image about a vertical line."""

import numpy as np

from ....compiled import carray, inlined, kernel, pointer
from ..statics.elbows import reflect_elbows
from ..statics.pose import place
from ..statics.records import LIMBS


@inlined
def limb_image(p):
    """Limb on the other side of each limb."""
    return carray(pointer(p.limb_image_at), LIMBS, np.int32)


@inlined
def hold_image(p):
    """Hold on the other side of each hold."""
    return carray(pointer(p.hold_image_at), p.n_holds, np.int32)


@kernel
def reflect(p, s, t):
    """Write the mirror image of a stance, as far as keys and bounds read it; False if the problem has none.

    The reflection maps every stance, action and check to one of the same problem: ports, ranges, holds and limits go over into each
    other, the weight points down in both, an elbow's branches change places, and so do the two turns and the two steps along x. So a
    stance and its image have images of the same futures, of the same lengths and costs, and a search needs one of the two.
    """
    if p.mirrored == 0:
        return False
    t.ix = p.mirror_x - s.ix
    t.iy = s.iy
    t.ia = (p.mirror_angle - s.ia) % p.turn_ticks
    t.in_use = limb_image(p)[s.in_use] if s.in_use >= 0 else -1
    t.hangs = s.hangs
    t.stage = s.stage
    t.laps = s.laps
    t.resolved = -1
    t.turned = 0.0
    t.bearing = 0.0
    place(p, t)
    if p.kept:
        reflect_elbows(s.elbows, p.n_limbs, limb_image(p), t.elbows)
    for i in range(p.n_limbs):
        j = limb_image(p)[i]
        t.hold[j] = hold_image(p)[s.hold[i]] if s.hold[i] >= 0 else -1
        t.left[j] = hold_image(p)[s.left[i]] if s.left[i] >= 0 else -1
        t.foot[j, 0] = -s.foot[i, 0]
        t.foot[j, 1] = s.foot[i, 1]
    return True
