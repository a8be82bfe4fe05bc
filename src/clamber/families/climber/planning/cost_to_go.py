"""What a map asks of a climber's stance: where it is, which goals it fits, what it costs to be there."""

import math

from ....compiled import inlined, kernel
from ....planning.problem.check import TOLERANCE, UNLIMITED
from ..statics.forces import NO_SPLIT
from ..statics.records import goals, holds, limbs
from ..statics.stance import HOOK, POWER, TORQUE, judge
from .goals import fits
from .step import copy_stance

STANCE_COSTS = ("torque_Nm", "torque_share", "payload_N", "power_W")
"""Largest joint torque, the largest share of a joint's limit, the extra weight that the stance still carries, power."""
PRECISION = 1.0e-3
"""Of a factor on the weight that is found by bisection, as a share of it [-]."""
HEAVIEST = 1.0e4
"""Weights beyond so many times the robot's are not tried."""


@inlined
def body_pose(p, s, words):
    """Where a stance is: the body's pose in ticks, the hold of each limb."""
    words[0] = s.ix
    words[1] = s.iy
    words[2] = s.ia
    for i in range(p.n_limbs):
        words[3 + i] = s.hold[i]


@kernel
def satisfies_goal(p, s, k):
    """Whether a stance is where goal k asks for; turns are not asked."""
    return fits(p, s, goals(p)[k])


@kernel
def stance_cost(p, s, spare, margins, row):
    """Write `STANCE_COSTS` of a judged stance; not a number where no split of the weight exists.

    The payload is (f - 1) W: the robot may weigh f times as much before a joint reaches its torque limit or a hard check breaks. Forces
    and torques are proportional to the weight (page "The reachable space"), and power to its square, so

        f = min(1 / share, sqrt(max_power / power)),

    where no hard check and no strength of a hold or an end effector breaks the proportion; else f is found by bisection below that.

    Args:
        p: Parameters; the weight changes and is put back.
        s: Stance record.
        spare: Scratch, a stance record.
        margins: Scratch of the checks.
        row: Output, shape (4,).
    """
    if s.torque >= NO_SPLIT:
        for i in range(4):
            row[i] = math.nan
        return
    share = 0.0
    carriers = 0
    strong = True
    for i in range(p.n_limbs):
        if s.carriers & (1 << i):
            carriers += 1
            share = max(
                share, max(abs(s.torques[i, 0]) / limbs(p)[i].limit1, abs(s.torques[i, 1]) / limbs(p)[i].limit2)
            )
            strong = strong and min(holds(p)[s.hold[i]].strength, limbs(p)[i].strength) == math.inf
    factor = 1.0 / share if share > 0.0 else math.inf
    if p.hard & (1 << POWER) and s.power > 0.0:
        factor = min(factor, math.sqrt(p.max_power / s.power))
    planned = p.force_rule == 0 and carriers <= 2  # the split doesn't look at what the holds can take
    if factor > 1.0 and (p.hard & (1 << HOOK) or not (strong or planned)):
        factor = bisected(p, s, spare, margins, factor)
    row[0] = s.torque
    row[1] = share
    row[2] = p.weight * (factor - 1.0)
    row[3] = s.power


@kernel
def bisected(p, s, spare, margins, most):
    """A factor on the weight, from 1 to `most`, that the judge allows, though not one a thousandth larger; `most` if it allows that."""
    weight = p.weight
    low = 1.0
    high = min(most, HEAVIEST)
    if bears(p, s, spare, margins, weight * high):
        p.weight = weight
        return most
    while high - low > PRECISION * low:
        middle = 0.5 * (low + high)
        if bears(p, s, spare, margins, weight * middle):
            low = middle
        else:
            high = middle
    p.weight = weight
    return low


@kernel
def bears(p, s, spare, margins, weight):
    """Whether a stance holds with another weight."""
    copy_stance(p.n_limbs, s, spare)
    p.weight = weight
    return judge(p, spare, -1, UNLIMITED, margins) < 0 and margins[TORQUE] >= -TOLERANCE
