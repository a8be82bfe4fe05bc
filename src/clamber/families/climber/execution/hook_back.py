"""A hook brought off where it missed, past whatever a lip of its flare catches on."""

import math
from typing import Final

import numpy as np

from ....types import Floats
from .approach import Approach
from .climber import Climber
from .hook_release import stand_off_of
from .hook_seat import AT_FULL_REACH, SLACK
from .motions import JOINT_SPEED, follow
from .postures import postures
from .pushed_body import PushedBody

CLEAR: Final = 0.02
"""So far aside a hook that lies beside its hold comes off it without its flare, 15 mm either way, catching there [m]."""
CAUGHT: Final = 0.01
"""A hook that stays so far from where it is to be is caught [m] ..."""
NO_WAY: Final = (0.002, 0.15)
"""... when it has come no farther than the first of these for the second [m], [s]."""
STEP: Final = 0.01
"""Between postures on the way of a hook that its joints bring straight back [m]."""
BACK_SPEED: Final = 0.05
"""Of a hook on its way back: slow, for what it is caught on it pulls at no harder then [m/s]."""


def back_off(climber: Climber, i: int, hold: Floats, doubt: float, found: Approach) -> None:
    """Bring the hook off where it missed: back the way it came, for the hold may be beside it by now, then to before the hold.

    Where a lip of its flare catches below the hold, it goes to the one side first, then to the other; so does one that has passed the hold
    by, before it goes back: on its way there it had not caught, but hooks catch on their way back.
    """
    away, g, tip = stand_off_of(climber, i, doubt), found.grab, climber.body.tip(i)
    across = np.array((-g[1], g[0]))
    deep = float((tip - hold) @ g) + away
    side = math.copysign(CLEAR, float((tip - hold) @ across))  # the hold is more likely on the other one
    passed = deep - away > SLACK + doubt
    sides = (side, 0.0, -side) if passed else (0.0, side, -side)
    for aside in sides if deep > 0.0 else ():
        start = tip + aside * across
        if aside:
            _comes_to(climber, i, start)
        if _comes_to(climber, i, start - deep * g):
            break
    _comes_to(climber, i, hold - away * g)


def _comes_to(climber: Climber, i: int, place: Floats) -> bool:
    """Bring a tip straight to a place, or to where something holds it: pulled on, other hooks come off; whether it comes there."""
    if climber.hangs or abs(climber.body.q.item(i, 1)) < AT_FULL_REACH[0]:
        return _comes_by_joints(climber, i, place)
    body, period = climber.body, climber.plant.period
    task, start = body.tasks[i], body.tip(i)
    length = math.dist(start, place)
    way = (place - start) / max(length, 1e-9)
    task.doing, gone, mark, stands = "tip", 0.0, 0.0, 0.0
    watch = PushedBody(climber)
    while stands < NO_WAY[1]:
        gone = min(gone + BACK_SPEED * period, length)
        task.place, task.speed = start + gone * way, (BACK_SPEED if gone < length else 0.0) * way
        climber.tick()
        if watch.gives_way(i):
            return False
        if math.dist(body.tip(i), place) < CAUGHT:
            break
        come = float((body.tip(i) - start) @ way)
        behind = gone - come > CAUGHT or gone == length
        mark, stands = (come, 0.0) if come > mark + NO_WAY[0] or not behind else (mark, stands + period)
    there = math.dist(body.tip(i), place) < CAUGHT
    task.place, task.speed = place if there else body.tip(i), np.zeros(2)
    return there


def _comes_by_joints(climber: Climber, i: int, place: Floats) -> bool:
    """The same along the postures between: a nearly straight elbow that is to bend at once is thrown by its tip's law.

    From a hang as fast as joints go: there is no other hook to pull off.
    """
    body, task, limb = climber.body, climber.body.tasks[i], climber.robot.limbs[i]
    start, way = body.tip(i), [body.q[i] - body.play[i]]
    side = task.side or math.copysign(1.0, way[0][1])
    for part in np.linspace(0.0, 1.0, max(2, math.ceil(math.dist(start, place) / STEP)) + 1)[1:]:
        fit = postures(limb, body.settled, start + part * (place - start))
        way += [one.angles for one in fit if one.inside and one.angles[1] * side > 0.0][:1]
    if len(way) == 1:
        return False
    turned = float(np.abs(np.diff(way, axis=0)).max(axis=1).sum())
    most = JOINT_SPEED if climber.hangs else min(JOINT_SPEED, BACK_SPEED * turned / max(math.dist(start, place), STEP))
    return follow(climber, i, np.array(way), most=most) and math.dist(body.tip(i), place) < CAUGHT
