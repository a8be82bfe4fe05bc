"""The two-frame walker: a Delta-frame and a Y-frame of three legs each, joined in a plane by three linear actuators."""

import math
from collections.abc import Mapping
from dataclasses import field, replace
from typing import Final

import numpy as np
from pydantic import StrictStr

from ...files import Document, check_schema
from ...specs import Name, Provenance, build_spec, collect_sources, spec
from ...types import Floats
from .arm import Arm, check_arm
from .legs import Legs
from .mass import Mass
from .mechanism import Mechanism

SCHEMA: Final = "clamber-robot-1"
FRAMES: Final = ("delta", "y")
"""Names of the frames, in the order of every array: the Delta-frame carries the body."""
THIRD: Final = math.tau / 3.0


@spec
class WalkerRobot:
    """A two-frame walker in SI units. Both frames have their origin in the middle of their attachments."""

    name: Name
    title: StrictStr
    mechanism: Mechanism
    legs: Legs
    mass: Mass
    arm: Arm | None = None
    """None if it has none."""
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
    if not robot.legs.shortest < robot.legs.nominal < robot.legs.longest:
        raise document.problem("legs.nominal", "must be between legs.shortest and legs.shortest + legs.stroke")
    if robot.arm is not None:
        check_arm(robot.arm, document)
    return replace(robot, sources=collect_sources(document.data))
