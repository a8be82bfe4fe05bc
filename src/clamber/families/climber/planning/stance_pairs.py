"""A limbed climber's stance beside another: how far from it at least, what it can do more, its mirror image. Kernels."""

import math

import numpy as np

from ....compiled import carray, inlined, kernel, pointer
from ....planning.problem.check import TICKS
from ..statics.elbows import reflect_elbows
from ..statics.pose import count_holders, place
from ..statics.records import LIMBS
from ..statics.stance import HANGS
from .step import copy_stance


@kernel
def heuristic_between(p, s, t):
    """An admissible, consistent number of actions from a stance to another's key.

    A body move changes one coordinate by one step and no hold; a grab or a release changes the hold of one limb, which is then the one in
    use, and no coordinate. So steps and limbs add up. A hang moves the body for nothing: where one is still allowed only the limbs count.
    """
    limbs = 0
    for i in range(p.n_limbs):
        if s.hold[i] != t.hold[i]:
            limbs += 1
    there, _ = count_holders(p, t)
    idles = (t.in_use >= 0 and t.hold[t.in_use] >= 0) or (s.in_use >= 0 and s.hold[s.in_use] >= 0)
    if limbs == 0 and idles and p.idle and there >= 3 and s.in_use != t.in_use:
        limbs = 1  # the key tells which limb carries nothing
    holders, _ = count_holders(p, s)
    if holders <= 1 or not (p.hard >> HANGS) & 1 or p.max_hangs < 0 or s.hangs < p.max_hangs:
        return float(limbs)
    turn = (t.ia - s.ia) % p.turn_ticks
    steps = math.ceil(abs(t.ix - s.ix) / TICKS) + math.ceil(abs(t.iy - s.iy) / TICKS)
    return float(limbs + steps + math.ceil(min(turn, p.turn_ticks - turn) / TICKS))


@kernel
def dominating(p, s, which, t):
    """Write the stance number `which` that is at least as free as `s`; False if there is none of that number.

    All of them have the pose, holds and branches of `s`, so every action is judged alike there. They differ in one thing:

    - more goals met. A plan that goes on from `s` to the end meets the goals that `s` still needs, in order; the fewer that `t` needs are
      the last of them.
    - one more lap in the direction in which every goal turns. The angle swept is a turn more at each step, so a goal that asks for turns
      is met at the latest when it is met from `s`; no check reads laps.
    - one hang fewer used. The check `hangs` has a larger margin at each step; nothing else reads them.

    Args:
        p, s: Parameters and stance; only read.
        which: From 0.
        t: Scratch stance that is written.
    """
    more_goals = p.n_goals - 1 - s.stage
    if which < more_goals:
        copy_stance(p.n_limbs, s, t)
        t.stage = s.stage + 1 + which
        return True
    which -= max(more_goals, 0)
    if p.turning != 0:
        if which == 0:
            copy_stance(p.n_limbs, s, t)
            t.laps = s.laps + p.turning
            return True
        which -= 1
    if which == 0 and p.max_hangs >= 0 and s.hangs > 0:
        copy_stance(p.n_limbs, s, t)
        t.hangs = s.hangs - 1
        return True
    return False


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
