"""The two-frame walker, as a robot file states it: two frames of three legs, joined in a plane by three linear actuators, an arm."""

from collections.abc import Mapping
from dataclasses import field, replace
from typing import Annotated, ClassVar, Final

from pydantic import StrictStr

from ....files import Document, check_schema
from ....notebook import Pictured
from ....specs import Name, Provenance, build_spec, collect_sources, spec
from ....types import Floats
from ....units import (
    Angle,
    Length,
    NonNegativeLength,
    NonNegativeMass,
    PositiveAngularSpeed,
    PositiveForce,
    PositiveLength,
    PositiveMass,
    PositiveSpeed,
    Quantity,
)
from .mechanism import Mechanism, check_mechanism
from .plane_poses import placed


@spec
class Arm:
    """An arm of one turning and n pitching joints (Hoshino and others, equation 8).

    Joint 0 turns about the plate's normal. Joints 1 to n pitch in the arm's plane, upwards positive; with all at zero the arm points
    straight out. The tool point is the end of the last link.
    """

    links: tuple[PositiveLength, ...]
    """Lengths of the pitching links, L1 to Ln [m], shape (n,)."""
    masses: tuple[NonNegativeMass, ...]
    """Their masses, each at its middle [kg], shape (n,)."""
    out: Length
    """From the axis of joint 0 to that of joint 1, outwards, X1 [m]."""
    up: Length
    """From the plate to the axis of joint 1, Z1 [m]."""
    lowest: tuple[Angle, ...]
    """Lower ends of the joints' ranges [rad], shape (n + 1,)."""
    highest: tuple[Angle, ...]
    """Upper ends [rad], shape (n + 1,)."""
    fastest: tuple[PositiveAngularSpeed, ...]
    """Largest joint speeds [rad/s], shape (n + 1,)."""
    rest: tuple[Angle, ...]
    """Joint angles while the robot walks, unless a task says otherwise [rad], shape (n + 1,)."""

    @property
    def n_joints(self) -> int:
        """How many joints it has."""
        return len(self.links) + 1


def check_arm(arm: Arm, document: Document) -> None:
    """Raises `SpecError` if the lists of an arm do not belong together."""
    if not arm.links:
        raise document.problem("arm.links", "must name one link or more")
    if len(arm.masses) != len(arm.links):
        raise document.problem("arm.masses", f"must have {len(arm.links)} entries, one for each link")
    for key in ("lowest", "highest", "fastest", "rest"):
        if len(getattr(arm, key)) != arm.n_joints:
            raise document.problem(
                f"arm.{key}",
                f"must have {arm.n_joints} entries, one for each joint: the turning one and one for each link",
            )
    for joint, (low, high) in enumerate(zip(arm.lowest, arm.highest, strict=True)):
        if not low < high:
            raise document.problem(f"arm.lowest.{joint}", "must be less than its entry of highest")
        if not low <= arm.rest[joint] <= high:
            raise document.problem(f"arm.rest.{joint}", f"must be in the joint's range, {low:.6g} to {high:.6g} rad")


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


@spec
class Mass:
    """The robot's mass without its arm: a share at each frame's origin, all at one height above the plate."""

    frames: PositiveMass
    """Both frames and all legs [kg]."""
    share_delta: Annotated[float, Quantity("ratio", at_least=0.0, at_most=1.0)]
    """Share of it on the Delta-frame; the rest is on the Y-frame, each at its origin [-]."""
    height: Length
    """Centre of mass above the plate [m]."""


SCHEMA: Final = "clamber-robot-1"
FRAMES: Final = ("delta", "y")
"""Names of the frames, in the order of every array: the Delta-frame carries the body."""
FRAME_TITLES: Final = ("Delta-frame", "Y-frame")
"""What people read."""
LEG_NAMES: Final = tuple(f"{frame} leg {i + 1}" for frame in FRAMES for i in range(3))
"""Of the six legs, frame by frame."""


@spec
class WalkerRobot(Pictured):
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

    @property
    def own_arm(self) -> Arm:
        """Its arm, where only robots with one come."""
        assert self.arm is not None, "only robots with an arm move it"
        return self.arm

    def attachments(self) -> Floats:
        """Attachments of both frames, each in its own frame [m], shape (2, 3, 2)."""
        return self.mechanism.attachments()

    def feet(self) -> Floats:
        """Feet of both frames, each in its own frame [m], shape (2, 3, 2); anticlockwise."""
        return self.mechanism.spread(self.legs.radius_delta, self.legs.radius_y)

    def feet_in_plate(self, place: Floats) -> Floats:
        """All feet in the Delta-frame with the Y-frame at a place in it: x, y [m], theta [rad], shape (2, 3, 2) [m]."""
        feet = self.feet()
        feet[1] = placed(feet[1], place)
        return feet


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
