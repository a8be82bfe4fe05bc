"""Grab and release with a gripper: bring the open jaws about the hold, close them, look whether they hold; open them and back off."""

from collections.abc import Iterator, Sequence
from typing import Final

import numpy as np

from ....types import Floats
from .approach import LEAST_CLEARANCE, Approach, Obstacles, discs_near, free_distance, moves_for_room, places_beside
from .climber import Climber
from .motions import move_body, move_tip
from .postures import Posture, postures

SLANTS: Final = (0, 15, -15, 30, -30, 45, -45, 60, -60, 75, -75, 90, -90)
"""Angles between the way in and the grab direction, in the order in which they are tried [deg]."""


def way_in(climber: Climber, i: int, hold: Floats, elbow: int, doubt: float) -> Approach | None:
    """A way for limb `i` to a place off a hold from which it can go straight in; None where there is none.

    Args:
        climber: The robot; the limb is free.
        i: Index of the limb.
        hold: Place of the hold, world frame [m].
        elbow: Side of the elbow to hold with, +1 or -1; 0: either.
        doubt: How far off the hold may be along each axis [m].

    Returns:
        The way; `grab` is the direction of the straight way in.
    """
    for shift, pose in moves_for_room(climber.body.settled, hold, lambda pose: True):
        for final in postures(climber.robot.limbs[i], pose, hold):
            if final.inside and elbow * final.angles[1] >= 0.0:
                found = _from_beside(climber, i, pose, hold, final, doubt)
                if found is not None:
                    return Approach(shift, *found)
    return None


def way_out(climber: Climber, i: int, doubt: float) -> Floats:
    """Where limb `i`, its jaws open about its hold, backs off to: the first place that is clear, or the clearest, world frame [m]."""
    body = climber.body
    tip, best, most = body.tip(i), body.tip(i), -np.inf
    final = Posture(body.q[i] - body.play[i], body.grab_direction(i), inside=True)
    pose = body.settled
    wished = free_distance(climber.peg_radius, doubt)
    obstacles = _obstacles(climber, pose)
    for _, _, place, posture in places_beside(climber.robot.limbs[i], pose, tip, final, wished, SLANTS):
        room = climber.approaches.room(i, posture.angles, obstacles)
        if room > most:
            best, most = place, room
        if room >= LEAST_CLEARANCE:
            break
    return best


def _from_beside(
    climber: Climber, i: int, pose: Floats, hold: Floats, final: Posture, doubt: float
) -> tuple[Floats, Floats, float] | None:
    body, ways = climber.body, climber.approaches
    wished = free_distance(climber.peg_radius, doubt)
    obstacles = _obstacles(climber, pose)
    for towards, _, place, posture in places_beside(climber.robot.limbs[i], pose, hold, final, wished, SLANTS):
        if ways.room(i, posture.angles, obstacles) < LEAST_CLEARANCE / 2:
            continue
        way = ways.way(i, body.q[i] - body.play[i], posture.angles, obstacles)
        if way is not None:
            return way, towards, float(np.hypot(*(hold - place)))
    return None


def _obstacles(climber: Climber, pose: Floats) -> Obstacles:
    return climber.approaches.obstacles(discs_near(climber.discs(), pose))


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
    task.mode, task.place = "unloaded_contact", place.copy()  # the jaws draw the tip to the hold
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
    task.mode, task.pressed = "contact_push", True
    for k in range(round(2 * TUG_RISE / period)):
        task.force = -TUG * min(k * period / TUG_RISE, 1.0) * g
        task.tug = task.force
        climber.tick()
    task.pressed, task.tug = False, np.zeros(2)
    return bool(climber.gripped[i])
