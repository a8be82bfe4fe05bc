"""A walker and its ground, for the viewer."""

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final

import numpy as np

from ....types import Floats
from ....viewing.browser.scenery import FOV, NARROW, Camera
from ....viewing.scene import Bounds
from ..planning.task import Goal
from ..robot import WalkerRobot
from ..world.ground import Ground
from .ground_scene import GroundScene
from .walker_figure import WalkerFigure

if TYPE_CHECKING:
    import viser

FROM: Final = (-0.45, -1.0, 0.75)
"""From where the camera looks at the ground, over its distance [-]."""
ROOM: Final = 1.05
"""Around what is shown [-]."""
TALL: Final = 0.7
"""Height of a robot with its arm, or more [m]."""
BESIDE: Final = 0.5
"""Ground that is shown around a walk [m]."""


@dataclass(frozen=True, slots=True)
class WalkScenery:
    """A walker on a ground."""

    robot: WalkerRobot
    ground: Ground
    goals: tuple[Goal, ...]
    bounds: Bounds
    """The part of the ground that is shown."""
    way: Floats | None = None
    """Places that a walk's way leads along, seen from above, shape (n, 2) [m]; None: it is not known."""

    def with_bounds(self, bounds: Bounds) -> "WalkScenery":
        """See `Scenery`."""
        return replace(self, bounds=bounds)

    def world(self, server: "viser.ViserServer") -> GroundScene:
        """See `Scenery`."""
        return GroundScene(server, self.ground, self.goals, self.bounds, self.way)

    def figure(self, server: "viser.ViserServer", name: str, opacity: float = 1.0) -> WalkerFigure:
        """See `Scenery`."""
        return WalkerFigure(server, name, self.robot, opacity)

    def camera(self) -> Camera:
        """See `Scenery`: from above, aside."""
        x0, x1, y0, y1 = self.bounds
        middle = np.array((0.5 * (x0 + x1), 0.5 * (y0 + y1), 0.0))
        height = self.ground.heights(middle[:2])
        middle[2] = float(height) if np.isfinite(height) else 0.0
        back = np.array(FROM) / np.linalg.norm(FROM)
        ground = [(x, y, middle[2]) for x in (x0, x1) for y in (y0, y1)]
        robot = [(x, y, middle[2] + TALL) for x in (x0 + BESIDE, x1 - BESIDE) for y in (y0 + BESIDE, y1 - BESIDE)]
        far = ROOM * _distance(np.array(ground + robot) - middle, back)
        return Camera(middle + far * back, middle)


def _distance(points: Floats, back: Floats) -> float:
    """How far away a camera has to be to see all of some points, as wide as high a picture may be (`NARROW`) [m].

    Args:
        points: From where it looks at, shape (n, 3) [m].
        back: From there towards the camera, of length 1, shape (3,).
    """
    right = np.array((-back[1], back[0], 0.0)) / math.hypot(back[0], back[1])
    up = np.cross(back, right)
    half = math.tan(0.5 * FOV)
    needed = np.maximum(np.abs(points @ right) / NARROW, np.abs(points @ up)) / half + points @ back
    return float(needed.max())


def walk_bounds(centres: Floats) -> Bounds:
    """The part of a ground around places, shape (n, 2) [m]."""
    (x0, y0), (x1, y1) = centres.min(axis=0) - BESIDE, centres.max(axis=0) + BESIDE
    return float(x0), float(x1), float(y0), float(y1)
