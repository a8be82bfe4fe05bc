"""What a family takes from elsewhere: another program's model of a robot, or a climb of another family that it carries out."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from ..types import Floats
from .regions import GoalBox


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


@dataclass(frozen=True, slots=True, kw_only=True)
class PlaneClimb:
    """A climb by limbs that grip, in a plane, SI; x to the right, y up."""

    name: str
    title: str
    robot: str
    """Its name; so is that of the wall."""
    wall: str
    model: str = field(repr=False)
    """The robot alone, as MJCF: body `body`, x to its right and z out of the wall, a site at each tip, named "LIMB tip"."""
    limbs: Mapping[str, tuple[float, ...]]
    """Limb -> its joints at the start [rad]."""
    speed: float
    """Of its slowest motor without load [rad/s]."""
    weight: float
    """[N]."""
    opening: float | None
    """Width of open jaws [m]; None: three times that of a hold."""
    strength: float | None
    """Least force that opens closed ones [N]; None: any bears."""
    holds: Floats
    """Places [m], shape (holds, 2)."""
    strengths: Floats
    """Of the holds [N], infinite where not stated, shape (holds,)."""
    radius: float
    """Of the largest of them [m]."""
    start: tuple[float, float, float]
    """Of the body [m], [m], [rad]."""
    held: Mapping[str, int] | None
    """Limb -> its hold at the start, from 1 in the order of `holds`; None: of those there, it is not on all."""
    length: float
    """Of a step [m]."""
    angle: float
    """Of a turn [rad]."""
    goals: tuple[GoalBox, ...]
    """To be met one after the other."""
