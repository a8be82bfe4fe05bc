"""Grab and release with whatever a limb ends in: off the old hold, near the new one, closed there in one place after another."""

import math
from collections.abc import Iterable, Sequence
from typing import Final, Protocol

from ....types import Floats
from . import grip, hook
from .approach import Approach
from .climber import Climber, Grabbed
from .motions import follow

CALM: Final = 0.15
"""After the way to a hold, until the limb has come to rest [s]."""
RESTING: Final = 6.0
"""After a miss, at most until a body that hangs has come to rest: the next try aims at where the hold is from there [s]."""
HELD: Final = 0.1
"""After a hold is taken [s]."""


class End(Protocol):
    """What differs between the ends of limbs. Limb `i` is free but in `release`, the hold as believed, with its doubt either way [m]."""

    def release(self, climber: Climber, i: int) -> None:
        """Take the limb off its hold; the others carry. It may cling to it as before, where it does not come off."""

    def come_near(
        self, climber: Climber, i: int, number: int, doubt: float, elbow: int, home: Floats | None
    ) -> Approach | None:
        """Move the body to where there is a way for the limb, and find the way from there; None where there is none."""

    def places(
        self, climber: Climber, i: int, hold: Floats, doubt: float, found: Approach, before: Sequence[Floats]
    ) -> Iterable[Floats]:
        """Where each try closes, world frame [m]. `before`: where the tip ended in those so far, which grows meanwhile."""

    def close(
        self,
        climber: Climber,
        i: int,
        hold: Floats,
        doubt: float,
        found: Approach,
        place: Floats,
        before: Sequence[Floats],
    ) -> bool:
        """Close on a place; whether it holds. `before`: where the tip ended in this grab's earlier tries, world frame [m]."""

    def press_on(self, climber: Climber, i: int, hold: Floats, doubt: float) -> bool:
        """Bring an end that has slid on its hold, but not off it, home from where it is; whether it holds."""

    def back_off(self, climber: Climber, i: int, hold: Floats, doubt: float, found: Approach) -> None:
        """Come off where it did not."""


ENDS: Final[dict[str, End]] = {"hook": hook, "foot": hook, "gripper": grip}
"""Kind of end effector -> how it takes holds and leaves them."""


def _end_of(climber: Climber, i: int) -> End:
    return ENDS[climber.robot.limbs[i].end.kind]


def release(climber: Climber, i: int) -> None:
    """Take limb `i` off its hold; the others carry.

    Raises:
        FallenError: If the robot falls.
    """
    _end_of(climber, i).release(climber, i)


def grab(climber: Climber, i: int, number: int, *, elbow: int = 0, home: Floats | None = None) -> Grabbed:
    """Bring limb `i` to a hold and hold on; try again beside where it misses (Bevly 1997, Fig. 4.14).

    Args:
        climber: The robot.
        i: Index of the limb.
        number: Of the hold.
        elbow: Side of the elbow to hold with: +1, -1, or 0 for the end most on top.
        home: Pose to which the body goes where there is no way from where it is, before it makes room; None: it is there.

    Raises:
        FallenError: If the robot falls.
    """
    body, task, end = climber.body, climber.body.tasks[i], _end_of(climber, i)
    if task.hold:
        end.release(climber, i)
    else:
        climber.carry_with_all(but=i)
    if task.hold:
        return Grabbed(False, 0, 0.0, 0.0)
    doubt = climber.doubt(number, i)
    found = end.come_near(climber, i, number, doubt, elbow, home)
    if found is None:
        return Grabbed(False, 0, 0.0, 0.0)
    if not follow(climber, i, found.way):
        return Grabbed(False, 0, 0.0, 0.0)
    climber.wait(CALM)
    climber.learn_again()
    hold, (x, y) = climber.holds[number].copy(), found.grab
    task.side = elbow  # one that misses is drawn straight, and would fold the other way
    along, across = 0.0, 0.0
    ends: list[Floats] = []
    for place in end.places(climber, i, hold, doubt, found, ends):
        holds = end.close(climber, i, hold, doubt, found, place, ends)
        ends.append(body.tip(i))
        off = ends[-1] - hold
        along, across = float(x * off[0] + y * off[1]), float(x * off[1] - y * off[0])
        if holds:
            _take(climber, i, number)
            return Grabbed(True, len(ends), along, across)
        end.back_off(climber, i, hold, doubt, found)
        if climber.hangs:
            climber.rest(RESTING)
    task.stay(body.q[i])
    task.side = 0
    return Grabbed(False, len(ends), along, across)


def press_on(climber: Climber, i: int) -> bool:
    """Bring limb `i`, which has slid on its hold, but not off it, home from where it is; whether it holds. It clings as before where not.

    Raises:
        FallenError: If the robot falls.
    """
    body, task = climber.body, climber.body.tasks[i]
    number = task.hold
    task.hold, task.side = 0, int(math.copysign(1, body.q[i, 1]))
    held = _end_of(climber, i).press_on(climber, i, climber.holds[number].copy(), climber.doubt(number, i))
    if held:
        _take(climber, i, number)
    else:
        task.hold, task.mode, task.side = number, "unloaded_contact", 0
    return held


def _take(climber: Climber, i: int, number: int) -> None:
    """Count limb `i` as on a hold that it has just taken: the map learns from it, and it clings there."""
    task = climber.body.tasks[i]
    climber.learn(number, i, climber.holding())
    climber.latest, climber.proven = i, False
    task.hold, task.place = number, climber.holds[number].copy()
    if not task.pressed:  # else a body that hangs leans on it, until both carry
        task.mode, task.side = "unloaded_contact", 0
    climber.wait(HELD)
