"""A ground to walk on: a slope with blocks, ditches, rough parts and forbidden patches on it, seen as an exact height above every place."""

from pathlib import Path
from typing import Annotated, ClassVar, Final

import numpy as np
import numpy.typing as npt
from pydantic import Field, StrictInt, StrictStr

from ....files import Document, check_schema, data_names, find_data, read_toml
from ....notebook import Pictured
from ....specs import Name, build_spec, spec
from ....tasks.regions import check_polygon
from ....types import Floats
from ....units import Angle, Length, Polygon, PositiveLength, PositiveRatio, Quantity

SCHEMA: Final = "clamber-ground-1"
MOST_TILES: Final = 20_000
"""More tiles than this are refused: each is a body to touch."""


@spec
class Rectangle:
    """A rectangle of the ground, with sides along its axes."""

    x_min: Length
    """In the ground's frame [m]."""
    x_max: Length
    """[m]."""
    y_min: Length
    """[m]."""
    y_max: Length
    """[m]."""

    def corners(self) -> Polygon:
        """Its corners, anticlockwise."""
        return (
            (self.x_min, self.y_min),
            (self.x_max, self.y_min),
            (self.x_max, self.y_max),
            (self.x_min, self.y_max),
        )


@spec
class Block(Rectangle):
    """A rectangle of the ground at a height of its own: a step where it is above the slope, a ditch where it is below."""

    height: Length
    """Of its top above the slope, along the slope's normal [m]."""


@spec
class Rough(Rectangle):
    """A rectangle of square tiles of random heights."""

    tile: PositiveLength
    """Side of a tile [m]."""
    height: Length
    """Heights are even between minus this and this [m]."""
    seed: Annotated[StrictInt, Field(ge=0)] = 0
    """Of the heights."""

    def blocks(self) -> tuple[Block, ...]:
        """Its tiles; those at the upper edges are cut."""
        xs, ys = (
            np.append(np.arange(low, high - 1e-9, self.tile), high)
            for low, high in ((self.x_min, self.x_max), (self.y_min, self.y_max))
        )
        heights = np.random.default_rng(self.seed).uniform(-self.height, self.height, (len(xs) - 1, len(ys) - 1))
        return tuple(
            Block(x_min=xs[i], x_max=xs[i + 1], y_min=ys[j], y_max=ys[j + 1], height=heights[i, j])
            for i in range(len(xs) - 1)
            for j in range(len(ys) - 1)
        )


@spec
class Ground(Pictured):
    """Ground in SI units. World frame: x and y level, z up; the ground's frame is tilted about a level axis through the same origin.

    A slope of 0 makes both frames one. Rectangles are right-angled to the slope: so are the walls of steps and ditches.
    """

    kind: ClassVar[str] = "ground"

    name: Name
    title: StrictStr = ""
    source: StrictStr = ""
    """Where the places come from."""
    slope: Annotated[float, Quantity("angle", at_least=0.0, at_most=1.0)] = 0.0
    """Steepest angle of the ground [rad]."""
    uphill: Angle = 0.0
    """Direction in which it rises, in the level plane from x towards y [rad]."""
    friction: PositiveRatio = 0.8
    """Coefficient of friction of a foot on it [-]."""
    x_min: Length = -10.0
    """Ends of the ground, in its frame; beyond them is nothing [m]."""
    x_max: Length = 10.0
    """[m]."""
    y_min: Length = -10.0
    """[m]."""
    y_max: Length = 10.0
    """[m]."""
    depth: PositiveLength = 1.0
    """How far the ground reaches below the slope: as deep as any ditch [m]."""
    blocks: tuple[Block, ...] = ()
    """A later one replaces what an earlier one says of the same place."""
    rough: tuple[Rough, ...] = ()
    """Laid before the blocks."""
    patches: tuple[Rectangle | Polygon, ...] = ()
    """Where no foot may stand although it could: rectangles, or corners of simple polygons, ground's frame [m]."""

    def forbidden(self) -> tuple[Polygon, ...]:
        """Corners of the patches, ground's frame [m]."""
        return tuple(patch.corners() if isinstance(patch, Rectangle) else patch for patch in self.patches)

    def raised(self) -> tuple[Block, ...]:
        """Rough tiles and blocks, in the order in which they are laid: their outlines are the ground's edges."""
        return (*(block for patch in self.rough for block in patch.blocks()), *self.blocks)

    def axes(self) -> Floats:
        """The ground's axes in the world, as columns, shape (3, 3)."""
        c, s = np.cos(self.uphill), np.sin(self.uphill)
        rise, run = np.sin(self.slope), np.cos(self.slope)
        to_uphill = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        tilt = np.array([[run, 0.0, -rise], [0.0, 1.0, 0.0], [rise, 0.0, run]])
        axes: Floats = to_uphill @ tilt @ to_uphill.T
        return axes

    def tiles(self) -> Floats:
        """The ground as bricks that lie side by side: x_min, x_max, y_min, y_max, top of each, ground's frame [m], shape (n, 5).

        All of them reach down to `depth`. As few as a sweep along x and then along y finds, so that a flat ground is one.
        """
        stated = np.array([(b.x_min, b.x_max, b.y_min, b.y_max, b.height) for b in self.raised()]).reshape(-1, 5)
        xs, ys = (
            np.unique(np.clip(np.concatenate([(low, high), stated[:, at], stated[:, at + 1]]), low, high))
            for at, low, high in ((0, self.x_min, self.x_max), (2, self.y_min, self.y_max))
        )
        tops = np.zeros((len(xs) - 1, len(ys) - 1))
        for x_min, x_max, y_min, y_max, height in stated:
            columns = slice(*np.searchsorted(xs, (x_min, x_max)))
            tops[columns, slice(*np.searchsorted(ys, (y_min, y_max)))] = height
        return _merge(xs, ys, tops)

    def heights(self, places: npt.ArrayLike) -> Floats:
        """How high the ground is above places of the level plane, [m], exactly, shape (...,); minus infinity beyond its ends.

        Args:
            places: x, y in the world [m], shape (..., 2).
        """
        return Surface(self).heights(places)


