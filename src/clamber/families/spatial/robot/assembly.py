"""From a model's tree and the choice of base, limbs and held joints to the arrays that statics takes."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from ....types import Floats
from .chains import Chains
from .tree import Frame, Joint, Posture, Tree

NEVER: Final = 1e-12
"""Torque of padding, which no limb has [N m]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LimbChoice:
    """A limb: which joints are its own, from the base to the tip, and what is known of them."""

    name: str
    joints: tuple[Joint, ...]
    lower: tuple[float, ...]
    upper: tuple[float, ...]
    """Positions that may be used [rad] or [m]."""
    torque: tuple[float, ...]
    """That may be used [N m] or [N]."""
    speed: tuple[float, ...]
    """Of each motor without load [rad/s] or [m/s]; infinite where nothing states one."""
    nominal: tuple[float, ...]
    tip_link: str
    tip: Frame
    """In that link's frame; z points out of the limb."""
    radius: float | None = None
    """Of all its links [m]; None: as their shapes have it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Choice:
    """What is chosen of a tree whose root is the base."""

    limbs: tuple[LimbChoice, ...]
    held: Mapping[str, float]
    """Positions of all joints that no limb has [rad] or [m]."""
    payload: float = 0.0
    """[kg]."""
    payload_at: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Base frame [m]."""
    half: tuple[float, float, float] | None = None
    """Half extents of the base's box [m]; None: as its shapes have it."""
    stretch: float = 1.0
    limb_room: float = 0.0
    """As those of `Chains`."""


@dataclass(frozen=True, slots=True)
class PlacedParts:
    """Where the parts are that move as one, with every limb's joints at 0, in the model's frame."""

    posture: Posture
    base: Frame
    frames: Mapping[tuple[int, int], Frame]
    """Limb, joint -> frame of the link behind it, the joint's axis as its z."""
    tips: tuple[Frame, ...]
    """Of each limb; z points out of it."""


def placed_parts(tree: Tree, choice: Choice) -> PlacedParts:
    """The frames of base, links and tips of a robot whose tree has the base as its root."""
    posture = Posture.of(tree, choice.held)
    frames: dict[tuple[int, int], Frame] = {}
    for index, limb in enumerate(choice.limbs):
        for k, joint in enumerate(limb.joints):
            place, axis = posture.axis(joint)
            frames[index, k] = Frame(place, axis_frame(axis))
    tips = tuple(posture.frame(tree.link(limb.tip_link)).then(limb.tip) for limb in choice.limbs)
    return PlacedParts(posture, posture.frame(tree.links[0]), frames, tips)


