"""Grab and release with a gripper: bring the open jaws about the hold, close them, look whether they hold; open them and back off."""

from typing import Final

import numpy as np

from ...types import Floats
from .climber import Climber, Grabbed
from .grip_ways import way_in, way_out
from .motions import follow, move_body, move_tip

AROUND: Final = ((0.0, 0.0), (0.8, 0.0), (-0.8, 0.0), (0.0, 0.8), (0.0, -0.8), (0.8, 0.8), (-0.8, -0.8))
"""Where each try closes, along and across the grab direction from the hold as believed, in errors of the map [-]."""
CLOSED: Final = 0.3
"""After that long jaws have brought what they caught to their middle, or are shut on nothing [s]."""
TUG: Final = 10.0
"""Pull on closed jaws against the grab direction, where they alone hold [N]."""
TUG_RISE: Final = 0.2
"""In which it grows; it then stays as long [s]."""


def release_gripper(climber: Climber, i: int) -> None:
    """Hand the load over, open the jaws, and back off."""
    climber.carry_with_all(but=i)
    task = climber.body.tasks[i]
    climber.grips[i] = 0
    move_tip(climber, i, way_out(climber, i, climber.map.error(task.hold)), 0.5)
    climber.learn_again()
    task.hold, task.doing, task.angles = 0, "joints", climber.body.q[i].copy()


def grab_with_gripper(climber: Climber, i: int, number: int, *, elbow: int = 0, home: Floats | None = None) -> Grabbed:
    """Bring a limb to a hold and close its jaws; try again beside where they close on nothing.

    Args:
        climber: The robot.
        i: Index of the limb.
        number: Of the hold.
        elbow: Side of the elbow to hold with: +1, -1, or 0 for the jaws most on top.
        home: Pose to which the body goes where there is no way from where it is, before it makes room; None: it is there.

    Raises:
        FallenError: If the robot falls.
    """
    body, task = climber.body, climber.body.tasks[i]
    if task.hold:
        release_gripper(climber, i)
    else:
        climber.carry_with_all(but=i)
    climber.grips[i] = 0
    hold, doubt = climber.holds[number], climber.doubt(number, i)
    found = way_in(climber, i, hold, elbow, doubt)
    if home is not None and (found is None or found.shift.any()):
        move_body(climber, home)
        found = way_in(climber, i, hold, elbow, doubt)
    if found is not None and found.shift.any():
        move_body(climber, body.aim + np.array((*found.shift, 0.0)))
        found = way_in(climber, i, hold, elbow, doubt) or found
    if found is None:
        return Grabbed(False, 0, 0.0, 0.0)
    follow(climber, i, found.way)
    climber.wait(0.15)
    g = found.grab
    h = np.array((-g[1], g[0]))
    along = across = 0.0
    for tries, (forth, aside) in enumerate(AROUND, 1):
        aim = hold + doubt * (forth * g + aside * h)
        move_tip(climber, i, aim, 0.6)
        climber.wait(0.1)
        climber.grips[i] = 1
        task.doing, task.place = "cling", aim.copy()  # the jaws draw the tip to the hold
        climber.wait(CLOSED)
        if climber.gripped[i] and _holds(climber, i, g):
            off = body.tip(i) - hold
            along, across = float(off @ g), float(off @ h)
            climber.learn(number, i, [j for j, other in enumerate(body.tasks) if other.doing == "hold"])
            task.doing, task.hold, task.place = "cling", number, climber.holds[number].copy()
            climber.wait(0.1)
            return Grabbed(True, tries, along, across)
        climber.grips[i] = 0
        move_tip(climber, i, hold - found.stand_off * g, 0.5)
    task.doing, task.angles = "joints", body.q[i].copy()
    return Grabbed(False, len(AROUND), along, across)


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
