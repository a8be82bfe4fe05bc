"""Footholds proved before they are relied upon: a frame that has come down is loaded and pushed about while the other still stands.

A leg has one freedom and feels along itself only, so it cannot tell an edge from the flat beside it. But a foot that stands on an edge
slips off it under load, or when it is pushed, and does so at once. So after each landing the new feet are made to carry nearly all, and
the frames push each other around a small circle, which shears every foot to every side. What slips then, slips while five others stand.
"""

import math
from typing import Final

import numpy as np

from ....control.loads import strain_of
from ....types import Floats
from ..control.gait import lengths_at
from . import motions
from .walker import LEGS, Walker

KEPT: Final = 40.0
"""What each foot of the other frame goes on carrying while the new ones are proved [N]."""
LOADING: Final = 1.5
"""In which the new feet take load [s] ..."""
ROUND: Final = 2.5
"""... and the frames push each other once around [s]."""
HANGS: Final = 0.5
"""A foot that feels less than this part of what counts as touching has lost its ground [-]."""
SLID: Final = 0.002
"""A foot that has come so far down has slipped off something [m]."""
AGAIN: Final = 4
"""Trials of a landing, at most."""


def prove(walker: Walker, frame: int) -> list[int]:
    """Load the feet of a frame that has just come down, and push them about, until nothing gives way or `AGAIN` times; all stand then.

    Args:
        walker: The robot, on six feet.
        frame: The new one.

    Returns:
        Legs whose feet slipped off something.

    Raises:
        FallenError: If the robot falls.
    """
    mine = walker.of_frame(frame)
    before = walker.soles[list(mine), 2].copy()
    for _ in range(AGAIN):
        if _try(walker, frame):
            break
        motions.lower(walker, range(LEGS))
    walker.strain[:] = 0.0
    motions.settle(walker, LOADING)
    return [i for i, height in zip(mine, before, strict=True) if walker.soles[i, 2] < height - SLID]


def _try(walker: Walker, frame: int) -> bool:
    """Prove once; whether all feet kept their ground."""
    place = walker.place.copy()
    walker.strain[:] = proof_strain(walker, frame)
    seconds = 2.0 * LOADING + ROUND
    for k in range(1, round(seconds / walker.period) + 1):
        time = k * walker.period
        swing = min(1.0, max(0.0, time - LOADING)) * min(1.0, max(0.0, seconds - LOADING - time) / 0.5)
        angle = math.tau * (time - LOADING) / ROUND
        push = swing * 2.0 * walker.settings.probe * np.array((math.cos(angle), math.sin(angle), 0.0))
        walker.actuators[:] = lengths_at(walker.robot, (place + push)[None])[0]
        walker.tick()
        hangs = (walker.stands > 0) & (walker.forces < HANGS * walker.settings.touch)
        if time > LOADING and hangs.any():
            walker.actuators[:] = lengths_at(walker.robot, place[None])[0]
            return False
    return True


def proof_strain(walker: Walker, frame: int) -> Floats:
    """By how much more than its even share each leg is to carry so that a frame carries all but a little, shape (6,) [N]."""
    sign = np.full(LEGS, -1.0)
    sign[walker.of_frame(frame)] = 1.0
    pattern = strain_of(walker.places, sign, walker.stands)
    even = walker.forces - strain_of(walker.places, walker.forces, walker.stands)
    less = pattern < -1e-6
    if not less.any():
        return np.zeros(LEGS)
    size = float(((even - KEPT)[less] / -pattern[less]).min())
    strain: Floats = max(0.0, size) * pattern
    return strain
