"""The limbed climber: a body and two to eight limbs of two turning joints in a plane, each with an end effector."""

import cmath
import math
from collections.abc import Iterable, Mapping
from dataclasses import field, replace
from typing import Annotated, ClassVar, Final, Literal

import numpy as np
from pydantic import Field, StrictStr

from ....errors import UnknownNameError, describe_choices
from ....files import Document, check_schema
from ....notebook import Pictured
from ....specs import Name, Provenance, build_spec, collect_sources, spec
from ....types import Complexes, Floats
from ....units import (
    GRAVITY,
    Angle,
    ConeAngle,
    Count,
    Length,
    NonNegativeAngle,
    NonNegativeDamping,
    NonNegativeInertia,
    NonNegativeLength,
    NonNegativeMass,
    NonNegativeRatio,
    NonNegativeTorque,
    PositiveAmplifierGain,
    PositiveAngularSpeed,
    PositiveForce,
    PositiveFrequency,
    PositiveLength,
    PositiveRatio,
    PositiveResistance,
    PositiveTime,
    PositiveTorque,
    PositiveTorqueConstant,
)

HOOK_WIDTH: Final = 0.0287
"""Across, from lip to lip [m]."""
HOOK_AHEAD: Final = 0.0161
"""From the seated hold's centre along the grab direction to the end of the lips [m]."""
HOOK_WAY: Final = 0.042
"""Least distance from a hold at which a hook that opens along its link turns towards it: nearer, its flare knocks the hold [m]."""


SCHEMA: Final = "clamber-robot-1"
MAX_LIMBS: Final = 8
"""Limb slots of a stance; more would make every stance larger."""
SHORTEST_LINK: Final = 1e-4
"""Shorter links make inverse kinematics a division by nearly nothing [m]."""


@spec
class Joint:
    """A geared turning joint. Inertia, damping and friction are those at the output, reflected through the gear."""

    number: Annotated[int, Field(strict=True, ge=1, lt=2**31)]
    """The number under which the robot's papers and logs know it."""
    lower: Angle
    """Smallest joint angle [rad]."""
    upper: Angle
    """Largest joint angle [rad]."""
    gear: PositiveRatio = 1.0
    """Motor turns per joint turn [-]."""
    inertia: NonNegativeInertia = 0.0
    """Rotor and gear inertia, reflected [kg m^2]."""
    damping: NonNegativeDamping = 0.0
    """Viscous friction [N m s/rad]."""
    friction: NonNegativeTorque = 0.0
    """Coulomb friction [N m]."""
    torque_limit: PositiveTorque | None = None
    """Largest torque [N m]; None: that of the motor."""
    no_load_speed: PositiveAngularSpeed | None = None
    """Joint speed without load [rad/s]; None: that of the motor."""


@spec
class EndEffector:
    """What a limb holds on with."""

    kind: Literal["hook", "gripper", "foot"]
    """A hook pulls along its grab direction, a foot pushes along it, a gripper takes any force."""
    cone: ConeAngle | None = None
    """Half angle about the grab direction within which the force must lie [rad]; None: the task's."""
    offset: NonNegativeLength = 0.0
    """Distance l3 from the end of the second link to the tip [m]."""
    angle: Angle = 0.0
    """Direction of that offset, and of grabbing, from the second link's direction [rad]."""
    friction: NonNegativeRatio | None = None
    """Friction coefficient against a hold [-]; only simulations use it."""
    strength: PositiveForce | None = None
    """Largest force that it takes; a closed gripper slips off above it [N]; None: any."""
    opening: PositiveLength | None = None
    """Width between a gripper's open jaws [m]; only simulations use it; None: six times a hold's radius."""


@spec
class Limb:
    """One limb: port on the body, two links, two joints, an end effector. Port and angles are in the body frame."""

    name: Name
    """Unique within the robot."""
    port_x: Length
    """Port in the body frame [m]."""
    port_y: Length
    """Port in the body frame [m]."""
    port_angle: Angle
    """Direction of the stretched limb at zero joint angles, in the body frame [rad]."""
    l1: PositiveLength
    """First link [m]."""
    l2: PositiveLength
    """Second link, without the end effector's offset [m]."""
    shoulder: Joint
    elbow: Joint
    end: EndEffector
    link_masses: tuple[NonNegativeMass, NonNegativeMass] = (0.0, 0.0)
    """Masses of both links [kg]; statics counts the whole weight at the body's origin."""

    @property
    def second_link(self) -> complex:
        """l2 + l3 e^(i theta_hook): from the elbow to the tip at zero elbow angle [m]."""
        return complex(self.l2) + self.end.offset * cmath.exp(1j * self.end.angle)

    @property
    def l2_effective(self) -> float:
        """Distance from elbow to tip, L2 [m]."""
        return abs(self.second_link)

    @property
    def hook_beta(self) -> float:
        """Angle beta from the second link's direction to the tip [rad]."""
        return cmath.phase(self.second_link)

    @property
    def length(self) -> float:
        """Distance from port to tip when stretched, l1 + L2 [m]."""
        return self.l1 + self.l2_effective

    def chain(self, joints: Floats) -> Complexes:
        """Port, elbow, end of the second link and tip as x + iy in the body frame, shape (4, ...) [m].

        Args:
            joints: Shoulder and elbow angle, shape (..., 2) [rad].
        """
        first = np.exp(1j * (self.port_angle + joints[..., 0]))
        second = first * np.exp(1j * joints[..., 1])
        port = np.full(first.shape, complex(self.port_x, self.port_y))
        elbow = port + self.l1 * first
        return np.array((port, elbow, elbow + self.l2 * second, elbow + self.second_link * second))


