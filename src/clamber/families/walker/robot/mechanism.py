"""The planar 3-RPR parallel mechanism that joins the two frames, as a robot file states it."""

import math
from typing import Annotated, Final

import numpy as np

from ....files import Document
from ....specs import spec
from ....types import Floats
from ....units import Angle, Length, PositiveForce, PositiveLength, PositiveSpeed, Quantity

THIRD: Final = math.tau / 3.0
Place = tuple[Length, Length]


@spec
class Mechanism:
    """The planar 3-RPR parallel mechanism: actuator i joins attachments i of the Delta-frame and the Y-frame.

    The attachments are on a circle on each frame, a third of a turn apart (`radius_delta` and `radius_y`), or anywhere
    (`points_delta` and `points_y`).
    """

    radius_delta: PositiveLength | None = None
    """Circle of the Delta-frame's attachments, about its origin [m]; None where points are given."""
    radius_y: PositiveLength | None = None
    """Circle of the Y-frame's attachments, about its origin [m]; None where points are given."""
    points_delta: tuple[Place, Place, Place] | None = None
    """The Delta-frame's attachments in its own frame [m]; None where they are on a circle."""
    points_y: tuple[Place, Place, Place] | None = None
    """The Y-frame's attachments in its own frame [m]; None where they are on a circle."""
    first: Angle
    """Direction of the Delta-frame's first leg, and of its first attachment on a circle, in its own frame; the others follow by
    thirds of a turn [rad]."""
    offset: Angle
    """The same of the Y-frame in its own frame, less `first` [rad]."""
    shortest: PositiveLength
    """Length of an actuator that is drawn in [m]."""
    stroke: PositiveLength
    """By how much an actuator extends [m]."""
    speed: PositiveSpeed
    """Fastest that an actuator extends or draws in [m/s]."""
    guard: Annotated[float, Quantity("ratio", above=0.0, at_most=1.0)]
    """The mechanism stays nearer to its centre than this share of the way to where it is singular [-]."""
    force: PositiveForce | None = None
    """Most that an actuator pushes or pulls with [N]; None: no limit is known."""

    @property
    def longest(self) -> float:
        """Length of an extended actuator [m]."""
        return self.shortest + self.stroke

    def attachments(self) -> Floats:
        """Attachments of both frames, each in its own frame [m], shape (2, 3, 2)."""
        if self.points_delta is not None and self.points_y is not None:
            return np.array([self.points_delta, self.points_y])
        assert self.radius_delta is not None and self.radius_y is not None
        return self.spread(self.radius_delta, self.radius_y)

    def spread(self, radius_delta: float, radius_y: float) -> Floats:
        """Points in the frames' three directions, each in its own frame [m], shape (2, 3, 2); anticlockwise.

        Args:
            radius_delta, radius_y: Circles of the points [m].
        """
        starts = (self.first, self.first + self.offset)
        angles = np.array([[start + THIRD * i for i in range(3)] for start in starts])
        radii = np.array([[radius_delta], [radius_y]])
        return np.stack([radii * np.cos(angles), radii * np.sin(angles)], axis=-1)

    def singular_distance(self, twist: float) -> float:
        """Distance rho of the frames' origins at which a mechanism with attachments on circles is singular [m].

        Args:
            twist: Angle of the Y-frame in the Delta-frame [rad].
        """
        a, b = self.radius_delta, self.radius_y
        assert a is not None and b is not None, "for attachments on circles; TwoFrames knows the rest"
        return math.sqrt(max(0.0, a * a + b * b - 2.0 * a * b * math.cos(self.offset + twist)))


CIRCLES: Final = ("radius_delta", "radius_y")
POINTS: Final = ("points_delta", "points_y")


def check_mechanism(mechanism: Mechanism, document: Document) -> None:
    """Raises `SpecError` unless the attachments of both frames are stated, all on circles or all as points."""
    by_points = any(getattr(mechanism, key) is not None for key in POINTS)
    wanted, others = (POINTS, CIRCLES) if by_points else (CIRCLES, POINTS)
    for key in others:
        if getattr(mechanism, key) is not None:
            allowed = (
                f"attachments are given by {' and '.join(CIRCLES)} or by {' and '.join(POINTS)}; take one pair out"
            )
            raise document.problem(f"mechanism.{key}", allowed)
    for key in wanted:
        if getattr(mechanism, key) is None:
            raise document.problem(f"mechanism.{key}", f"must be given, for attachments take {' and '.join(wanted)}")
    for key, points in zip(wanted, mechanism.attachments(), strict=True):
        if np.ptp(points, axis=0).max() <= 0.0:
            raise document.problem(f"mechanism.{key}", "must be three points that are not all one")
