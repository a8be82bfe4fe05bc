"""Grab and release with a hook, or a foot: straight in from off the hold, pushed until it stops, tugged; straight back off it."""

import math
from collections.abc import Callable, Iterator, Sequence
from typing import Final

import numpy as np

from ....types import Floats
from .approach import Approach
from .climber import Climber
from .hook_back import back_off as back_off
from .hook_release import release as release
from .hook_release import stand_off_of
from .hook_seat import comes_home
from .motions import may_move, move_body, move_tip

NEAR: Final = 0.022
"""From here on, and the hold's doubt farther off, the hook is pushed, not placed: nearer, its flare would meet the hold sideways [m]."""
ASIDE: Final = (0.0, 0.8, -0.8, 1.4, -1.4, 0.0)
"""Across the hook, where each try aims, in doubts of the map [-]."""
MOST_SHIFTS: Final = 2
"""That often the body makes room for one way: its limbs are elsewhere after the first [-]."""
ASTRAY: Final = 0.05
"""A body may be as far from where a plan has it when a limb takes a hold, if the others hold no worse there, along x and y [m] ..."""
TURNED: Final = 0.05
"""... and turned by as much [rad]."""
FORTH: Final = (0.2, 0.9)
"""In which a hook then goes to before the hold, the first time and after a miss, when it may meet the hold sideways: its motors, which
their gears make heavy, would knock other hooks off [s]."""
FADING: Final = 1.0
"""In which the pull of a hook that is not home goes down where the body hangs, about a swing [s]."""


def come_near(climber: Climber, i: int, number: int, doubt: float, elbow: int, home: Floats | None) -> Approach | None:
    """Move the body to where there is a way for a limb, and find the way from there; None where there is none."""
    body, hold = climber.body, climber.holds[number].copy()
    wished, near = stand_off_of(climber, i, doubt), NEAR + doubt

    def way(stands: Callable[[Floats], bool], *, straight: bool = True) -> Approach | None:
        climber.plant.pause()
        return climber.approaches.find(
            i, body.q[i] - body.play[i], body.settled, hold, climber.holds, elbow=elbow, stand_off=wished, near=near,
            stands=stands, straight=straight,
        )  # fmt: skip

    if home is not None:
        found = way(_stays, straight=False)
        if found is not None:
            return found
        move_body(climber, home)
    for left in reversed(range(MOST_SHIFTS + 1)):
        may = left and not climber.hangs
        found = way(may_move(climber) if may else _stays)
        if found is None and may:  # holds are rarely as near as they may be
            found = way(may_move(climber, touching=True))
        if found is None or not found.shift.any():
            return found
        move_body(climber, body.aim + np.array((*found.shift, 0.0)))
    return None


def places(
    climber: Climber, i: int, hold: Floats, doubt: float, found: Approach, before: Sequence[Floats]
) -> Iterator[Floats]:
    """Where each try aims: at the hold as believed, then beside it, across the hook, first on the other side of where it missed."""
    across = np.array((-found.grab[1], found.grab[0]))
    for part in ASIDE:
        side = -math.copysign(1.0, float((before[0] - hold) @ across)) if before else 1.0
        yield hold + side * part * doubt * across


def close(
    climber: Climber, i: int, hold: Floats, doubt: float, found: Approach, place: Floats, before: Sequence[Floats]
) -> bool:
    """Push the hook on at a place; whether it came to rest where the hold may be, and not on its flare."""
    if not move_tip(climber, i, place - (NEAR + doubt) * found.grab, FORTH[bool(before)]):
        return False
    if comes_home(climber, i, hold, doubt, found.grab, place, before):
        return True
    if not climber.hangs:
        return False
    # as the pull fades the body comes back, and draws a hook that has caught with its flare across its hold
    _fade(climber, i)
    if comes_home(climber, i, hold, doubt, found.grab, place, before):
        return True
    _fade(climber, i)
    return False


def press_on(climber: Climber, i: int, hold: Floats, doubt: float) -> bool:
    """Push a hook that has slid back, but not off its hold, home from where it is; whether it came to rest there."""
    return comes_home(climber, i, hold, doubt, climber.body.grab_direction(i), hold, ())


def _fade(climber: Climber, i: int) -> None:
    """Let a hook pull less and less, until not at all: let go of at once, a body that it has drawn aside swings."""
    task, force = climber.body.tasks[i], climber.body.tasks[i].force.copy()
    count = round(FADING / climber.plant.period)
    for k in range(count):
        task.force = (1.0 - (k + 1) / count) * force
        climber.tick()


def may_stay(climber: Climber, i: int, pose: Floats) -> bool:
    """Whether limb `i` may take a hold from where the body is, near another pose: the limbs that then carry hold no worse here."""
    body = climber.body
    off = np.abs(pose - body.aim)
    if climber.hangs or off[:2].max() > ASTRAY or off[2] > TURNED:
        return False
    others = [j for j, task in enumerate(body.tasks) if j != i and task.hold]
    return body.stands(body.aim, others) >= min(0.0, body.stands(pose, others))


def _stays(pose: Floats) -> bool:
    return False
