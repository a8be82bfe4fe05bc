"""A walk as its file states it: a robot on a ground, how it starts, and its way as pieces that are straight or turn."""

import math
from collections.abc import Mapping
from dataclasses import field, replace
from typing import Annotated, ClassVar, Final, Literal

import numpy as np
from pydantic import StrictBool, StrictStr

from ....files import Document, check_schema
from ....notebook import OneLine
from ....specs import Name, build_spec, field_names, spec
from ....tasks.parts import parts_of
from ....types import Floats, Json
from ....units import Angle, Length, NonNegativeMass, Point, PositiveLength, Quantity
from ..robot import LEG_NAMES, TwoFrames, WalkerRobot, build_walker
from ..robot.plane_poses import placed
from ..robot.weight import weight_of
from ..world.ground import Ground, build_ground
from .piece import Piece, check_way

HEAVIEST: Final = 1e4
"""Loads are looked for up to this [kg]."""


SCHEMA: Final = "clamber-walk-1"


@spec
class WalkStart:
    """Where the robot is put down on six feet."""

    x: Length = 0.0
    """Origin of the Delta-frame, world frame [m]."""
    y: Length = 0.0
    """[m]."""
    heading: Angle = 0.0
    """Of the Delta-frame, world frame [rad]."""
    offset: Point = (0.0, 0.0)
    """Origin of the Y-frame, in the Delta-frame [m]."""
    twist: Angle = 0.0
    """Angle of the Y-frame in the Delta-frame [rad]; it keeps this at the same place of the way."""
    plate: Literal["level", "ground"] = "level"
    """Whether the plate is level and the legs make up for the ground, or the legs are of one length and the plate lies as the ground."""


@spec
class ToolStop:
    """A place of the tool, seen from where the way begins."""

    x: Length
    """Ahead of the Delta-frame's origin, along its heading [m]."""
    y: Length
    """To its left [m]."""
    z: Length
    """Above the middle of its feet [m]."""


@spec
class Hold(ToolStop):
    """A point that the tool is held at while the robot walks past it, seen from where the way begins; or a line that it follows."""

    within: PositiveLength = 0.5
    """It is held from so far before the place of the way that is nearest to it until so far behind, where the arm can reach it [m]."""
    served: Literal["arm", "height"] = "arm"
    """By what: the arm alone, or also the height of the plate, in the phases of the gait that leave it free."""
    through: tuple[ToolStop, ...] = ()
    """Places that the tool goes on to, straight from one to the next, evenly with the plate's way; the way's place nearest to the middle
    of that line counts. Without them it stays at the point."""

    def points(self) -> Floats:
        """The point and those that the tool goes on to, shape (n, 3) [m]."""
        return np.array([(stop.x, stop.y, stop.z) for stop in (self, *self.through)])


@spec
class WalkSpec:
    """What a walk's file says beside its robot and its ground."""

    name: Name
    title: StrictStr = ""
    source: StrictStr = ""
    """Where the numbers come from."""
    start: WalkStart = WalkStart()
    way: tuple[Piece, ...]
    """In order; one or more."""
    level: StrictBool = True
    """Whether the plate is kept level; if not, it keeps the tilt that it has at the start."""
    probe: Annotated[float, Quantity("length", at_least=0.0, at_most=0.005)] = 0.0
    """By how much feet are pushed to every side where they have come down, before they are relied upon, on ground that may be rough [m];
    0: they are not."""
    arm: tuple[Angle, ...] | None = None
    """Joint angles of the arm [rad]; those of the robot's file unless given."""
    payload: NonNegativeMass = 0.0
    """Mass at the arm's tool point, which the robot knows of [kg]."""
    hold: Hold | None = None
    """A point that the tool is held at on the way; none unless given."""


@spec
class Walk(OneLine, WalkSpec):
    """A walk with everything resolved, in SI units."""

    kind: ClassVar[str] = "walk"

    robot: WalkerRobot
    ground: Ground
    arm: tuple[Angle, ...]
    """Joint angles [rad]; none without an arm."""
    document: Json = field(default_factory=dict)
    """Robot, ground and walk as read, with overrides applied: a worker rebuilds the walk from it."""

    def with_seed(self, seed: int) -> "Walk":
        """The same walk with other tiles where the ground is rough: `seed` is added to the seeds that its file states."""
        rough = tuple(replace(patch, seed=patch.seed + seed) for patch in self.ground.rough)
        return replace(self, ground=replace(self.ground, rough=rough))

    def start_place(self) -> Floats:
        """Pose of the Y-frame in the Delta-frame: x, y [m], theta [rad], shape (3,)."""
        return np.array((*self.start.offset, self.start.twist))

    def start_pose(self) -> Floats:
        """Pose of the plate: x, y [m], z = 0, alpha, beta, gamma [rad], shape (6,)."""
        start = self.start
        up = (0.0, 0.0, 1.0) if start.plate == "level" else self.ground.axes()[:, 2]
        # Rz(-alpha) brings the normal to (sin beta cos gamma, -sin gamma, cos beta cos gamma)
        c, s = math.cos(start.heading), math.sin(start.heading)
        nx, ny, nz = c * up[0] + s * up[1], c * up[1] - s * up[0], up[2]
        return np.array((start.x, start.y, 0.0, start.heading, math.atan2(nx, nz), -math.asin(ny)))

    def start_legs(self) -> Floats:
        """Lengths of the legs with which all feet reach the ground, about nominal, shape (2, 3) [m]; inf where there is none."""
        legs, start = self.robot.legs, self.start
        if start.plate == "ground":
            return np.full((2, 3), legs.nominal)
        feet = self.robot.feet_in_plate(self.start_place())
        heights = self.ground.heights(placed(feet, (start.x, start.y, start.heading)))
        if not np.isfinite(heights).all():
            return np.full((2, 3), math.inf)
        lengths: Floats = legs.nominal + 0.5 * (heights.max() + heights.min()) - heights
        return lengths


