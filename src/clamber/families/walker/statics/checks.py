"""The checks of a two-frame walker's stance: order, unit and meaning of each margin (positive holds, negative fails)."""

from typing import Final

from ....planning.problem.check import Check

WALKER_CHECKS: Final[tuple[Check, ...]] = (
    Check(
        "stroke",
        "m",
        "how far the actuators' lengths lie inside their range, smallest of the three, less what the task asks for",
    ),
    Check("singular", "m", "guarded distance at which the mechanism is singular, less the distance of the origins"),
    Check(
        "foothold",
        "m",
        "distance of the standing feet from the nearest patch or edge of the ground, less what the task asks for",
    ),
    Check("balance", "m", "how far the centre of mass lies inside the standing feet, less what the task asks for"),
    Check("legs", "m", "range of plate heights at which every leg has the length that its foot needs"),
)
"""In the order in which a failing check is named as the reason; all are hard unless the task says otherwise."""
