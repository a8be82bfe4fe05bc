"""The swing of a body that one limb holds (page "The model", section 5)."""

import math

from ....compiled import kernel
from ....plane import wrap
from ....planning.problem.check import UNLIMITED
from .near import arc_clearance
from .pose import count_holders, place
from .records import holds

STRAIGHT = 1.0e-9
"""A body that is straight above its hold to within this may swing either way [rad]."""


@kernel
def hang(p, s):
    """Turn the body about its one hold until its origin is straight below; returns the swing margin [m] (page "The model", 5)."""
    _, i = count_holders(p, s)
    hold = holds(p)[s.hold[i]]
    rx = s.x - hold.x
    ry = s.y - hold.y
    r = math.sqrt(rx * rx + ry * ry)
    if r < 1e-9:
        return UNLIMITED
    angle = math.atan2(ry, rx)
    turn = wrap(-0.5 * math.pi - angle)
    s.ix = int(round((hold.x - p.x0) / p.tick))
    s.iy = int(round((hold.y - r - p.y0) / p.tick))
    s.ia = (s.ia + int(round(turn / p.tick_angle))) % p.turn_ticks
    s.turned += turn
    place(p, s)
    near = arc_clearance(p, hold.x, hold.y, r, angle, turn)
    if abs(turn) > math.pi - STRAIGHT:
        near = min(near, arc_clearance(p, hold.x, hold.y, r, angle, -turn))
    margin = near - p.clearance if near < math.inf else UNLIMITED
    if p.max_swing < math.pi:
        margin = min(margin, r * (p.max_swing - abs(turn)))
    return margin
