"""The legs of a two-frame walker: one freedom each, normal to their frame."""

from ....specs import spec
from ....units import NonNegativeLength, PositiveForce, PositiveLength, PositiveSpeed


@spec
class Legs:
    """Three legs on each frame, in the directions of its attachments; a leg extends along the normal of the plate."""

    radius_delta: PositiveLength
    """Circle of the Delta-frame's feet [m]."""
    radius_y: PositiveLength
    """Circle of the Y-frame's feet [m]."""
    pad_radius: NonNegativeLength
    """Radius of a foot [m]."""
    shortest: PositiveLength
    """Length of a leg that is drawn in, from the plate to the sole [m]."""
    stroke: PositiveLength
    """By how much a leg extends [m]."""
    nominal: PositiveLength
    """Length of a standing leg on level ground [m]."""
    lift: PositiveLength
    """By how much a lifted foot clears the ground [m]."""
    speed: PositiveSpeed
    """Fastest that a leg extends or draws in [m/s]."""
    resolution: PositiveLength
    """One step of a leg's motor [m]."""
    force: PositiveForce | None = None
    """Most that a leg's motor pushes or pulls with [N]; None: no limit is known."""

    @property
    def longest(self) -> float:
        """Length of an extended leg [m]."""
        return self.shortest + self.stroke
