"""Whether a hook that was pushed on came home: to rest in the bottom of its opening, on its hold, and not on the lips of its flare."""

import math
from collections.abc import Sequence
from typing import Final

from ....types import Floats
from .climber import Climber
from .hook_push import push_on

SLACK: Final = 0.008
"""Beyond its doubt, how far a seated hook may be from where it should be: play and backlash [m]."""
SHALLOW: Final = (0.010, 0.015)
"""A hook that stops the first of these before its hold may rest on its flare against it, however hard it is pushed, and slip off later:
it counts as seated where it comes to the same place once more, pushed on from elsewhere; at the second it doesn't at all [m]."""
FAR_OFF: Final = (0.006, 0.012)
"""Likewise one that stops, beyond what the hold is in doubt by, the first of these off it, or the second in all, any way: it may lie on
it with the outer end of its flare [m]."""
PASSED: Final = 0.013
"""One that stops beyond its hold, so far off in all: it may have passed it by, and lean on it with the limb [m]."""
DEEPER: Final = 0.004
"""Likewise one that has come so much farther in an earlier try: nothing goes farther onto its hold than a hook that is home [m]."""
FROM_A_HANG: Final = (0.0115, 0.0125)
"""From a body that hangs one that stops less than the first before its hold, and where that may be, is home: taken off to be tried again, a
hook that was sets the body swinging, and few were not. At the second it isn't, even where it comes there again [m]."""
AT_FULL_REACH: Final = (math.radians(25.0), 0.006, 0.003)
"""A limb whose elbow is straighter than the first may have stopped at the end of its reach, not on its hold: it has if it stops the second
before, and may have where it stops so far off, or the third before [m]."""
SAME: Final = 0.003
"""Two places that are so near to each other are the same [m]."""


def comes_home(
    climber: Climber, i: int, hold: Floats, doubt: float, g: Floats, place: Floats, before: Sequence[Floats]
) -> bool:
    """Push a hook on at a place along its grab direction, and judge by where it stopped whether it is on its hold.

    Args:
        climber: The robot.
        i: Index of the limb.
        hold: Where the hold is believed to be, world frame, shape (2,) [m].
        doubt: How far it may be from there, either way [m].
        g: Grab direction, world frame, shape (2,) [-].
        place: At which it is pushed on, world frame, shape (2,) [m].
        before: Where the tip ended in earlier tries at this hold, world frame [m].

    Raises:
        FallenError: If the robot falls.
    """
    room = SLACK + doubt
    stopped = push_on(climber, i, place, g, room)
    tip = climber.body.tip(i)
    short = float((hold - tip) @ g)
    off = math.dist(tip, hold)
    again = any(math.dist(tip, end) < SAME for end in before)
    shallow = FROM_A_HANG if climber.hangs else SHALLOW
    if not stopped or off > (SHALLOW[1] if again else room) or short > shallow[1]:
        return False
    # twins are nearer to each other than the doubt
    if any(math.dist(tip, other) < off for other in climber.holds.values()):
        return False
    # a body that hangs is drawn near until the limb is straight
    straight = abs(climber.body.q.item(i, 1)) < AT_FULL_REACH[0] and not climber.hangs
    if straight and short > AT_FULL_REACH[1]:
        return False
    home = short < shallow[0]
    if straight:
        home = off < AT_FULL_REACH[1] and short < AT_FULL_REACH[2]
    elif not climber.hangs:
        home = home and off < min(FAR_OFF[0] + doubt, FAR_OFF[1] if short > 0.0 else PASSED)
    farther = any(float((end - tip) @ g) > DEEPER and math.dist(end, hold) < room for end in before)
    return (home and not farther) or again
