"""Terrain of a world in space: height maps, meshes and clouds of points, with the holds that limbs find on them."""

import base64
import binascii
import math
import zlib
from dataclasses import replace
from functools import lru_cache
from typing import Annotated, Final, Literal

import numpy as np
from pydantic import Field, StrictBool, StrictStr

from ....errors import SpecError
from ....files import Document
from ....regular_files import user_path
from ....specs import spec
from ....types import Floats, Json
from ....units import (
    DEGREE,
    Length,
    NonNegativeRatio,
    Place,
    PositiveAngle,
    PositiveForce,
    PositiveLength,
)
from .patterns import Seed
from .solids import Direction, check_direction, frame_along
from .terrain_files import Long, read_heights, read_mesh, read_points

LETTERS: Final = 6_000_000
"""Most of a packed array: files of more than 8 MiB are not read."""
Size = Annotated[int, Field(strict=True, ge=1, le=1_000_000)]
Mesh = tuple[Floats, Long]
"""Vertices [m], shape (n, 3), and triangles that turn anticlockwise seen from outside, shape (m, 3)."""
STEEP: Final = 60.0 * DEGREE
"""Usual slope limit of height maps and clouds [rad]."""


@spec
class Packed:
    """An array of 32-bit floats: little endian, compressed by zlib, in base 64."""

    shape: tuple[Size, Size]
    data: Annotated[str, StrictStr, Field(max_length=LETTERS)]

    @property
    def array(self) -> Floats:
        """Its values.

        Raises:
            SpecError: If the text has not so many values, or some are not finite.
        """
        size = 4 * math.prod(self.shape)
        try:
            reader = zlib.decompressobj()
            raw = reader.decompress(base64.b64decode(self.data, validate=True), size + 1)
        except (binascii.Error, zlib.error):
            raw = b""
        if len(raw) != size:
            raise SpecError("packed array", "data", f"{self.data[:20]}...", f"must have {size} bytes, base 64 of zlib")
        values = np.frombuffer(raw, "<f4").reshape(self.shape).astype(np.float64)
        if not np.isfinite(values).all():
            raise SpecError("packed array", "data", f"{self.data[:20]}...", "must be finite numbers")
        return values


def pack(values: Floats) -> dict[str, object]:
    """An array of two dimensions as a document has it."""
    data = zlib.compress(np.ascontiguousarray(values, "<f4").tobytes(), 6)
    return {"shape": list(values.shape), "data": base64.b64encode(data).decode("ascii")}


@spec
class Terrain:
    """A surface from a file. Its own frame has the height as z; `slope` is measured from there."""

    kind: Literal["heights", "mesh", "points"]
    """A height map, a mesh of triangles, or a cloud of points."""
    file: StrictStr = ""
    """From where this file lies: heights .png in grey, .npy or .csv; meshes .stl, .obj or .ply; points .csv with a header, .npy or .ply."""
    packed: tuple[Packed, ...] = ()
    """In place of a file, as plans keep it: heights or points; of meshes vertices and triangles."""
    size: tuple[PositiveLength, PositiveLength] | None = None
    """Of a height map, along its x (columns) and y (rows, the last one first)."""
    scale: Length = 1.0
    """Length of a value of 1 [m]; of a PNG, the height of its white."""
    at: Place = (0.0, 0.0, 0.0)
    """Of its origin, world frame: of a height map its middle at height 0."""
    x: Direction = (1.0, 0.0, 0.0)
    """World direction of its own x."""
    z: Direction = (0.0, 0.0, 1.0)
    """World direction of its own z, or nearly: it is made square to x."""
    spacing: PositiveLength | None = None
    """Least distance of two holds; None: it has none."""
    slope: PositiveAngle | None = None
    """Largest angle between z and the normal of a hold; 60 deg unless stated, of a mesh any."""
    radius: PositiveLength = 0.01
    """Of the patch about a hold that can be taken; of surfaces its normal is the mean there, within a spacing."""
    friction: NonNegativeRatio | None = None
    """Of the surface; None: that of the end effector."""
    strength: PositiveForce | None = None
    """Of every hold [N]; None: any."""
    neighbours: Annotated[int, Field(strict=True, ge=4, le=100)] = 12
    """Points of a cloud through which a hold's plane is fitted."""
    solid: StrictBool = True
    """Whether links and base must miss it; clouds are never solid."""
    seed: Seed = 0

    @property
    def axes(self) -> Floats:
        """Of its frame, as rows, world frame, shape (3, 3)."""
        return frame_along(self.x, self.z)

    @property
    def steepest(self) -> float:
        """Largest angle between z and the normal of a hold [rad]."""
        return self.slope if self.slope is not None else math.pi if self.kind == "mesh" else STEEP


