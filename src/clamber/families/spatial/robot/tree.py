"""A robot as its model file has it: links that hang on each other by joints, posed with every joint at 0."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Annotated, Final, Literal, TypeAlias

import numpy as np
from pydantic import Field, StrictStr

from ....files import Document
from ....specs import build_spec, spec
from ....types import Floats

Number: TypeAlias = Annotated[float, Field(strict=True, allow_inf_nan=False)]
NotNegative: TypeAlias = Annotated[float, Field(strict=True, ge=0.0, allow_inf_nan=False)]
Vector: TypeAlias = tuple[Number, Number, Number]
Matrix: TypeAlias = tuple[Vector, Vector, Vector]
"""Rows."""
ROUNDED: Final = 1e-6
"""What the numbers of a file may take from an axis's length or a matrix's product."""


@spec
class Link:
    """A rigid part. Place and axes are in the model's frame with every joint at 0, the inertial data in the link's own frame."""

    name: StrictStr
    parent: StrictStr | None = None
    """None: the root."""
    place: Vector
    """Origin of its frame [m]."""
    axes: Matrix
    """Axes of its frame, as columns."""
    mass: NotNegative
    """[kg]."""
    centre: Vector = (0.0, 0.0, 0.0)
    """Centre of mass in the link's frame [m]."""
    inertia: Matrix = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    """About that centre, in the link's axes [kg m^2]."""


@spec
class Joint:
    """One degree of freedom between a link and its parent, in the model's frame with every joint at 0."""

    name: StrictStr
    link: StrictStr
    """The link that it moves; several joints of one link act in order, the first next to the parent."""
    kind: Literal["hinge", "slide"]
    axis: Vector
    anchor: Vector
    """A point of the axis [m]."""
    limits: tuple[Number, Number] | None = None
    """[rad] or [m]; None where the model states none."""
    torque: Annotated[float, Field(strict=True, gt=0.0, allow_inf_nan=False)] | None = None
    """Largest motor torque [N m] or force [N]; None where the model states none."""
    speed: Annotated[float, Field(strict=True, gt=0.0, allow_inf_nan=False)] | None = None
    """Largest speed [rad/s] or [m/s]; None where the model states none."""
    rotor: NotNegative = 0.0
    """Inertia of its motor's rotor at the joint [kg m^2], or mass [kg]."""
    friction: NotNegative = 0.0
    """Coulomb friction of its gear [N m] or [N]."""
    damping: NotNegative = 0.0
    """Viscous friction of its gear [N m s/rad] or [N s/m]."""
    held: Number | None = None
    """Position at which it stays because the model couples it to another joint [rad] or [m]."""

    @property
    def sliding(self) -> bool:
        """Whether it slides in place of turning."""
        return self.kind == "slide"


@spec
class Site:
    """A named frame on a link, in the link's frame."""

    name: StrictStr
    link: StrictStr
    place: Vector
    """[m]."""
    axes: Matrix


@spec
class Shape:
    """A collision body: the convex hull of points, blown up by a radius, in the link's frame."""

    link: StrictStr
    points: tuple[Vector, ...]
    """[m]."""
    radius: Number = 0.0
    """[m]."""
    thickness: Number
    """Half of its least extent [m]."""


@spec
class Tree:
    """Links, joints, sites and shapes; what a robot's file is applied to."""

    name: StrictStr
    links: tuple[Link, ...]
    """Parents before children; the first one is the root."""
    joints: tuple[Joint, ...] = ()
    sites: tuple[Site, ...] = ()
    shapes: tuple[Shape, ...] = ()
    sha256: StrictStr = ""
    """Of the model file."""

    def link(self, name: str) -> Link:
        """The link called `name`."""
        return next(link for link in self.links if link.name == name)

    def path(self, name: str) -> tuple[str, ...]:
        """Links from the root to the one called `name`, both with them."""
        parents = {link.name: link.parent for link in self.links}
        found = [name]
        while (parent := parents[found[-1]]) is not None:
            found.append(parent)
        return tuple(reversed(found))

    def joints_of(self, link: str) -> tuple[Joint, ...]:
        """Joints between a link and its parent, the first one next to the parent."""
        return tuple(joint for joint in self.joints if joint.link == link)

    @property
    def mass(self) -> float:
        """Of all links [kg]."""
        return sum(link.mass for link in self.links)


def read_tree(document: Document) -> Tree:
    """The tree of a document, whose parts name each other.

    Raises:
        SpecError: If a part names a link that is not there or comes later, two have one name, or axes are none.
    """
    tree = build_spec(Tree, document)
    links: list[str] = []
    for index, link in enumerate(tree.links):
        if link.name in links:
            raise document.problem(f"links.{index}.name", "names of links must differ")
        if (link.parent in links) is not bool(links) or (link.parent is not None and not links):
            raise document.problem(f"links.{index}.parent", "must be a link before it, and only the first has none")
        _check_axes(document, f"links.{index}.axes", link.axes)
        links.append(link.name)
    joints = [joint.name for joint in tree.joints]
    for index, joint in enumerate(tree.joints):
        if joint.name in joints[:index]:
            raise document.problem(f"joints.{index}.name", "names of joints must differ")
        if abs(np.linalg.norm(joint.axis) - 1.0) > ROUNDED:
            raise document.problem(f"joints.{index}.axis", "must have the length 1")
    for index, site in enumerate(tree.sites):
        _check_axes(document, f"sites.{index}.axes", site.axes)
    for kind in ("joints", "sites", "shapes"):
        for index, part in enumerate(getattr(tree, kind)):
            if part.link not in links:
                raise document.problem(f"{kind}.{index}.link", "must be the name of a link")
    return tree


