"""What a check of a stance is, whatever the robot, and the numbers that all judge by."""

from dataclasses import dataclass

TICKS = 1 << 20
"""Ticks of one step of the body: poses are integers."""
UNLIMITED = 1.0e9
"""A margin that nothing limits."""
TOLERANCE = 1.0e-9
"""A check is violated below minus this, in its own unit."""


@dataclass(frozen=True, slots=True)
class Check:
    """One physical check of a stance."""

    name: str
    """As task files and tables call it."""
    unit: str
    """Unit of its margin; "1" for a count."""
    meaning: str
    """What the margin says, in one line."""