def packed_terrain(document: Document) -> Document:
    """A world's document with the values of its terrains' files in their place, so that it can be built where those are not.

    Raises:
        FileError: If a file cannot be read.
    """
    stated = document.data.get("terrain")
    if not isinstance(stated, list):
        return document
    made = [_packed(document, table) if isinstance(table, dict) and table.get("file") else table for table in stated]
    return replace(document, data=document.data | {"terrain": made})


def _packed(document: Document, table: Json) -> Json:
    said = table["file"]
    if not isinstance(said, str) or table.get("packed"):
        return table
    path = user_path(said)
    path = path if document.folder is None else document.folder / path
    rest = {key: value for key, value in table.items() if key != "file"}
    if table.get("kind") == "heights":
        return rest | {"packed": [pack(read_heights(path))]}
    if table.get("kind") == "mesh":
        vertices, faces = read_mesh(path)
        return rest | {"packed": [pack(vertices), pack(faces.astype(np.float64))]}
    if table.get("kind") == "points":
        points, metres = read_points(path)
        return rest | {"packed": [pack(points)]} | ({} if metres is None else {"scale": f"{metres!r} m"})
    return table


def check_terrain(terrain: Terrain, key: str, document: Document) -> None:
    """Make sure that a terrain has its values, and those of its kind alone.

    Raises:
        SpecError: Otherwise.
    """
    check_direction(document, f"{key}.z", terrain.z, terrain.x)
    if (terrain.kind == "heights") == (terrain.size is None):
        allowed = (
            "must be given, of a height map"
            if terrain.size is None
            else "is of height maps; meshes and points have a scale"
        )
        raise document.problem(f"{key}.size", allowed)
    if not terrain.scale:
        raise document.problem(f"{key}.scale", "must not be 0")
    parts = 2 if terrain.kind == "mesh" else 1
    if not terrain.packed:
        raise document.problem(f"{key}.file", "must be the path of a file, in quotes")
    if len(terrain.packed) != parts or any(part.shape[1] != 3 for part in terrain.packed if terrain.kind != "heights"):
        raise document.problem(f"{key}.packed", "must be heights; points; or vertices and triangles")
    if terrain.kind == "mesh":
        faces, count = terrain.packed[1].array, terrain.packed[0].shape[0]
        if faces.min() < 0 or faces.max() >= count:
            raise document.problem(f"{key}.packed.1", f"must be numbers of vertices, 0 to {count - 1}")


@lru_cache(maxsize=8)
def surface(terrain: Terrain) -> Mesh:
    """The surface of a height map or a mesh, world frame."""
    if terrain.kind == "mesh":
        own, faces = terrain.scale * terrain.packed[0].array, terrain.packed[1].array.astype(np.int64)
        if terrain.scale < 0.0:
            faces = faces[:, ::-1]
    else:
        assert terrain.size is not None
        values = terrain.scale * terrain.packed[0].array[::-1]  # the last row is the nearest
        rows, columns = values.shape
        x = np.linspace(-0.5, 0.5, columns) * terrain.size[0]
        y = np.linspace(-0.5, 0.5, rows) * terrain.size[1]
        own = np.stack((*np.meshgrid(x, y), values), axis=-1).reshape(-1, 3)
        index = np.arange(rows * columns).reshape(rows, columns)
        a, b, c, d = index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]
        faces = np.concatenate([np.stack(corners, axis=-1).reshape(-1, 3) for corners in ((a, b, c), (a, c, d))])
    return own @ terrain.axes + np.array(terrain.at), faces


def face_normals(mesh: Mesh) -> tuple[Floats, Floats]:
    """Normals of triangles, zero where one has no area, and their areas [m^2]."""
    vertices, faces = mesh
    corners = vertices[faces]
    cross = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    doubled = np.linalg.norm(cross, axis=1)
    return cross / np.maximum(doubled, 1e-300)[:, None], 0.5 * doubled