class Surface:
    """A ground's bricks, to ask for many heights."""

    def __init__(self, ground: Ground) -> None:
        tiles = ground.tiles()
        self._down = ground.axes().T  # world to ground
        self._low = np.column_stack((tiles[:, 0], tiles[:, 2], np.full(len(tiles), -ground.depth)))
        self._high = np.column_stack((tiles[:, 1], tiles[:, 3], tiles[:, 4]))

    def heights(self, places: npt.ArrayLike) -> Floats:
        """See `Ground.heights`: where the upright line through a place leaves the highest brick."""
        at = np.asarray(places, dtype=np.float64)
        flat = at.reshape(-1, 2)
        base = flat @ self._down[:, :2].T  # (n, 3)
        up = self._down[:, 2]
        enter, leave = np.full((len(flat), len(self._low)), -np.inf), np.full((len(flat), len(self._low)), np.inf)
        for axis in range(3):
            start = base[:, axis, None]
            if abs(up[axis]) < 1e-12:  # along the brick's sides
                outside = (start < self._low[:, axis]) | (start > self._high[:, axis])
                leave[outside] = -np.inf
                continue
            ends = ((side[:, axis] - start) / up[axis] for side in (self._low, self._high))
            first, second = ends
            np.maximum(enter, np.minimum(first, second), out=enter)
            np.minimum(leave, np.maximum(first, second), out=leave)
        found: Floats = np.where(enter <= leave, leave, -np.inf).max(axis=1, initial=-np.inf)
        return found.reshape(at.shape[:-1])


def _merge(xs: Floats, ys: Floats, tops: Floats) -> Floats:
    """Cells of a grid joined to larger rectangles of one height: first along y, then equal strips along x."""
    strips: list[tuple[float, ...]] = []
    grown: dict[tuple[float, float, float], int] = {}  # y_min, y_max, top -> strip that ends at the present column
    for i in range(len(xs) - 1):
        edges = np.flatnonzero(np.diff(tops[i])) + 1
        now: dict[tuple[float, float, float], int] = {}
        for first, last in zip((0, *edges), (*edges, tops.shape[1]), strict=True):
            key = (float(ys[first]), float(ys[last]), float(tops[i, first]))
            if key in grown:
                at = grown[key]
                strips[at] = (strips[at][0], xs[i + 1], *strips[at][2:])
            else:
                at = len(strips)
                strips.append((xs[i], xs[i + 1], *key))
            now[key] = at
        grown = now
    return np.array(strips, dtype=np.float64).reshape(-1, 5)


def build_ground(document: Document) -> Ground:
    """A ground from its document.

    Raises:
        SpecError: If the document breaks a rule of the format, or a rectangle encloses nothing.
    """
    check_schema(document, SCHEMA)
    ground = build_spec(Ground, document, without=("schema",))
    rectangles: list[tuple[str, Ground | Rectangle]] = [("", ground)]
    for key in ("blocks", "rough", "patches"):
        rectangles += [
            (f"{key}.{i}.", each) for i, each in enumerate(getattr(ground, key)) if isinstance(each, Rectangle)
        ]
    for i, patch in enumerate(ground.patches):
        if not isinstance(patch, Rectangle):
            check_polygon(patch, document, f"patches.{i}")
    for prefix, each in rectangles:
        for low, high in (("x_min", "x_max"), ("y_min", "y_max")):
            if not getattr(each, low) < getattr(each, high):
                raise document.problem(f"{prefix}{low}", f"must be less than {high}")
    for i, block in enumerate(ground.blocks):
        if not block.height > -ground.depth:
            raise document.problem(
                f"blocks.{i}.height", f"must be above the ground's bottom, -depth = {-ground.depth:g} m"
            )
    for i, rough in enumerate(ground.rough):
        if not 0.0 <= rough.height < ground.depth:
            raise document.problem(
                f"rough.{i}.height", f"must be 0 or more, and less than the depth of {ground.depth:g} m"
            )
        n = np.ceil((rough.x_max - rough.x_min) / rough.tile) * np.ceil((rough.y_max - rough.y_min) / rough.tile)
        if n > MOST_TILES:
            raise document.problem(f"rough.{i}.tile", f"makes {n:.0f} tiles; at most {MOST_TILES}")
    return ground


DATA: Final = Path(__file__).parents[1] / "data" / "worlds"


def ground_names() -> tuple[str, ...]:
    """Names of the grounds that come with Clamber."""
    return data_names(DATA)


def read_ground(name_or_path: str, folder: Path | None = None) -> Document:
    """The document of a ground, shipped or the user's own (a path, relative to `folder`)."""
    path, label = find_data("ground", name_or_path, (DATA,), folder)
    return read_toml(path, label)


def load_ground(name_or_path: str) -> Ground:
    """A ground by its shipped name, such as "slope", or from the user's TOML file.

    Raises:
        UnknownNameError: If no shipped ground has that name.
        FileError: If the file cannot be read.
        SpecError: If the file says something that cannot be used.
    """
    return build_ground(read_ground(name_or_path))
