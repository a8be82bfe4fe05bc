"""Robots that begin as another program's model: what a family found in it, and the robot file that it starts."""

from dataclasses import dataclass, field


@dataclass(frozen=True, slots=True, kw_only=True)
class ImportedLimb:
    """A limb that was found."""

    name: str
    joints: tuple[str, ...]
    """From the base to the tip."""
    tip: str
    """Frame of the model at its end."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ImportedRobot:
    """A model that was read, and the robot file that it starts."""

    name: str
    mass: float
    """[kg]."""
    limbs: tuple[ImportedLimb, ...]
    repaired: tuple[str, ...]
    """What was changed or guessed, in sentences."""
    dropped: tuple[str, ...]
    """What was left out, in sentences."""
    text: str = field(repr=False)
    """Of the robot file."""
