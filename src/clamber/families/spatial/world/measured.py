"""Worlds to start from, of holds or a terrain in a file: with a guide laid through the holds."""

from typing import Final

import numpy as np

from ....errors import SpecError
from ....types import Floats, Json
from .guide import MOST_LENGTH
from .made import PATCH, SPACING, Fit, Kind, rounded
from .solids import frame_about, unit
from .world import SCHEMA, World

STEEP: Final = 0.8
"""A surface whose mean normal has less of the vertical is climbed, up; others are crossed along their longer side [-]."""
ENDS: Final = 0.6
"""How far inside the holds a guide ends, over the robot's reach [-]."""
SHORT: Final = 0.25
"""A guide has at least this share of the extent of the holds [-]."""
NEAR: Final = 0.5
"""Holds that are so far aside or less, over the reach, say how high a guide lies [-]."""
ANYWHERE: Final = ({"at": ["0 m", "0 m", "0 m"], "normal": [0.0, 0.0, 1.0]}, {"at": ["1 m", "0 m", "0 m"]})
"""A guide until there is one."""


def measured_data(source: Json, fit: Fit, name: str, spacing: float | None) -> Json:
    """The document of a world of a file, its guide still anywhere.

    Args:
        source: `table`, or a terrain without its spacing: kind, file and so on.
        fit: The robot that it is for.
        name: What it is called.
        spacing: Of the holds of a terrain [m]; None: by the reach.
    """
    head: Json = {"schema": SCHEMA, "name": name, "guide": list(ANYWHERE)}
    if "table" in source:
        return head | source
    apart = rounded(SPACING * fit.reach) if spacing is None else spacing
    radius = max(1e-3, rounded(PATCH[Kind.stones] * apart))
    return head | {"terrain": [source | {"spacing": f"{apart:g} m", "radius": f"{radius:g} m"}]}


def guide_through(world: World, fit: Fit, label: str) -> list[Json]:
    """The two ends of a guide through a world's holds: up a steep surface, or along the longer side of another.

    Args:
        world: Has the holds.
        fit: The robot that it is for.
        label: What errors call the file.

    Raises:
        SpecError: If there are fewer than three holds, or they lie too far apart.
    """
    if len(world.holds) < 3:
        allowed = "makes no guide; state smaller spacing, a larger slope, or another scale"
        raise SpecError(label, "holds", len(world.holds), allowed)
    places, mean = world.places, world.normals.mean(axis=0)
    normal = unit(mean) if np.linalg.norm(mean) > 0.2 else np.array((0.0, 0.0, 1.0))
    axes = frame_about(normal, _heading(places, normal))
    own = places @ axes.T
    low, high = own[:, 0].min(), own[:, 0].max()
    if high - low > MOST_LENGTH:
        raise SpecError(
            label, "holds", f"over {high - low:g} m", f"a guide may be {MOST_LENGTH:g} m long; state another scale"
        )
    room = min(ENDS * fit.reach, 0.5 * (1.0 - SHORT) * (high - low))
    middle = 0.5 * (own[:, 1].min() + own[:, 1].max())
    near = np.abs(own[:, 1] - middle) <= max(NEAR * fit.reach, np.partition(np.abs(own[:, 1] - middle), 2)[2])
    slope, level = (
        np.polyfit(own[near, 0], own[near, 2], 1) if np.ptp(own[near, 0]) > 1e-6 else (0.0, own[near, 2].mean())
    )
    ends = np.array([(along, middle, level + slope * along) for along in (low + room, high - room)]) @ axes
    first = {"at": _place(ends[0]), "normal": [round(float(value), 6) + 0.0 for value in normal]}
    return [first, {"at": _place(ends[1])}]


def _heading(places: Floats, normal: Floats) -> Floats:
    """Where the guide goes, about [-]."""
    if abs(normal[2]) < STEEP:
        return np.array((0.0, 0.0, 1.0))
    axes = frame_about(normal)
    own = (places - places.mean(axis=0)) @ axes.T
    _, vectors = np.linalg.eigh(own[:, :2].T @ own[:, :2])
    longest: Floats = vectors[0, 1] * axes[0] + vectors[1, 1] * axes[1]
    return longest if longest[int(np.argmax(np.abs(longest)))] > 0.0 else -longest


def _place(place: Floats) -> list[str]:
    return [f"{value + 0.0:.4f} m" for value in place]
