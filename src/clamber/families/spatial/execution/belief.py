"""Where a robot in space believes its body to be, and how it believes to move: what a controller knows of itself."""

from typing import Protocol

from ....control.whole_body.tree import State
from ....types import Floats, Ints
from .plant import Pose, SpatialSensed


class Belief(Protocol):
    """What writes the believed state, once a tick. An estimator from encoders, IMU and contacts is one; it never sees the truth."""

    places: Floats
    """Where holds are, as believed [m], shape (holds, 3)."""

    def begin(self, pose: Pose, sensed: SpatialSensed) -> None:
        """Begin at rest at a pose that the robot was told, with the first reading of its sensors."""

    def update(self, sensed: SpatialSensed, holds: Ints, state: State) -> Pose | None:
        """Bring a state up to date.

        Args:
            sensed: What the sensors say.
            holds: Index of the hold that each limb holds on to or stands on, as believed, -1: none; shape (limbs,). The same array at each
                tick, as `state` is: to look at others costs time.
            state: Written.

        Returns:
            The turn and then the shift, world frame, by which a hold that was taken has corrected where the body is believed to be; None:
            none was taken or left.
        """
