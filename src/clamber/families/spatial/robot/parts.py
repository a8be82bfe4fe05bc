"""Parts of a robot that move as one, the base and each limb's links, with what dynamics need beside statics: inertias and shapes."""

from dataclasses import dataclass

import numpy as np

from ....types import Floats
from .assembly import owners, placed_parts
from .chains import Bools
from .robot import SpatialRobot
from .tree import Frame


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Part:
    """A rigid part in its own frame: that of the base, or a link's, whose z is the axis of the joint that moves it."""

    mass: float
    """[kg]."""
    centre: Floats
    """Of mass [m], shape (3,)."""
    inertia: Floats
    """About that centre, in the axes of the frame [kg m^2], shape (3, 3)."""
    shapes: tuple[tuple[Floats, float], ...]
    """Points [m], shape (n, 3), and the radius by which their hull is blown up [m]."""


@dataclass(frozen=True, slots=True)
class Parts:
    """All of a robot, with the links that are fixed to each."""

    base: Part
    """With trunk and payload."""
    links: tuple[tuple[Part, ...], ...]
    """Of each limb, from the base to the tip."""


def parts_of(robot: SpatialRobot) -> Parts:
    """The parts of a robot, as its model has them."""
    tree = robot.tree
    choice = robot.choice
    placed = placed_parts(tree, choice)
    owner = owners(tree, choice.limbs)

    def part(own: tuple[int, int] | None, frame: Frame) -> Part:
        links = [link for link in tree.links if owner[link.name] == own]
        masses, centres, spins = [], [], []
        for link in links:
            at = placed.posture.frame(link)
            turn = frame.axes.T @ at.axes
            masses.append(link.mass)
            centres.append(frame.within(at.at(link.centre)))
            spins.append(turn @ np.array(link.inertia) @ turn.T)
        if own is None and choice.payload > 0.0:
            masses.append(choice.payload)
            centres.append(np.array(choice.payload_at))
            spins.append(np.zeros((3, 3)))
        shapes = placed.posture.shapes(frozenset(link.name for link in links))
        return _joined(
            np.array(masses),
            np.array(centres),
            spins,
            tuple(((points - frame.place) @ frame.axes, shape.radius) for points, shape in shapes),
        )

    return Parts(
        part(None, placed.base),
        tuple(
            tuple(part((index, k), placed.frames[index, k]) for k in range(len(limb.joints)))
            for index, limb in enumerate(choice.limbs)
        ),
    )


def _joined(masses: Floats, centres: Floats, spins: list[Floats], shapes: tuple[tuple[Floats, float], ...]) -> Part:
    """One part of several links, by the theorem of parallel axes."""
    total = float(masses.sum())
    centre = masses @ centres / total if total > 0.0 else np.zeros(3)
    inertia = np.zeros((3, 3))
    for mass, at, spin in zip(masses, centres, spins, strict=True):
        off = at - centre
        inertia += spin + mass * (float(off @ off) * np.eye(3) - np.outer(off, off))
    return Part(mass=total, centre=centre, inertia=inertia, shapes=shapes)


@dataclass(frozen=True, slots=True, eq=False)
class Motors:
    """Motors and gears of all joints, limb by limb from the base to the tip, arrays of shape (n,)."""

    torque: Floats
    """Most that they give, without the share that plans leave [N m] or [N]."""
    speed: Floats
    """Without load, at which they give nothing [rad/s] or [m/s]; infinite where nothing states one."""
    rotor: Floats
    """Inertia at the joint [kg m^2], or mass [kg]."""
    friction: Floats
    """Coulomb friction of the gear [N m] or [N]."""
    damping: Floats
    """Viscous friction of the gear [N m s/rad] or [N s/m]."""
    sliding: Bools

    @classmethod
    def of(cls, robot: SpatialRobot) -> "Motors":
        """Of a robot, as its files have them."""
        chains = robot.chains
        joints = [joint for limb in robot.choice.limbs for joint in limb.joints]
        return cls(
            torque=chains.torque[chains.used] / robot.spec.torque_share,
            speed=chains.speed[chains.used],
            rotor=np.array([joint.rotor for joint in joints]),
            friction=np.array([joint.friction for joint in joints]),
            damping=np.array([joint.damping for joint in joints]),
            sliding=chains.sliding[chains.used] == 1,
        )
