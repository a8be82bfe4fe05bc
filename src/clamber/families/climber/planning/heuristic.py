"""How far a limbed climber's stance is from another at least: the bound of a search between two stances of a plan."""

import math

from ....compiled import kernel
from ....planning.problem.check import TICKS
from ..statics.pose import count_holders
from ..statics.stance import HANGS


@kernel
def toward(p, s, t):
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
