"""The two-frame walker: a Delta-frame and a Y-frame of three legs each, joined in a plane by three linear actuators."""

import math
from collections.abc import Mapping
from dataclasses import field, replace
from typing import Annotated, Final

import numpy as np
from pydantic import StrictStr

from ..files import Document, check_schema
from ..specs import Name, Provenance, build_spec, collect_sources, spec
from ..types import Floats
from ..units import Angle, NonNegativeLength, PositiveLength, Quantity

SCHEMA: Final = "clamber-robot-1"
FRAMES: Final = ("delta", "y")
"""Names of the frames, in the order of every array: the Delta-frame carries the body."""
THIRD: Final = math.tau / 3.0


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


@spec
class Legs:
    """Three legs on each frame, in the directions of its attachments."""

    radius_delta: PositiveLength
    """Circle of the Delta-frame's feet [m]."""
    radius_y: PositiveLength
    """Circle of the Y-frame's feet [m]."""
    pad_radius: NonNegativeLength
    """Radius of a foot [m]."""


@spec
class WalkerRobot:
    """A two-frame walker in SI units. Both frames have their origin in the middle of their attachments."""

    name: Name
    title: StrictStr
    mechanism: Mechanism
    legs: Legs
    share_delta: Annotated[float, Quantity("ratio", at_least=0.0, at_most=1.0)]
    """Share of the whole mass on the Delta-frame; the rest is on the Y-frame, each at its origin [-]."""
    sources: Mapping[str, Provenance] = field(default_factory=dict)
    """Dotted key of the file -> the number as written and its source."""

    def attachments(self) -> Floats:
        """Attachments of both frames, each in its own frame [m], shape (2, 3, 2)."""
        return self._circles(self.mechanism.radius_delta, self.mechanism.radius_y)

    def feet(self) -> Floats:
        """Feet of both frames, each in its own frame [m], shape (2, 3, 2); anticlockwise."""
        return self._circles(self.legs.radius_delta, self.legs.radius_y)

    def _circles(self, radius_delta: float, radius_y: float) -> Floats:
        starts = (self.mechanism.first, self.mechanism.first + self.mechanism.offset)
        angles = np.array([[start + THIRD * i for i in range(3)] for start in starts])
        radii = np.array([[radius_delta], [radius_y]])
        return np.stack([radii * np.cos(angles), radii * np.sin(angles)], axis=-1)


def build_walker(document: Document) -> WalkerRobot:
    """A walker from its document.

    Raises:
        SpecError: If the document breaks a rule of the format.
    """
    check_schema(document, SCHEMA)
    if "sources" in document.data:
        raise document.problem("sources", "unknown key; state a number's source as { value, unit, source }")
    robot = build_spec(WalkerRobot, document, without=("schema", "family", "sources"))
    return replace(robot, sources=collect_sources(document.data))
