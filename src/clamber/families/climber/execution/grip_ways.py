"""Ways in and out for a gripper: it may come to a hold from any side of its open jaws, not along its grab direction alone."""

from collections.abc import Iterator
from typing import Final

import numpy as np

from ....types import Floats
from ..control.swing_path import clearance, find_way
from .approach import (
    CELLS,
    HOOK,
    LEAST_CLEARANCE,
    MOST_POINTS,
    SHIFTS,
    STAND_OFFS,
    Approach,
    discs_near,
    free_distance,
    wall_of,
)
from .climber import Climber
from .postures import Posture, postures

SLANTS: Final = tuple(np.radians((0, 15, -15, 30, -30, 45, -45, 60, -60, 75, -75, 90, -90)))
"""Angles between the way in and the grab direction, in the order in which they are tried [rad]."""


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
    for part in SHIFTS:
        side = float(np.sign(hold[0] - climber.body.settled[0]))
        shift = np.array((part[0] * side, part[1]))
        pose = climber.body.settled + np.array((*shift, 0.0))
        for final in postures(climber.robot.limbs[i], pose, hold):
            if final.inside and elbow * final.angles[1] >= 0.0:
                found = _from_beside(climber, i, pose, hold, final, doubt)
                if found is not None:
                    way, towards, distance = found
                    return Approach(shift, way, towards, distance)
    return None


def way_out(climber: Climber, i: int, doubt: float) -> Floats:
    """Where limb `i`, its jaws open about its hold, backs off to: the first place that is clear, or the clearest, world frame [m]."""
    body = climber.body
    tip, best, most = body.tip(i), body.tip(i), -np.inf
    final = Posture(body.q[i] - body.play[i], body.grab_direction(i), inside=True)
    for _, place, posture in _beside(climber, i, body.settled, tip, final, doubt):
        room = _room(climber, i, body.settled, posture)
        if room > most:
            best, most = place, room
        if room >= LEAST_CLEARANCE:
            break
    return best


def _from_beside(
    climber: Climber, i: int, pose: Floats, hold: Floats, final: Posture, doubt: float
) -> tuple[Floats, Floats, float] | None:
    limb, body = climber.robot.limbs[i], climber.body
    lower = np.array((limb.shoulder.lower, limb.elbow.lower))
    upper = np.array((limb.shoulder.upper, limb.elbow.upper))
    discs, path = discs_near(climber.holds, pose, climber.approaches.peg_radius), np.zeros((MOST_POINTS, 2))
    for towards, place, posture in _beside(climber, i, pose, hold, final, doubt):
        if _room(climber, i, pose, posture) < LEAST_CLEARANCE / 2:
            continue
        count = find_way(
            body.legs[i], lower, upper, CELLS, body.q[i] - body.play[i], posture.angles, discs, wall_of(climber.robot),
            climber.robot.link_radius, HOOK, LEAST_CLEARANCE, path,
        )  # fmt: skip
        if count:
            return path[:count].copy(), towards, float(np.hypot(*(hold - place)))
    return None


def _beside(
    climber: Climber, i: int, pose: Floats, hold: Floats, final: Posture, doubt: float
) -> Iterator[tuple[Floats, Floats, Posture]]:
    """Directions of ways in to a hold, the places off it where they begin, and the postures there, elbow on the side of the last."""
    wished = free_distance(climber.peg_radius, doubt)
    for part in STAND_OFFS:
        for slant in SLANTS:
            c, s = np.cos(slant), np.sin(slant)
            towards = np.array((c * final.grab[0] - s * final.grab[1], s * final.grab[0] + c * final.grab[1]))
            place = hold - part * wished * towards
            for posture in postures(climber.robot.limbs[i], pose, place):
                if posture.inside and posture.angles[1] * final.angles[1] > 0.0:
                    yield towards, place, posture


def _room(climber: Climber, i: int, pose: Floats, posture: Posture) -> float:
    discs = discs_near(climber.holds, pose, climber.approaches.peg_radius)
    q, legs, robot = posture.angles, climber.body.legs, climber.robot
    return float(clearance(legs[i], q[0], q[1], discs, wall_of(robot), robot.link_radius, HOOK))
