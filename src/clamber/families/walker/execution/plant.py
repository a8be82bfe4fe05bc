"""What a two-frame walker senses, takes as commands, and how it really is: the protocol of a walk and what is moved, simulated or real.

Arrays over legs have shape (2, 3): the frame in the order of `robots.walker.FRAMES`, then the leg in the order of its directions. The plate
is the upper surface of the Delta-frame; its origin is that frame's. Its pose in the world is x, y, z [m], alpha, beta, gamma [rad] with
R = Rz(alpha) Ry(beta) Rx(gamma), z upwards. The Y-frame slides in the plate's plane; its place is x, y [m], theta [rad] in the Delta-frame.
"""

from dataclasses import dataclass
from typing import Protocol

from ....execution.plant import PausingPlant
from ....types import Floats, Ints


@dataclass(frozen=True, slots=True, eq=False)
class WalkerSensed:
    """What the sensors of a walker say at a tick; the arrays are the plant's own. None tells where in the world it is, nor its heading."""

    time: float
    """Since the start [s]."""
    actuators: Floats
    """Lengths between the attachments, shape (3,) [m]."""
    legs: Floats
    """Lengths from the plate to the soles, shape (2, 3) [m]."""
    forces: Floats
    """Of the ground along each leg, as its load cell feels it, shape (2, 3) [N]; never negative but for noise."""
    inclines: Floats
    """How far the plate's x axis and its y axis rise above the horizontal by two inclinometers, shape (2,) [rad]; with noise and offset."""
    arm: Floats
    """Joint angles, shape (joints,) [rad]; of no joints without an arm."""
    number: int = -1
    """Of the reading: one more for each period since the reset; -1: nobody tells."""


@dataclass(frozen=True, slots=True, eq=False)
class WalkerTruth:
    """How the walker really is, in the world frame: for logs and tests, never for a controller."""

    pose: Floats
    """Of the plate, shape (6,) [m], [rad]."""
    place: Floats
    """Of the Y-frame in the Delta-frame: x, y [m], theta [rad], shape (3,)."""
    feet: Floats
    """Middles of the soles, shape (2, 3, 3) [m]."""
    touching: Ints
    """1 for feet that are on the ground, 0 for others, shape (2, 3)."""
    forces: Floats
    """Of the ground on each foot, shape (2, 3, 3) [N]."""
    centre: Floats
    """Centre of mass of the whole robot, arm and payload included, shape (3,) [m]."""
    tool: Floats
    """The arm's tool point, shape (3,) [m]; NaN without an arm."""
    thrusts: Floats
    """Of the actuators, shape (3,) [N]; positive pushes the frames' attachments apart."""


class WalkerPlant(PausingPlant[WalkerSensed, WalkerTruth | None], Protocol):
    """A walker, driven by aims of length, not by forces: its motors have loops of their own. A real one knows no truth."""

    def actuate(self, actuators: Floats, legs: Floats, arm: Floats) -> None:
        """Set where every motor is to be at the end of the coming period. Within it the plant's aims go there evenly from the last ones.

        A staircase of aims would break the feet's friction. Without a new call the aims stay.

        Args:
            actuators: Lengths, shape (3,) [m].
            legs: Lengths, shape (2, 3) [m].
            arm: Joint angles, shape (joints,) [rad].
        """

    def reset(self, pose: Floats, place: Floats, legs: Floats, arm: Floats) -> None:
        """Put the walker on the ground, at rest, at time 0, and let it settle; the motors' aims are what is given here.

        Args:
            pose: Of the plate, shape (6,) [m], [rad]; z is shifted until the lowest foot touches.
            place: Of the Y-frame in the Delta-frame, shape (3,) [m], [rad].
            legs: Lengths, shape (2, 3) [m].
            arm: Joint angles, shape (joints,) [rad].
        """
