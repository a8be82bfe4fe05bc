"""From where pictures of a world in space look at it: an orthographic camera, so that lengths keep one scale over the whole picture."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Final

import numpy as np

from ....errors import SpecError, describe_choices
from ....types import Floats
from ....units import DEGREE
from ..planning.task import SpatialTask
from ..world.patterns import frame_at
from ..world.solids import unit
from ..world.world import World
from .obstacles import clear_of_solids

NAMES: Final = ("front", "left", "right", "above", "iso")
ASIDE: Final = math.radians(60.0)
"""How far to the side `left` and `right` are of `front` [rad]."""
STEEP: Final = 0.8
"""A surface whose normal rises or falls by more than this is a floor or a ceiling [-]."""
AZIMUTHS: Final = np.arange(0.0, 360.0, 15.0) * DEGREE
ELEVATIONS: Final = np.array((-40.0, -25.0, -12.0, 5.0, 15.0, 25.0, 35.0, 50.0)) * DEGREE
FACING: Final = 0.6
"""Cosine between a surface's normal and the way to the camera from which on surfaces are seen well [-]."""


BEHIND: Final = 1.2
"""How much surfaces that are seen from behind count against a camera, per cosine [-]."""
ASLANT: Final = 0.87
"""Share of its length that a guide is best seen at: aslant, as what is seen from its side alone looks flat [-]."""
CALM: Final = 22.0 * DEGREE
"""Elevation that is best where nothing else matters [rad]."""


@dataclass(frozen=True, slots=True)
class Camera:
    """A direction to look from, orthographic: points are drawn at their places along two axes of the picture."""

    azimuth: float
    """Of the camera, seen from above, from x towards y [rad]."""
    elevation: float
    """Of the camera over the level [rad]."""
    up: tuple[float, float, float] = (0.0, 0.0, 1.0)
    """World direction that is up in the picture, against gravity."""
    axes: Floats = field(init=False, repr=False, compare=False)
    """Right, up and towards the camera, world frame, as rows."""

    def __post_init__(self) -> None:
        up = unit(self.up)
        east = np.array((1.0, 0.0, 0.0)) if abs(up[0]) < 0.9 else np.array((0.0, 1.0, 0.0))
        east = unit(east - float(east @ up) * up)
        north = np.cross(up, east)
        level = math.cos(self.azimuth) * east + math.sin(self.azimuth) * north
        right = math.cos(self.azimuth) * north - math.sin(self.azimuth) * east
        towards = math.cos(self.elevation) * level + math.sin(self.elevation) * up
        object.__setattr__(self, "axes", np.stack((right, np.cross(towards, right), towards)))

    def flat(self, points: Floats) -> Floats:
        """Where points are seen, in metres to the right and up, shape (..., 2).

        Args:
            points: World frame [m], shape (..., 3).
        """
        made: Floats = points @ self.axes[:2].T
        return made

    def depth(self, points: Floats) -> Floats:
        """How near to the camera points are [m], shape (...,)."""
        made: Floats = points @ self.axes[2]
        return made


def up_of(world: World) -> tuple[float, float, float]:
    """The direction against gravity; z where nothing falls."""
    size = math.sqrt(sum(part * part for part in world.gravity))
    if size < 1e-9:
        return 0.0, 0.0, 1.0
    x, y, z = (-part / size for part in world.gravity)
    return x, y, z


def camera_for(task: SpatialTask, asked: str | None) -> Camera:
    """The camera that is asked for: a name of `NAMES`, or "AZIMUTH,ELEVATION" in degrees; None: one from which the task reads well.

    Raises:
        SpecError: If it is no such text.
    """
    world = task.world
    if asked is None:
        return best_camera(world, *stretch(task))
    if asked in NAMES:
        return named_camera(world, asked)
    parts = asked.split(",")
    try:
        azimuth, elevation = (float(part) for part in parts)
    except ValueError:
        azimuth = elevation = math.nan
    if not (math.isfinite(azimuth) and abs(elevation) <= 90.0):
        told = f"{describe_choices(asked, NAMES)}, or AZIMUTH,ELEVATION in degrees, such as 30,20, elevation from -90 to 90"
        raise SpecError("camera", "camera", asked, f"must be {told}")
    return Camera(azimuth * DEGREE, elevation * DEGREE, up_of(world))