def _check_axes(document: Document, key: str, axes: Matrix) -> None:
    turned = np.array(axes)
    if np.abs(turned @ turned.T - np.eye(3)).max() > ROUNDED or np.linalg.det(turned) < 0.0:
        raise document.problem(key, "must be a rotation matrix")


@dataclass(frozen=True, slots=True)
class Frame:
    """A place and axes, as columns, in the model's frame."""

    place: Floats
    axes: Floats

    def at(self, point: Floats | Vector) -> Floats:
        """A point of this frame in the model's frame [m]."""
        placed: Floats = self.place + self.axes @ np.asarray(point, float)
        return placed

    def then(self, other: "Frame") -> "Frame":
        """The frame that `other` is in this one."""
        return Frame(self.at(other.place), self.axes @ other.axes)

    def within(self, point: Floats) -> Floats:
        """A point of the model's frame in this one [m]."""
        inside: Floats = self.axes.T @ (point - self.place)
        return inside


NOWHERE: Final = Frame(np.zeros(3), np.eye(3))
"""The model's own frame."""


@dataclass(frozen=True, slots=True)
class Posture:
    """A tree with its joints at given positions: where links and joints have moved from where they are at 0."""

    tree: Tree
    moved: Mapping[str, Frame]
    """Link -> motion from where it is with every joint at 0."""
    before: Mapping[str, Frame]
    """Joint -> the same motion of what carries it."""

    @classmethod
    def of(cls, tree: Tree, positions: Mapping[str, float] | None = None) -> "Posture":
        """Product of exponentials, from the root to the leaves; `positions`: joint -> [rad] or [m], 0 where it is not stated."""
        stated = positions or {}
        moved: dict[str, Frame] = {}
        before: dict[str, Frame] = {}
        joints: dict[str, list[Joint]] = {}
        for joint in tree.joints:
            joints.setdefault(joint.link, []).append(joint)
        for link in tree.links:
            motion = NOWHERE if link.parent is None else moved[link.parent]
            for joint in joints.get(link.name, ()):
                before[joint.name] = motion
                motion = motion.then(motion_of(joint, stated.get(joint.name, 0.0)))
            moved[link.name] = motion
        return cls(tree, moved, before)

    def frame(self, link: Link) -> Frame:
        """Where a link is."""
        return self.moved[link.name].then(Frame(np.array(link.place), np.array(link.axes)))

    def axis(self, joint: Joint) -> tuple[Floats, Floats]:
        """Anchor [m] and direction of a joint's axis, moved by the joints before it."""
        motion = self.before[joint.name]
        return motion.at(joint.anchor), motion.axes @ np.array(joint.axis)

    def site(self, site: Site) -> Frame:
        """Where a site is."""
        return self.frame(self.tree.link(site.link)).then(Frame(np.array(site.place), np.array(site.axes)))

    def shapes(self, links: "frozenset[str]") -> Iterator[tuple[Floats, Shape]]:
        """Points of each shape of some links [m], shape (n, 3), and the shape."""
        frames = {link.name: self.frame(link) for link in self.tree.links if link.name in links}
        for shape in self.tree.shapes:
            if shape.link in frames:
                frame = frames[shape.link]
                yield frame.place + np.array(shape.points) @ frame.axes.T, shape


def motion_of(joint: Joint, position: float) -> Frame:
    """How a joint moves what lies behind it, in the model's frame, with every joint before it at 0."""
    axis, anchor = np.array(joint.axis), np.array(joint.anchor)
    if joint.sliding:
        return Frame(axis * position, np.eye(3))
    turned = turn(axis, position)
    return Frame(anchor - turned @ anchor, turned)


def turn(axis: Floats, angle: float) -> Floats:
    """Rotation about a unit vector by an angle [rad], shape (3, 3) (Rodrigues)."""
    x, y, z = axis
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    turned: Floats = np.eye(3) + np.sin(angle) * cross + (1.0 - np.cos(angle)) * (cross @ cross)
    return turned


def vector(values: Floats) -> Vector:
    """Three numbers of an array."""
    x, y, z = (float(value) for value in values)
    return x, y, z


def matrix(values: Floats) -> Matrix:
    """Three rows of an array."""
    a, b, c = (vector(row) for row in values)
    return a, b, c


def rooted_at(tree: Tree, base: str) -> Tree:
    """The same robot with another link as root: what hung the other way round turns, so that every joint moves what is beyond it."""
    path = tree.path(base)
    if len(path) == 1:
        return tree
    above = dict(pairwise(path))
    """Link that was above on the path -> the one below, which now carries it."""
    turned = {name: replace(tree.link(name), parent=above.get(name)) for name in path}
    by_name = {link.name: turned.get(link.name, link) for link in tree.links}
    ordered = [by_name.pop(name) for name in reversed(path)]
    while by_name:
        placed = {link.name for link in ordered}
        ordered += [by_name.pop(name) for name in list(by_name) if by_name[name].parent in placed]
    joints: list[Joint] = [joint for joint in tree.joints if joint.link not in path]
    for parent, child in above.items():
        joints += [
            replace(joint, link=parent, axis=vector(-np.array(joint.axis))) for joint in reversed(tree.joints_of(child))
        ]
    return replace(tree, links=tuple(ordered), joints=tuple(joints))