@spec
class Motor:
    """What all joints' motors and amplifiers have in common; a joint may state its own limit and speed."""

    torque_limit: PositiveTorque
    """Largest torque at a joint [N m]."""
    torque_constant: PositiveTorqueConstant
    """Motor torque per current, before the gear [N m/A]."""
    resistance: PositiveResistance
    """Winding resistance [ohm]."""
    no_load_speed: PositiveAngularSpeed
    """Joint speed without load [rad/s]."""
    encoder_counts: Count
    """Counts per motor turn; 0 for a perfect encoder."""
    amplifier_gain: PositiveAmplifierGain | None = None
    """Current per command voltage [A/V]."""
    backlash: NonNegativeAngle = 0.0
    """Whole play at a joint's output [rad]."""
    control_rate: PositiveFrequency | None = None
    """Control cycles per second [Hz]."""
    continuous_torque: PositiveTorque | None = None
    """Torque at a joint that a motor bears for ever [N m]; a plant's server stops a robot whose windings get hotter than it makes them."""
    thermal_time: PositiveTime | None = None
    """Time constant of the windings' temperature [s]; goes with `continuous_torque`."""


@spec
class LimbedRobot(Pictured):
    """A limbed climber in SI units. Body frame: origin at the centre of gravity, x to the right, y up."""

    family: ClassVar[str] = "limbed"

    name: Name
    title: StrictStr
    weight: PositiveForce
    """Whole weight, taken at the body's origin [N]."""
    limbs: tuple[Limb, ...]
    motor: Motor
    opposed: tuple[tuple[Name, Name], ...] = ()
    """Pairs of limbs that count as one on each side of the body wherever their holds are."""
    link_radius: NonNegativeLength = 0.0
    """Radius of the links' capsules [m]."""
    body_margin: NonNegativeLength = 0.0
    """How far the body extends beyond the polygon of its ports [m]."""
    sources: Mapping[str, Provenance] = field(default_factory=dict)
    """Dotted key of the file -> the number as written and its source."""

    def limb_index(self, name: str) -> int:
        """Place of the limb called `name`, from 0.

        Raises:
            UnknownNameError: If there is none.
        """
        if name not in self.limb_names:
            raise UnknownNameError(f"limb of {self.name}", name, self.limb_names)
        return self.limb_names.index(name)

    @property
    def joints(self) -> tuple[Joint, ...]:
        """Limb by limb as the robot's file has them, shoulder before elbow."""
        return tuple(joint for limb in self.limbs for joint in (limb.shoulder, limb.elbow))

    @property
    def joint_names(self) -> tuple[str, ...]:
        """Such as "left elbow", in the order of `joints`."""
        return tuple(f"{limb.name} {joint}" for limb in self.limbs for joint in ("shoulder", "elbow"))

    @property
    def inertias(self) -> Floats:
        """Of rotors and gears, in the order of `joints`, shape (2 limbs,) [kg m^2]."""
        return np.array([joint.inertia for joint in self.joints])

    def torque_limit_of(self, joint: Joint) -> float:
        """Its own, or that of all motors [N m]."""
        return joint.torque_limit or self.motor.torque_limit

    def no_load_speed_of(self, joint: Joint) -> float:
        """Its own, or that of all motors [rad/s]."""
        return joint.no_load_speed or self.motor.no_load_speed

    @property
    def grips(self) -> bool:
        """Whether all limbs end in grippers."""
        return all(limb.end.kind == "gripper" for limb in self.limbs)

    def at_weight(self, weight: float) -> "LimbedRobot":
        """This robot with all masses, forces and torques as many times larger as makes it weigh so much [N]: it moves the same."""
        if weight == self.weight:
            return self
        times = weight / self.weight
        limbs = tuple(
            replace(
                limb,
                shoulder=_times(limb.shoulder, times),
                elbow=_times(limb.elbow, times),
                end=replace(limb.end, strength=None if limb.end.strength is None else times * limb.end.strength),
                link_masses=(times * limb.link_masses[0], times * limb.link_masses[1]),
            )
            for limb in self.limbs
        )
        motor, bears = self.motor, self.motor.continuous_torque
        motor = replace(
            motor,
            torque_limit=times * motor.torque_limit,
            torque_constant=times * motor.torque_constant,
            resistance=times * motor.resistance,
            continuous_torque=None if bears is None else times * bears,
        )
        return replace(self, weight=weight, limbs=limbs, motor=motor)

    def outline(self) -> Floats:
        """Corners of the body without its margin: the convex hull of the ports, anticlockwise, body frame, shape (n, 2) [m]."""
        return _hull((limb.port_x, limb.port_y) for limb in self.limbs)

    @property
    def limb_names(self) -> tuple[str, ...]:
        """Names of the limbs, in order."""
        return tuple(limb.name for limb in self.limbs)

    @property
    def longest_reach(self) -> float:
        """No hold that is farther from the body's origin can be reached [m]."""
        return max(math.hypot(limb.port_x, limb.port_y) + limb.length for limb in self.limbs)


