"""A hook taken off its hold: the load to the others, which may have to stand elsewhere for it, then straight back."""

from collections.abc import Callable
from typing import Final

import numpy as np

from ....types import Floats
from ..control.hook_push import PUSH, WIDE_DITHER, WIDE_RATE
from ..robot.robot import Limb
from .approach import SHIFTS, free_distance
from .climber import Climber
from .motions import WEAKER, may_move, move_body, move_tip

WIDE_STAND_OFF: Final = 0.042
"""Least distance from a hold at which a hook that opens along its link turns towards it: nearer, its flare knocks the hold [m]."""
AWAY: Final = 0.006
"""A limb that leaves a hold aims this far beyond where it is clear of it: its tip lags its aim [m]."""
LEAVING: Final = 0.5
"""Most time that it then gets to come clear [s]."""
CALM: Final = 0.12
"""Then, until it has come to rest: stopped on the way, it would throw the body about [s]."""
SHAKING: Final = 2.0
"""Most time for which a wedged hook is shaken [s]."""
PROVING: Final = 0.2
"""For so long a hook that carries for the first time does so before the limb that carried until then leaves its own hold: one that has
stopped on its flare slides home in it, or off [s]."""


def release(climber: Climber, i: int) -> None:
    """Take a limb off its hold, against its grab direction, until its tip is clear of it; the others carry.

    A hook that stays wedged clings to its hold as before.
    """
    _lean_on_the_others(climber, i)
    climber.carry_with_all(but=i)
    if climber.latest >= 0 and not climber.proven:
        climber.wait(PROVING)
        climber.proven = True
    body, task = climber.body, climber.body.tasks[i]
    away = stand_off_of(climber, i, climber.map.error(task.hold)) + AWAY
    start, g = _draw_back(climber, i, away)

    def clear() -> bool:
        return float((start - body.tip(i)) @ g) > away - AWAY

    for _ in range(round(LEAVING / climber.plant.period)):
        if clear():
            break
        climber.tick()
    if not clear() and not _shake_off(climber, i, clear):
        task.mode = "unloaded_contact"
        return
    if task.mode == "swing_cartesian":
        climber.wait(CALM)
    task.hold = 0
    task.stay(body.q[i])


def stand_off_of(climber: Climber, i: int, doubt: float) -> float:
    """How far from a hold a limb's hook turns towards it, the hold's place in doubt by so much [m]."""
    return stand_off(climber.robot.limbs[i], climber.peg_radius, doubt)


def stand_off(limb: Limb, radius: float, doubt: float) -> float:
    """The same of any limb, for holds of a radius [m]."""
    free = free_distance(radius, doubt)
    return free if limb.end.offset > 0.0 else max(WIDE_STAND_OFF, free)


def _shake_off(climber: Climber, i: int, clear: Callable[[], bool]) -> bool:
    """Pull a wedged hook back and to and fro, free to go where its walls let it; whether it comes clear."""
    body, task, period = climber.body, climber.body.tasks[i], climber.plant.period
    task.mode, task.pressed = "contact_push", True
    for k in range(round(SHAKING / period)):
        g = body.grab_direction(i)
        task.force = -PUSH * g + WIDE_DITHER * np.sin(2 * np.pi * WIDE_RATE * k * period) * np.array((-g[1], g[0]))
        climber.tick()
        if clear():
            break
    task.pressed = False
    return clear()


def _lean_on_the_others(climber: Climber, i: int) -> None:
    """Move the body to where the two others can carry it, if they cannot here, while limb `i` is still on its hold."""
    body = climber.body
    others = [j for j, task in enumerate(body.tasks) if j != i and task.hold]
    if climber.hangs or len(others) != 2:
        return
    climber.plant.pause()
    margins, stands = [], may_move(climber)
    for x, y in SHIFTS:
        pose = body.settled + np.array((x, y, 0.0))
        margin = body.stands(pose, others)
        margins.append(margin if body.stands(pose, [i]) >= 0.0 and stands(pose) else -np.inf)
        if margin >= 0.0 and margins[-1] == margin:
            break
    best = int(np.argmax(margins))
    if margins[best] > body.stands(body.settled, others) + WEAKER:
        move_body(climber, body.aim + np.array((*SHIFTS[best], 0.0)))


def _draw_back(climber: Climber, i: int, away: float) -> tuple[Floats, Floats]:
    """Draw a hook straight back off its hold by a distance [m], the body moved to where the limb can if it reaches no farther.

    The body moves at the same time where the elbow stays well bent on all of the way, before it otherwise.

    Returns:
        The tip's place and the grab direction from which it was drawn back.
    """
    body = climber.body
    start, g = body.tip(i), body.grab_direction(i)
    shift, in_step = _room_to_leave(climber, i, start, -away * g)
    pose = body.aim + np.array((*shift, 0.0))
    if in_step:
        move_body(climber, pose, drawn=(i, start, -away * g))
        return start, g
    if shift.any():
        move_body(climber, pose)
        start, g = body.tip(i), body.grab_direction(i)
    move_tip(climber, i, start - away * g, 0.35)
    return start, g


def _room_to_leave(climber: Climber, i: int, start: Floats, back: Floats) -> tuple[Floats, bool]:
    """How the body moves so that a limb can draw its hook back, shape (2,) [m], and whether both may move in step."""
    if climber.hangs:
        return np.zeros(2), False
    body, ways = climber.body, climber.approaches
    climber.plant.pause()
    side = float(np.sign(body.q[i, 1] - body.play[i, 1]))
    shift = ways.leave(i, side, body.settled, start, back, climber.discs(), stands=may_move(climber))
    if shift is None or not shift.any():
        return np.zeros(2), False
    return shift, ways.bends(i, side, body.settled, start, back, shift)