def named_camera(world: World, name: str) -> Camera:
    """A camera of `NAMES`: in front of the surface where the guide begins; of a floor or a ceiling, at the right of the guide."""
    up = np.array(up_of(world))
    _, across, normal = world.frames[0, 3:].reshape(3, 3)
    steep = abs(float(normal @ up)) > STEEP
    level = -across * math.copysign(1.0, float(normal @ up)) if steep else normal
    right, _, towards = Camera(0.0, 0.0, up_of(world)).axes
    azimuth = math.atan2(float(level @ right), float(level @ towards))
    turns: dict[str, tuple[float, float]] = {
        "front": (0.0, 10.0 * DEGREE),
        "left": (-ASIDE, 10.0 * DEGREE),
        "right": (ASIDE, 10.0 * DEGREE),
        "above": (0.0, 90.0 * DEGREE),
        "iso": (-45.0 * DEGREE, 35.3 * DEGREE),
    }
    aside, elevation = turns[name]
    return Camera(azimuth + aside, elevation, up_of(world))


def stretch(task: SpatialTask) -> tuple[float, float]:
    """From where to where along the guide a task leads: its start and the nearer edge of every goal [m]."""
    places = [task.start.along]
    for goal in task.goals:
        along_min, along_max = goal.box[:2]
        places.append(min(max(places[-1], along_min), along_max))
    return min(places), max(places)


def best_camera(world: World, first: float, last: float) -> Camera:
    """The camera, of a grid of them, that sees most of a stretch from outside its surfaces, its guide long and not through solids."""
    frames = np.array([frame_at(world.frames, along) for along in np.linspace(first, max(last, first + 0.1), 24)])
    places = world.places
    near = np.linalg.norm(places[:, None] - frames[None, :, :3], axis=2).min(axis=1) if len(places) else np.zeros(0)
    holds = world.normals[near < 0.5 * float(np.ptp(frames[:, :3], axis=0).max())] if len(places) else frames[:, 9:]
    holds = holds if len(holds) else frames[:, 9:]
    holds = holds[np.linspace(0, len(holds) - 1, min(len(holds), 150)).astype(int)]
    lines = frames[:, 3:6]
    reach = max(0.05, 0.02 * float(np.ptp(frames[:, :3], axis=0).max()))
    eyes = frames[:, :3] + reach * frames[:, 9:]
    seen = clear_of_solids(world, eyes)
    cameras = [Camera(azimuth, elevation, up_of(world)) for elevation in ELEVATIONS for azimuth in AZIMUTHS]
    return max(cameras, key=lambda camera: _score(camera, holds, lines, seen))


def _score(camera: Camera, normals: Floats, lines: Floats, seen: Callable[[Floats], float]) -> float:
    """How well a world is seen by a camera: surfaces from outside, the guide long, from the left to the right and upwards."""
    right, up, towards = camera.axes
    facing = normals @ towards
    good = np.where(
        facing > 0.0, np.minimum(facing, FACING) / FACING - np.maximum(facing - FACING, 0.0), BEHIND * facing
    )
    length = np.sqrt(np.maximum(0.0, 1.0 - (lines @ towards) ** 2)).mean()
    onward = math.tanh(4.0 * float((0.7 * lines @ up + lines @ right).mean()))
    calm = abs(camera.elevation - CALM)
    aslant = min(length, ASLANT) - 0.6 * max(length - ASLANT, 0.0)
    return float(good.mean() + 1.2 * aslant + 0.3 * onward - 0.35 * calm + 0.6 * seen(towards))
