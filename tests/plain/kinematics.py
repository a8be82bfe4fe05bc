"""Where limbs are: frames, the two inverse kinematic branches and joint margins (docs/model.md, sections 1 and 6)."""

import cmath
import math
from dataclasses import dataclass
from typing import Any

Point = tuple[float, float]

EPS = 1e-9
"""A margin below -EPS, in its own unit, is violated; ties closer than EPS are ties."""


@dataclass(frozen=True)
class Pose:
    """The body in the world: origin [m] and angle [rad]."""

    x: float
    y: float
    angle: float


@dataclass(frozen=True)
class Option:
    """One inverse kinematic branch of one limb at one place of its tip."""

    branch: int
    t1: float
    t2: float
    elbow: Point
    """World [m]."""
    tip: Point
    """World [m]; not the asked place when that is out of reach."""
    joint_margin: float
    """The smaller of the two joints' [rad]."""
    grab_angle: float
    """Direction of the end effector, world [rad]."""


def wrap(angle: float) -> float:
    """The same angle in (-pi, pi]."""
    turned = math.remainder(angle, 2.0 * math.pi)
    return math.pi if turned <= -math.pi else turned


def rotate(v: Point, angle: float) -> Point:
    z = complex(*v) * cmath.exp(1j * angle)
    return z.real, z.imag


def to_world(pose: Pose, p_body: Point) -> Point:
    x, y = rotate(p_body, pose.angle)
    return pose.x + x, pose.y + y


def to_body(pose: Pose, p_world: Point) -> Point:
    return rotate((p_world[0] - pose.x, p_world[1] - pose.y), -pose.angle)


def port_in_world(limb: Any, pose: Pose) -> Point:
    return to_world(pose, (limb.port_x, limb.port_y))


def forearm(limb: Any) -> tuple[float, float]:
    """Second link and end effector as one vector: length L2 [m] and angle beta [rad]."""
    z = limb.l2 + limb.end.offset * cmath.exp(1j * limb.end.angle)
    return abs(z), cmath.phase(z)


def limb_length(limb: Any) -> float:
    return float(limb.l1 + forearm(limb)[0])


def forward(limb: Any, pose: Pose, t1: float, t2: float) -> tuple[Point, Point]:
    """Elbow and tip in the world [m], link by link (the end effector is not merged into the forearm here)."""
    port = complex(*port_in_world(limb, pose))
    phi = pose.angle + limb.port_angle
    elbow = port + limb.l1 * cmath.exp(1j * (phi + t1))
    wrist = elbow + limb.l2 * cmath.exp(1j * (phi + t1 + t2))
    tip = wrist + limb.end.offset * cmath.exp(1j * (phi + t1 + t2 + limb.end.angle))
    return (elbow.real, elbow.imag), (tip.real, tip.imag)


def one_joint_margin(joint: Any, angle: float) -> float:
    centre, half = (joint.lower + joint.upper) / 2.0, (joint.upper - joint.lower) / 2.0
    return float(half - abs(wrap(angle - centre)))


def option(limb: Any, pose: Pose, target: Point, branch: int) -> Option:
    """The limb with its tip at `target` (world [m]), or stretched towards it when that is out of reach."""
    port = port_in_world(limb, pose)
    phi = pose.angle + limb.port_angle
    vx, vy = rotate((target[0] - port[0], target[1] - port[1]), -phi)
    L2, beta = forearm(limb)
    c = (vx * vx + vy * vy - limb.l1**2 - L2**2) / (2.0 * limb.l1 * L2)
    c = max(-1.0, min(1.0, c))
    side = 1.0 if branch == 0 else -1.0
    s = math.sqrt(1.0 - c * c)
    t2 = side * math.acos(c) - beta
    t1 = math.atan2(vy, vx) - side * math.atan2(L2 * s, limb.l1 + L2 * c)
    elbow, tip = forward(limb, pose, t1, t2)
    margin = min(one_joint_margin(limb.shoulder, t1), one_joint_margin(limb.elbow, t2))
    return Option(branch, t1, t2, elbow, tip, margin, phi + t1 + t2 + limb.end.angle)


def usable(both: list[Option]) -> list[Option]:
    """The branches that may be taken: those within limits, else both."""
    within = [o for o in both if o.joint_margin >= -EPS]
    return within or both
