"""Grids of distances from terrains, by which links are kept out of height maps and meshes."""

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Final

import numpy as np
import numpy.typing as npt

from ....types import Floats
from .solids import FIELD, SOLID
from .terrain import Mesh, Terrain, face_normals, surface
from .terrain_files import Long

NODES: Final = 1_200_000
"""Of a grid, about: 5 MB."""
FINEST: Final = 0.004
"""Least distance of two nodes [m]."""
BAND: Final = 3.0
"""Exact distances are worked out so many nodes about the surface; farther nodes take the nearest place of a neighbour [-]."""
ROOM: Final = 0.25
"""Of the grid about the terrain, over its largest extent [-]; farther away a distance is that of the grid's edge and on from there."""
MOST_ROOM: Final = 0.5
"""The same at most [m]."""
DRAWN: Final = 2500
"""Most triangles of a terrain in a picture, about."""


@dataclass(frozen=True, slots=True, eq=False)
class DistanceField:
    """Signed distances from a surface, positive on the side that its triangles face."""

    values: npt.NDArray[np.float32]
    """At the nodes [m], shape (nx, ny, nz)."""
    corner: Floats
    """Of the first node, world frame [m], shape (3,)."""
    axes: Floats
    """Of the grid, as rows, world frame, shape (3, 3)."""
    grain: float
    """Distance of neighbouring nodes [m]."""
    drawn: Mesh
    """The surface for pictures, world frame, with few triangles."""

    @property
    def record(self) -> np.void:
        """As kernels read it, a record of `SOLID`; valid as long as this object lives."""
        row: np.void = np.zeros(1, SOLID)[0]
        row["kind"], row["centre"], row["axes"] = FIELD, self.corner, self.axes
        row["size"][0] = self.grain
        row["nodes_at"], row["nodes"] = self.values.ctypes.data, self.values.shape
        return row


@lru_cache(maxsize=8)
def distance_field(terrain: Terrain) -> DistanceField:
    """The grid of distances from a height map or a mesh."""
    from .terrain_kernels import near_distances, spread_distances

    vertices, faces = surface(terrain)
    axes = terrain.axes
    own = vertices @ axes.T
    low, high = own.min(axis=0), own.max(axis=0)
    room = min(ROOM * float((high - low).max()), MOST_ROOM)
    low, high = low - room, high + room
    grain = max(FINEST, float((np.prod(high - low) / NODES) ** (1.0 / 3.0)))
    shape = tuple(int(n) for n in np.ceil((high - low) / grain).astype(int) + 1)
    normals, areas = face_normals((own, faces))
    faces, normals = faces[areas > 0.0], normals[areas > 0.0]
    near = np.full(shape, np.inf)
    feet = np.zeros((*shape, 3), np.float32)
    near_distances(own[faces], np.ascontiguousarray(normals), low, grain, BAND * grain, near, feet)
    spread_distances(low, grain, near, feet)
    values = near.astype(np.float32)
    values.setflags(write=False)
    return DistanceField(values, low @ axes, axes, grain, coarser((vertices, faces), DRAWN))


def coarser(mesh: Mesh, most: int) -> Mesh:
    """A surface with about so many triangles or fewer: vertices that share a cell of a grid become one."""
    vertices, faces = mesh
    if len(faces) <= most:
        return mesh
    _, areas = face_normals(mesh)
    side = math.sqrt(4.0 * float(areas.sum()) / most / math.sqrt(3.0))
    while True:
        cells, of = np.unique(np.floor(vertices / side).astype(np.int64), axis=0, return_inverse=True)
        of = of.reshape(-1).astype(np.int64)
        kept = _merged(faces, of)
        if len(kept) <= most:
            counts = np.bincount(of, minlength=len(cells)).astype(np.float64)
            middles = np.stack([np.bincount(of, vertices[:, k], len(cells)) for k in range(3)], axis=1)
            return middles / counts[:, None], kept
        side *= 1.25


def _merged(faces: Long, of: Long) -> Long:
    """Triangles between merged vertices, each once."""
    renamed = of[faces]
    proper = (renamed[:, 0] != renamed[:, 1]) & (renamed[:, 1] != renamed[:, 2]) & (renamed[:, 2] != renamed[:, 0])
    renamed = renamed[proper]
    _, first = np.unique(np.sort(renamed, axis=1), axis=0, return_index=True)
    found: Long = renamed[np.sort(first)]
    return found
