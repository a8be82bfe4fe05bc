"""Where a two-frame walker's weight is."""

from typing import Annotated

from ....specs import spec
from ....units import Length, PositiveMass, Quantity


@spec
class Mass:
    """The robot's mass without its arm: a share at each frame's origin, all at one height above the plate."""

    frames: PositiveMass
    """Both frames and all legs [kg]."""
    share_delta: Annotated[float, Quantity("ratio", at_least=0.0, at_most=1.0)]
    """Share of it on the Delta-frame; the rest is on the Y-frame, each at its origin [-]."""
    height: Length
    """Centre of mass above the plate [m]."""