def build_limbed(document: Document) -> LimbedRobot:
    """A limbed robot from its document.

    Raises:
        SpecError: If the document breaks a rule of the format or of geometry.
    """
    check_schema(document, SCHEMA)
    if "sources" in document.data:
        raise document.problem("sources", "unknown key; state a number's source as { value, unit, source }")
    robot = build_spec(LimbedRobot, document, without=("schema", "family", "sources"))
    _check(robot, document)
    return replace(robot, sources=collect_sources(document.data))


def _check(robot: LimbedRobot, document: Document) -> None:
    names = robot.limb_names
    if not 2 <= len(names) <= MAX_LIMBS:
        raise document.problem("limbs", f"a robot has 2 to {MAX_LIMBS} limbs; here are {len(names)}")
    for index, name in enumerate(names):
        if name in names[:index]:
            raise document.problem("limbs", f"names must differ; '{name}' is there twice")
    for limb in robot.limbs:
        for link, length in (("l1", limb.l1), ("l2", limb.l2_effective)):
            if not length >= SHORTEST_LINK:
                raise document.problem(
                    f"limbs.{limb.name}.{link}", f"must leave {SHORTEST_LINK:g} m or more to the next joint or tip"
                )
        for which, joint in (("shoulder", limb.shoulder), ("elbow", limb.elbow)):
            key = f"limbs.{limb.name}.{which}"
            if not joint.lower < joint.upper:
                raise document.problem(f"{key}.lower", "must be less than 'upper'")
            if joint.upper - joint.lower > math.tau * (1 + 1e-12):
                raise document.problem(f"{key}.upper", "must be at most one turn above 'lower'")
    numbers = [joint.number for joint in robot.joints]
    for limb in robot.limbs:
        for which, joint in (("shoulder", limb.shoulder), ("elbow", limb.elbow)):
            if numbers.count(joint.number) > 1:
                raise document.problem(f"limbs.{limb.name}.{which}.number", "each joint needs its own number")
    for pair, (a, b) in enumerate(robot.opposed):
        for name in (a, b):
            if name not in names:
                raise document.problem(f"opposed.{pair}", f"unknown limb; limbs are {describe_choices(name, names)}")
        if a == b:
            raise document.problem(f"opposed.{pair}", "must name two different limbs")
    link_weight = sum(sum(limb.link_masses) for limb in robot.limbs) * GRAVITY
    if not link_weight < robot.weight:
        raise document.problem("weight", f"must be more than the links weigh together ({link_weight:.3g} N)")


def _times(joint: Joint, times: float) -> Joint:
    """A joint with so many times its inertia, friction and torque, as fast as before."""
    limit = joint.torque_limit
    return replace(
        joint,
        inertia=times * joint.inertia,
        damping=times * joint.damping,
        friction=times * joint.friction,
        torque_limit=None if limit is None else times * limit,
    )


def _hull(points: Iterable[tuple[float, float]]) -> Floats:
    """Convex hull of a few points, anticlockwise (Andrew's monotone chain), shape (n, 2)."""
    ordered = sorted(set(points))
    if len(ordered) < 3:
        return np.array(ordered)
    halves: list[tuple[float, float]] = []
    for run in (ordered, ordered[::-1]):
        chain: list[tuple[float, float]] = []
        for point in run:
            while len(chain) >= 2 and _turn(chain[-2], chain[-1], point) <= 0.0:
                chain.pop()
            chain.append(point)
        halves += chain[:-1]
    return np.array(halves)


def _turn(a: tuple[float, float], b: tuple[float, float], c: tuple[float, float]) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def body_mass(robot: LimbedRobot) -> float:
    """Mass of the body without its limbs [kg]."""
    return robot.weight / GRAVITY - sum(sum(limb.link_masses) for limb in robot.limbs)


def body_inertia(robot: LimbedRobot) -> float:
    """Inertia of the body without its limbs about its origin [kg m^2]: an even plate over the triangle, or polygon, of its ports."""
    ports = sorted(((limb.port_x, limb.port_y) for limb in robot.limbs), key=lambda p: math.atan2(p[1], p[0]))
    area = second = 0.0
    for (x0, y0), (x1, y1) in zip(ports, ports[1:] + ports[:1], strict=True):
        cross = x0 * y1 - x1 * y0
        area += cross / 2
        second += cross * (x0 * x0 + x0 * x1 + x1 * x1 + y0 * y0 + y0 * y1 + y1 * y1) / 12
    per_mass = second / area if area > 0.0 else max(x * x + y * y for x, y in ports) / 2
    return body_mass(robot) * per_mass