def chains_of(name: str, tree: Tree, choice: Choice) -> Chains:
    """The arrays of a robot whose tree has the base as its root."""
    placed = placed_parts(tree, choice)
    posture, base, frames = placed.posture, placed.base, placed.frames
    owner = owners(tree, choice.limbs)
    n_limbs, most = len(choice.limbs), max(len(limb.joints) for limb in choice.limbs)
    shape = (n_limbs, most)
    offset, rotation = np.zeros((n_limbs, most + 1, 3)), np.tile(np.eye(3), (n_limbs, most + 1, 1, 1))
    mass, moment = np.zeros(shape), np.zeros((*shape, 3))
    for index, limb in enumerate(choice.limbs):
        before = base
        for k, frame in enumerate((*(frames[index, k] for k in range(len(limb.joints))), placed.tips[index])):
            offset[index, k], rotation[index, k] = before.within(frame.place), before.axes.T @ frame.axes
            before = frame
    base_mass, base_moment = choice.payload, choice.payload * np.array(choice.payload_at)
    for link in tree.links:
        centre = posture.frame(link).at(link.centre)
        owned = owner[link.name]
        if owned is None:
            base_mass += link.mass
            base_moment = base_moment + link.mass * base.within(centre)
        else:
            mass[owned] += link.mass
            moment[owned] += link.mass * frames[owned].within(centre)
    return Chains(
        name=name,
        limb_names=tuple(limb.name for limb in choice.limbs),
        joint_names=tuple(tuple(joint.name for joint in limb.joints) for limb in choice.limbs),
        n_joints=np.array([len(limb.joints) for limb in choice.limbs], np.int32),
        offset=offset,
        rotation=rotation,
        sliding=_padded([[joint.sliding for joint in limb.joints] for limb in choice.limbs], 0.0).astype(np.int32),
        lower=_padded([limb.lower for limb in choice.limbs], 0.0),
        upper=_padded([limb.upper for limb in choice.limbs], 0.0),
        torque=_padded([limb.torque for limb in choice.limbs], NEVER),
        speed=_padded([limb.speed for limb in choice.limbs], np.inf),
        nominal=_padded([limb.nominal for limb in choice.limbs], 0.0),
        mass=mass,
        centre=np.divide(moment, mass[..., None], out=np.zeros_like(moment), where=mass[..., None] > 0.0),
        radius=_radii(posture, choice, owner, shape),
        base_mass=float(base_mass),
        base_centre=base_moment / base_mass if base_mass > 0.0 else np.zeros(3),
        base_half=_half(posture, base) if choice.half is None else np.array(choice.half),
        stretch=choice.stretch,
        limb_room=choice.limb_room,
    )


def owners(tree: Tree, limbs: Sequence[LimbChoice]) -> dict[str, tuple[int, int] | None]:
    """Link -> limb and joint that it moves with, None: with the base."""
    by_joint = {joint.name: (index, k) for index, limb in enumerate(limbs) for k, joint in enumerate(limb.joints)}
    found: dict[str, tuple[int, int] | None] = {}
    for link in tree.links:
        own = None if link.parent is None else found[link.parent]
        for joint in tree.joints_of(link.name):
            own = by_joint.get(joint.name, own)
        found[link.name] = own
    return found


def axis_frame(axis: Floats) -> Floats:
    """Axes of a frame, as columns, whose z is a joint's axis; x is level where the axis is not upright."""
    z = axis / np.linalg.norm(axis)
    across = np.array([1.0, 0.0, 0.0]) if abs(z[0]) < 0.9 else np.array([0.0, 1.0, 0.0])
    x = np.cross(across, z)
    x /= np.linalg.norm(x)
    return np.stack([x, np.cross(z, x), z], axis=1)


def _padded(rows: Sequence[Sequence[float]], fill: float) -> Floats:
    """Rows of a table, each filled up to the longest, shape (rows, most)."""
    table = np.full((len(rows), max(map(len, rows))), fill)
    for row, values in zip(table, rows, strict=True):
        row[: len(values)] = values
    return table


def _radii(
    posture: Posture, choice: Choice, owner: Mapping[str, tuple[int, int] | None], shape: tuple[int, int]
) -> Floats:
    """Of each link's capsule: what the limb states, or half of the least extent of its thickest shape [m]."""
    radii = np.zeros(shape)
    for body in posture.tree.shapes:
        owned = owner[body.link]
        if owned is not None:
            radii[owned] = max(radii[owned], body.thickness)
    for index, limb in enumerate(choice.limbs):
        if limb.radius is not None:
            radii[index, : len(limb.joints)] = limb.radius
    return radii


def _half(posture: Posture, base: Frame) -> Floats:
    """Half extents of the box about the base frame's origin that holds the shapes fixed to the base [m], shape (3,)."""
    tree = posture.tree
    fixed: set[str] = set()
    for link in tree.links:
        if link.parent is None or (link.parent in fixed and not tree.joints_of(link.name)):
            fixed.add(link.name)
    half = np.zeros(3)
    for points, body in posture.shapes(frozenset(fixed)):
        inside = (points - base.place) @ base.axes
        half = np.maximum(half, np.abs(inside).max(axis=0) + body.radius)
    return half
