"""Whether a walk's robot can stand where it starts: its mechanism within reach, its weight within its six feet."""

import math
from typing import Final

import numpy as np

from ....files import Document
from ..robot import TwoFrames
from ..robot.weight import weight_of
from .walk import Walk

HEAVIEST: Final = 1e4
"""Loads are looked for up to this [kg]."""


def check_mechanism(walk: Walk, document: Document) -> None:
    """Makes sure that the actuators reach the place of the Y-frame, short of singular postures.

    Raises:
        SpecError: If not; it names the lengths, or how near it is.
    """
    frames, place = TwoFrames.of(walk.robot.mechanism), walk.start_place()
    lengths = 1e3 * frames.lengths(place)
    if frames.room(place) < 0.0:
        raise document.problem(
            "start",
            f"asks for actuators of {lengths.min():.0f} to {lengths.max():.0f} mm; they can be {1e3 * frames.shortest:.0f} to "
            f"{1e3 * frames.longest:.0f} mm: bring offset and twist nearer to 0",
        )
    if frames.nearness(place) > frames.guard:
        raise document.problem(
            "start",
            f"is {frames.nearness(place):.3g} of the way to a singular posture of the mechanism, where it holds no push; "
            f"{frames.guard:g} is allowed: bring offset and twist nearer to 0",
        )


def why_it_tips(walk: Walk) -> str:
    """Where what a level robot that has tipped carries puts its centre of mass, and what would do on rigid feet; empty without a load."""
    if walk.start.plate != "level" or walk.payload <= 0.0:
        return ""
    margin = start_margin(walk, walk.payload)
    low, high = 0.0, HEAVIEST
    while high - low > 0.01:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if start_margin(walk, middle) > 0.0 else (low, middle)
    side = "inside" if margin > 0.0 else "outside"
    return (
        f"{walk.payload:g} kg put the centre of mass {1e3 * abs(margin):.0f} mm {side} the six feet that it starts on; with the arm like "
        f"this rigid feet would bear up to {math.floor(10.0 * low) / 10.0:.1f} kg, and those that give way less"
    )


def start_margin(walk: Walk, payload: float) -> float:
    """How far the centre of mass of the level robot lies inside its six feet at the start [m]; negative outside.

    Args:
        walk: With the start.
        payload: At the tool point [kg].
    """
    from scipy.spatial import ConvexHull

    place, feet = walk.start_place(), walk.robot.feet().copy()
    c, s = math.cos(place[2]), math.sin(place[2])
    feet[1] = feet[1] @ np.array(((c, s), (-s, c))) + place[:2]
    centre = weight_of(walk.robot, walk.arm or None, payload).centre(np.stack([np.zeros(3), place]))
    equations = ConvexHull(feet.reshape(-1, 2)).equations
    return float((-equations[:, :2] @ centre - equations[:, 2]).min())
