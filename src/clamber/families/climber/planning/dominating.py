"""Which stances can do all that a limbed climber's stance can, and maybe more: what exact search may drop one for."""

from ....compiled import kernel
from .step import copy_stance


@kernel
def freer(p, s, which, t):
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
