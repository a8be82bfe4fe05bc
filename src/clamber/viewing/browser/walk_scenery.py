"""A walker and its ground, for the viewer."""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from ...robots.walker import WalkerRobot
from ...tasks.walker import Goal
from ...types import Floats
from ...worlds.ground import Ground
from ..scene import Bounds
from .climb_scenery import FOV, ROOM
from .ground_scene import GroundScene
from .scenery import Camera
from .walker_figure import WalkerFigure

if TYPE_CHECKING:
    import viser

FROM: Final = (-0.45, -1.0, 0.75)
"""From where the camera looks at the ground, over its distance [-]."""
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

    def world(self, server: "viser.ViserServer") -> GroundScene:
        """See `Scenery`."""
        return GroundScene(server, self.ground, self.goals, self.bounds)

    def figure(self, server: "viser.ViserServer", name: str, opacity: float = 1.0) -> WalkerFigure:
        """See `Scenery`."""
        return WalkerFigure(server, name, self.robot, opacity)

    def camera(self) -> Camera:
        """See `Scenery`: from above, aside."""
        x0, x1, y0, y1 = self.bounds
        middle = np.array((0.5 * (x0 + x1), 0.5 * (y0 + y1), 0.0))
        height = self.ground.heights(middle[:2])
        middle[2] = float(height) if np.isfinite(height) else 0.0
        far = 0.74 * ROOM * math.hypot(x1 - x0, y1 - y0) / (2.0 * math.tan(0.5 * FOV))
        ahead = np.array(FROM) / np.linalg.norm(FROM)
        return Camera(middle + far * ahead, middle)


def walk_bounds(centres: Floats) -> Bounds:
    """The part of a ground around places, shape (n, 2) [m]."""
    (x0, y0), (x1, y1) = centres.min(axis=0) - BESIDE, centres.max(axis=0) + BESIDE
    return float(x0), float(x1), float(y0), float(y1)