@lru_cache(maxsize=8)
def holds_on(terrain: Terrain) -> tuple[Floats, Floats]:
    """Holds on a terrain, the same for the same seed: `spacing` apart, on slopes that are allowed.

    Returns:
        Places [m] and normals out of the surface, world frame, shape (n, 3) each.
    """
    if terrain.spacing is None:
        return np.zeros((0, 3)), np.zeros((0, 3))
    if terrain.kind == "points":
        places, normals = _on_points(terrain, terrain.spacing)
    else:
        places, normals = _on_mesh(terrain, terrain.spacing)
    up = terrain.axes[2]
    kept = normals @ up >= math.cos(terrain.steepest) - 1e-12
    places, normals = places[kept], normals[kept]
    chosen = thinned(places, terrain.spacing)
    return places[chosen], normals[chosen]


CANDIDATES: Final = 8.0
"""Samples for each square of the holds' spacing, of which those are kept that are far enough from all kept before."""
MOST_CANDIDATES: Final = 400_000
"""Samples of a surface; with fewer for each square, holds lie less densely."""


def _on_mesh(terrain: Terrain, spacing: float) -> tuple[Floats, Floats]:
    """Places all over a surface, at random by area, and the mean of the normals about each."""
    from scipy.spatial import cKDTree

    vertices, faces = surface(terrain)
    normals, areas = face_normals((vertices, faces))
    total = float(areas.sum())
    if not total > 0.0:
        return np.zeros((0, 3)), np.zeros((0, 3))
    rng = np.random.default_rng(terrain.seed)
    count = math.ceil(min(CANDIDATES * total / spacing**2, MOST_CANDIDATES)) + 1
    picked = np.searchsorted(np.cumsum(areas), rng.uniform(0.0, total, count)).clip(0, len(areas) - 1)
    u, v = rng.uniform(size=(2, count))
    over = u + v > 1.0
    u, v = np.where(over, 1.0 - u, u), np.where(over, 1.0 - v, v)
    corners = vertices[faces[picked]]
    places = corners[:, 0] + u[:, None] * (corners[:, 1] - corners[:, 0]) + v[:, None] * (corners[:, 2] - corners[:, 0])
    own = normals[picked]
    pairs = cKDTree(places).query_pairs(min(terrain.radius, spacing), output_type="ndarray")
    alike = pairs[np.einsum("ij,ij->i", own[pairs[:, 0]], own[pairs[:, 1]]) > ALIKE] if len(pairs) else pairs
    mean = own.copy()
    np.add.at(mean, alike[:, 0], own[alike[:, 1]])
    np.add.at(mean, alike[:, 1], own[alike[:, 0]])
    return places, mean / np.linalg.norm(mean, axis=1, keepdims=True)


ALIKE: Final = 0.3
"""Normals with a smaller product are of another side of an edge or of a thin wall, and do not count in a mean [-]."""


def _on_points(terrain: Terrain, spacing: float) -> tuple[Floats, Floats]:
    """Points of a cloud, and normals of the planes fitted to those nearest to each, towards its z."""
    from scipy.spatial import cKDTree

    places = terrain.scale * terrain.packed[0].array @ terrain.axes + np.array(terrain.at)
    chosen = thinned(places, 0.5 * spacing)  # fits cost time; twice as many as holds leave a choice
    tree = cKDTree(places)
    _, near = tree.query(places[chosen], k=min(terrain.neighbours, len(places)))
    about = places[near]
    about = about - about.mean(axis=1, keepdims=True)
    _, vectors = np.linalg.eigh(np.einsum("nij,nik->njk", about, about))
    normals = vectors[:, :, 0]
    normals = np.where((normals @ terrain.axes[2] < 0.0)[:, None], -normals, normals)
    return places[chosen], normals


def thinned(places: Floats, spacing: float) -> Long:
    """Indices of places, the first of them first, that are `spacing` or more from all chosen before."""
    from scipy.spatial import cKDTree

    if not len(places):
        return np.zeros(0, np.int64)
    tree, free, chosen = cKDTree(places), np.ones(len(places), bool), []
    for index in range(len(places)):
        if free[index]:
            chosen.append(index)
            free[tree.query_ball_point(places[index], spacing)] = False
    return np.array(chosen, np.int64)
