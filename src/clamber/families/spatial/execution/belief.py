"""Where a robot in space believes its body to be, and how it believes to move: what a controller knows of itself."""

from typing import Protocol

from ....control.whole_body.tree import State
from ....types import Floats, Ints
from ..world.world import World
from .plant import Pose, SpatialPlant, SpatialSensed


class Belief(Protocol):
    """What writes the believed state, once a tick. An estimator from encoders, IMU and contacts is one; it never sees the truth."""

    places: Floats
    """Where holds are, as believed [m], shape (holds, 3)."""

    def begin(self, pose: Pose, sensed: SpatialSensed) -> None:
        """Begin at rest at a pose that the robot was told, with the first reading of its sensors."""

    def update(self, sensed: SpatialSensed, holds: Ints, state: State) -> None:
        """Bring a state up to date.

        Args:
            sensed: What the sensors say.
            holds: Index of the hold that each limb holds on to or stands on, as believed, -1: none; shape (limbs,).
            state: Written.
        """


class TrueBase:
    """Stands in for an estimator: the body's pose and velocity are the true ones, joints are those that the encoders tell.

    Args:
        plant: A simulated one.
        world: As believed.
    """

    def __init__(self, plant: SpatialPlant, world: World) -> None:
        self._plant, self.places = plant, world.places

    def begin(self, pose: Pose, sensed: SpatialSensed) -> None:
        """See `Belief`: nothing to do."""

    def update(self, sensed: SpatialSensed, holds: Ints, state: State) -> None:
        """See `Belief`."""
        true = self._plant.truth()
        assert true is not None, "a simulated plant tells the truth"
        state.rotation[:], state.position[:] = true.pose.rotation, true.pose.position
        state.speed[:3] = true.velocity[:3]
        state.speed[3:6] = true.pose.rotation.T @ true.velocity[3:]
        state.speed[6:], state.joints[:] = sensed.joints[1], sensed.joints[0]
