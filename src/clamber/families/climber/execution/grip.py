"""Grab and release with a gripper: bring the open jaws about the hold, close them, look whether they hold; open them and back off."""

from collections.abc import Iterator, Sequence
from typing import Final

import numpy as np

from ....types import Floats
from .approach import Approach
from .climber import Climber
from .grip_ways import way_in, way_out
from .motions import move_body, move_tip

AROUND: Final = ((0.0, 0.0), (0.8, 0.0), (-0.8, 0.0), (0.0, 0.8), (0.0, -0.8), (0.8, 0.8), (-0.8, -0.8))
"""Where each try closes, along and across the grab direction from the hold as believed, in errors of the map [-]."""
CLOSED: Final = 0.3
"""After that long jaws have brought what they caught to their middle, or are shut on nothing [s]."""
TUG: Final = 10.0
"""Pull on closed jaws against the grab direction, where they alone hold [N]."""
TUG_RISE: Final = 0.2
"""In which it grows; it then stays as long [s]."""


def release(climber: Climber, i: int) -> None:
    """Hand the load over, open the jaws, and back off."""
    climber.carry_with_all(but=i)
    task = climber.body.tasks[i]
    climber.grips[i] = 0
    move_tip(climber, i, way_out(climber, i, climber.map.error(task.hold)), 0.5)
    climber.learn_again()
    task.hold = 0
    task.stay(climber.body.q[i])


def come_near(climber: Climber, i: int, number: int, doubt: float, elbow: int, home: Floats | None) -> Approach | None:
    """Move the body to where there is a way for the open jaws, and find the way from there; None where there is none."""
    body, hold = climber.body, climber.holds[number]
    climber.grips[i] = 0
    found = way_in(climber, i, hold, elbow, doubt)
    if home is not None and (found is None or found.shift.any()):
        move_body(climber, home)
        found = way_in(climber, i, hold, elbow, doubt)
    if found is not None and found.shift.any():
        move_body(climber, body.aim + np.array((*found.shift, 0.0)))
        found = way_in(climber, i, hold, elbow, doubt) or found
    return found


def places(
    climber: Climber, i: int, hold: Floats, doubt: float, found: Approach, before: Sequence[Floats]
) -> Iterator[Floats]:
    """Where each try closes: at the hold as believed, then around it."""
    g = found.grab
    for forth, aside in AROUND:
        yield hold + doubt * (forth * g + aside * np.array((-g[1], g[0])))


def close(
    climber: Climber, i: int, hold: Floats, doubt: float, found: Approach, place: Floats, before: Sequence[Floats]
) -> bool:
    """Shut the jaws about a place; whether they hold something."""
    task = climber.body.tasks[i]
    move_tip(climber, i, place, 0.6)
    climber.wait(0.1)
    climber.grips[i] = 1
    task.doing, task.place = "cling", place.copy()  # the jaws draw the tip to the hold
    climber.wait(CLOSED)
    return bool(climber.gripped[i]) and _holds(climber, i, found.grab)


def press_on(climber: Climber, i: int, hold: Floats, doubt: float) -> bool:
    """Jaws that do not hold any more have to come anew."""
    return False


def back_off(climber: Climber, i: int, hold: Floats, doubt: float, found: Approach) -> None:
    """Open the jaws, and back to where they came in from."""
    climber.grips[i] = 0
    move_tip(climber, i, hold - found.stand_off * found.grab, 0.5)


def _holds(climber: Climber, i: int, g: Floats) -> bool:
    """Whether closed jaws bear a tug, which also brings the joints to one side of their play."""
    task, period = climber.body.tasks[i], climber.plant.period
    task.doing, task.pressed = "pull", True
    for k in range(round(2 * TUG_RISE / period)):
        task.force = -TUG * min(k * period / TUG_RISE, 1.0) * g
        task.tug = task.force
        climber.tick()
    task.pressed, task.tug = False, np.zeros(2)
    return bool(climber.gripped[i])