def build_walk(document: Document) -> Walk:
    """A walk from its merged document: a walk's file with its robot and ground in place of their names.

    Raises:
        SpecError: If any of the three breaks a rule, or they do not fit each other.
    """
    check_schema(document, SCHEMA)
    parts = parts_of(document, "ground")
    robot, ground = build_walker(parts["robot"]), build_ground(parts["ground"])
    stated = build_spec(WalkSpec, document, without=("schema", *parts, "labels"))
    check_way(stated.way, document)
    joints = 0 if robot.arm is None else robot.arm.n_joints
    if stated.payload > 0.0 and robot.arm is None:
        raise document.problem("payload", "needs an arm to carry it, and the robot has none")
    if stated.hold is not None and robot.arm is None:
        raise document.problem("hold", "needs an arm, and the robot has none")
    if stated.way[0].ditch is not None:
        if stated.hold is not None:
            raise document.problem("hold", "is for ways without a ditch")
        if stated.start.offset != (0.0, 0.0):
            raise document.problem(
                "start.offset", "must be 0 before a ditch: the crossing begins with the frames on each other"
            )
    if stated.arm is not None and len(stated.arm) != joints:
        raise document.problem("arm", f"must have {joints} entries, one for each joint of the robot's arm")
    rest = () if robot.arm is None else robot.arm.rest
    told = {name: getattr(stated, name) for name in field_names(WalkSpec)}
    told["arm"] = rest if stated.arm is None else stated.arm
    walk = Walk(**told, robot=robot, ground=ground, document=document.data)
    _check_start(walk, document)
    return walk


def _check_start(walk: Walk, document: Document) -> None:
    legs, lengths = walk.robot.legs, walk.start_legs()
    if np.isinf(lengths).any():
        raise document.problem("start", "puts a foot where there is no ground")
    low, high = float(lengths.min()), float(lengths.max())
    if low < legs.shortest or high > legs.longest:
        allowed = (
            f"asks for legs of {1e3 * low:.0f} to {1e3 * high:.0f} mm; "
            f"they can be {1e3 * legs.shortest:.0f} to {1e3 * legs.longest:.0f} mm: the ground under {LEG_NAMES[int(lengths.argmax())]} is "
            f"{1e3 * (high - low):.0f} mm lower than under {LEG_NAMES[int(lengths.argmin())]}"
        )
        raise document.problem("start", allowed)


def walk_keys() -> Mapping[str, tuple[str, ...]]:
    """Keys that an override may start with: of the walk, and of the robot without "robot."."""
    robot = tuple(name for name in field_names(WalkerRobot) if name != "sources")
    return {"walk": (*field_names(WalkSpec), "robot", "ground"), "robot": robot}


def check_mechanism(walk: Walk, document: Document) -> None:
    """Makes sure that the actuators reach the place of the Y-frame, short of singular postures.

    Raises:
        SpecError: If not; it names the lengths, or how near it is.
    """
    frames, place = TwoFrames.of(walk.robot.mechanism), walk.start_place()
    lengths = 1e3 * frames.lengths(place)
    if frames.room(place) < 0.0:
        raise document.problem(
            "start",
            f"asks for actuators of {lengths.min():.0f} to {lengths.max():.0f} mm; they can be {1e3 * frames.shortest:.0f} to "
            f"{1e3 * frames.longest:.0f} mm: bring offset and twist nearer to 0",
        )
    if frames.nearness(place) > frames.guard:
        raise document.problem(
            "start",
            f"is {frames.nearness(place):.3g} of the way to a singular posture of the mechanism, where it holds no push; "
            f"{frames.guard:g} is allowed: bring offset and twist nearer to 0",
        )


def why_it_tips(walk: Walk) -> str:
    """Where what a level robot that has tipped carries puts its centre of mass, and what would do on rigid feet; empty without a load."""
    if walk.start.plate != "level" or walk.payload <= 0.0:
        return ""
    margin = start_margin(walk, walk.payload)
    low, high = 0.0, HEAVIEST
    while high - low > 0.01:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if start_margin(walk, middle) > 0.0 else (low, middle)
    side = "inside" if margin > 0.0 else "outside"
    return (
        f"{walk.payload:g} kg put the centre of mass {1e3 * abs(margin):.0f} mm {side} the six feet that it starts on; with the arm like "
        f"this rigid feet would bear up to {math.floor(10.0 * low) / 10.0:.1f} kg, and those that give way less"
    )


def start_margin(walk: Walk, payload: float) -> float:
    """How far the centre of mass of the level robot lies inside its six feet at the start [m]; negative outside.

    Args:
        walk: With the start.
        payload: At the tool point [kg].
    """
    from scipy.spatial import ConvexHull

    place = walk.start_place()
    feet = walk.robot.feet_in_plate(place)
    centre = weight_of(walk.robot, walk.arm or None, payload).centre(np.stack([np.zeros(3), place]))
    equations = ConvexHull(feet.reshape(-1, 2)).equations
    return float((-equations[:, :2] @ centre - equations[:, 2]).min())
