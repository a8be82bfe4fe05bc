"""What a robot in space carries, and how it moves and takes holds, as its file may state it."""

from typing import Annotated

from pydantic import Field

from ....specs import spec
from ....units import Length, NonNegativeMass, PositiveRatio


@spec
class Payload:
    """What the base carries."""

    mass: NonNegativeMass
    """[kg]."""
    at: tuple[Length, Length, Length] = (0.0, 0.0, 0.0)
    """Its centre of mass, base frame [m]."""


@spec
class Handling:
    """Shares of the robot's own measures.

    Its agility is the acceleration that its strongest joints could give its mass at the length of its longest limb, never more than
    that of free fall on Earth. The defaults were chosen on the six robots that come with Clamber; no robot has others.
    """

    body: PositiveRatio = 0.05
    """Largest acceleration of the body on its way, of the agility [-]."""
    swing: PositiveRatio = 0.2
    """The same of a tip that swings [-]."""
    shift: PositiveRatio = 1.0
    """Time in which load passes from one set of limbs to another, of what the agility takes for the length of a limb [-]."""
    touch: PositiveRatio = 0.02
    """Force at which a foot stands, of the weight on Earth [-]."""
    stand: PositiveRatio = 0.04
    """Force that a foot which stands is asked to press with at least, of the weight on Earth [-]."""
    firm: PositiveRatio = 0.06
    """Force at which an end effector that does not attach has no hold there, of the weight on Earth [-]."""
    press: PositiveRatio = 0.1
    """Force of a tip that feels for its hold once it misses its aim by `depth`, of the weight on Earth [-]."""
    approach: PositiveRatio = 0.03
    """Speed of a tip that feels for its hold, of what the agility gives over the length of a limb [-]."""
    depth: PositiveRatio = 0.1
    """How far beyond its hold it feels, of the length of a limb [-]."""
    deep: PositiveRatio = 0.04
    """A foot that finds its ground so much deeper than its hold looks for it beside first, of the length of a limb [-]."""
    beside: PositiveRatio = 0.02
    """From a hold to the next place where it is felt for, of the length of a limb [-]."""
    tries: Annotated[int, Field(strict=True, ge=1, le=50)] = 7
    """Places that are felt for a hold, the first two where it is believed to be, the others about that."""
    lost: PositiveRatio = 0.3
    """A body that is so far from where it is to be has fallen, of the length of a limb [-]."""
