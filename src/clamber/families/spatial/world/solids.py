"""Solid things of a world in space that links must not enter, each with its signed distance: planes, boxes, cylinders, tubes, bars."""

from typing import Annotated, Final, Literal

import numpy as np
from pydantic import Field

from ....files import Document
from ....specs import spec
from ....types import Floats
from ....units import Place, PositiveLength, Quantity

PLANE, BOX, CYLINDER, TUBE, BAR, FIELD = 0, 1, 2, 3, 4, 5
SOLID: Final = np.dtype(
    [
        ("kind", "i8"),
        ("centre", "f8", (3,)),  # world frame [m]
        ("axes", "f8", (3, 3)),  # of its own frame, as rows, world frame
        ("size", "f8", (3,)),  # half extents of a box; radius and half length of the others; distance of nodes [m]
        (
            "nodes_at",
            "i8",
        ),  # distances from a terrain at nodes of a grid [m], 32-bit floats; `centre` is the first of them
        ("nodes", "i8", (3,)),  # numbers of nodes along the axes
    ],
    align=True,
)
Part = Annotated[float, Quantity("ratio", at_least=-1e6, at_most=1e6)]
Direction = tuple[Part, Part, Part]
"""x, y, z of a vector whose length does not matter."""
SHORT: Final = 1e-9
"""A vector no longer than this, or than this share of others, has no direction."""


@spec
class Plane:
    """All that lies behind a plane."""

    kind: Literal["plane"]
    at: Place
    """A point of it."""
    normal: Direction
    """Out of the solid."""


@spec
class Box:
    """A box."""

    kind: Literal["box"]
    at: Place
    """Its centre."""
    size: tuple[PositiveLength, PositiveLength, PositiveLength]
    """Along its own x, y and z."""
    x: Direction = (1.0, 0.0, 0.0)
    """World direction of its own x."""
    z: Direction = (0.0, 0.0, 1.0)
    """World direction of its own z, or nearly: it is made square to x."""


@spec
class Round:
    """A solid cylinder, the solid about a cylindrical hole ("tube"), or a bar with round ends."""

    kind: Literal["cylinder", "tube", "bar"]
    at: Place
    """One end of its axis."""
    to: Place
    """The other end; of a tube, which has no ends, another point of its axis."""
    radius: PositiveLength


Solid = Annotated[Plane | Box | Round, Field(discriminator="kind")]


def unit(vector: tuple[float, float, float] | Floats) -> Floats:
    """A vector made as long as one."""
    given = np.asarray(vector, np.float64)
    made: Floats = given / np.linalg.norm(given)
    return made


def check_direction(document: Document, key: str, given: Direction, x: Direction | None = None) -> None:
    """Make sure that a vector has a direction, and one that x does not have.

    Raises:
        SpecError: Otherwise.
    """
    length = np.linalg.norm(given)
    if x is None:
        if not length > SHORT:
            raise document.problem(key, "must not be zero")
    elif not np.linalg.norm(np.cross(given, x)) > SHORT * max(1.0, float(length * np.linalg.norm(x))):
        raise document.problem(key, "must not be zero or lie along x")


def frame_about(z: Floats, x: Floats | None = None) -> Floats:
    """A right-handed frame whose z is a unit vector and whose x is as near as can be to another: its axes as rows, shape (3, 3)."""
    near = x if x is not None else np.eye(3)[int(np.argmin(np.abs(z)))]
    across = unit(np.cross(z, near))
    return np.stack((np.cross(across, z), across, z))


def frame_along(x: Direction, z: Direction) -> Floats:
    """A right-handed frame whose x has one direction, and whose z is as near as can be to another: its axes as rows, shape (3, 3)."""
    ahead = unit(x)
    return frame_about(unit(np.asarray(z) - float(np.dot(z, ahead)) * ahead), ahead)


def solid_record(solid: Plane | Box | Round) -> np.void:
    """A solid as kernels read it, a record of `SOLID`."""
    row: np.void = np.zeros(1, SOLID)[0]
    if isinstance(solid, Plane):
        row["kind"], row["centre"], row["axes"] = PLANE, solid.at, frame_about(unit(solid.normal))
        return row
    if isinstance(solid, Box):
        row["kind"], row["centre"], row["axes"] = BOX, solid.at, frame_along(solid.x, solid.z)
        row["size"] = np.array(solid.size) / 2.0
        return row
    ends = np.array((solid.at, solid.to))
    row["kind"] = {"cylinder": CYLINDER, "tube": TUBE, "bar": BAR}[solid.kind]
    row["centre"], row["axes"] = ends.mean(axis=0), frame_about(unit(ends[1] - ends[0]))
    row["size"][:2] = solid.radius, float(np.linalg.norm(ends[1] - ends[0])) / 2.0
    return row
