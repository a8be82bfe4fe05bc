"""The planar 3-RPR parallel mechanism that joins the two frames, as a robot file states it."""

import math
from typing import Annotated

from ...specs import spec
from ...units import Angle, PositiveLength, PositiveSpeed, Quantity


@spec
class Mechanism:
    """The planar 3-RPR parallel mechanism: actuator i joins attachments i of the Delta-frame and the Y-frame."""

    radius_delta: PositiveLength
    """Circle of the Delta-frame's attachments, about its origin [m]."""
    radius_y: PositiveLength
    """Circle of the Y-frame's attachments, about its origin [m]."""
    first: Angle
    """Direction of the Delta-frame's first attachment in its own frame; the others follow by thirds of a turn [rad]."""
    offset: Angle
    """Direction of the Y-frame's first attachment in its own frame, less `first` [rad]."""
    shortest: PositiveLength
    """Length of an actuator that is drawn in [m]."""
    stroke: PositiveLength
    """By how much an actuator extends [m]."""
    speed: PositiveSpeed
    """Fastest that an actuator extends or draws in [m/s]."""
    guard: Annotated[float, Quantity("ratio", above=0.0, at_most=1.0)]
    """The origins stay closer than this share of the distance at which the mechanism is singular [-]."""

    @property
    def longest(self) -> float:
        """Length of an extended actuator [m]."""
        return self.shortest + self.stroke

    def singular_distance(self, twist: float) -> float:
        """Distance rho of the frames' origins at which the mechanism is singular [m].

        Args:
            twist: Angle of the Y-frame in the Delta-frame [rad].
        """
        a, b = self.radius_delta, self.radius_y
        return math.sqrt(max(0.0, a * a + b * b - 2.0 * a * b * math.cos(self.offset + twist)))
