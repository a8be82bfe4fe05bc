"""The two-frame walker: a Delta-frame and a Y-frame of three legs each, joined in a plane by three linear actuators."""

from collections.abc import Mapping
from dataclasses import field, replace
from typing import ClassVar, Final

from pydantic import StrictStr

from ....files import Document, check_schema
from ....specs import Name, Provenance, build_spec, collect_sources, spec
from ....types import Floats
from .arm import Arm, check_arm
from .legs import Legs
from .mass import Mass
from .mechanism import Mechanism, check_mechanism

SCHEMA: Final = "clamber-robot-1"
FRAMES: Final = ("delta", "y")
"""Names of the frames, in the order of every array: the Delta-frame carries the body."""


@spec
class WalkerRobot:
    """A two-frame walker in SI units. Both frames have their origin in the middle of their feet."""

    family: ClassVar[str] = "walker"

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
        return self.mechanism.attachments()

    def feet(self) -> Floats:
        """Feet of both frames, each in its own frame [m], shape (2, 3, 2); anticlockwise."""
        return self.mechanism.spread(self.legs.radius_delta, self.legs.radius_y)


def build_walker(document: Document) -> WalkerRobot:
    """A walker from its document.

    Raises:
        SpecError: If the document breaks a rule of the format.
    """
    check_schema(document, SCHEMA)
    if "sources" in document.data:
        raise document.problem("sources", "unknown key; state a number's source as { value, unit, source }")
    robot = build_spec(WalkerRobot, document, without=("schema", "family", "sources"))
    check_mechanism(robot.mechanism, document)
    if not robot.legs.shortest < robot.legs.nominal < robot.legs.longest:
        raise document.problem("legs.nominal", "must be between legs.shortest and legs.shortest + legs.stroke")
    if robot.arm is not None:
        check_arm(robot.arm, document)
    return replace(robot, sources=collect_sources(document.data))
