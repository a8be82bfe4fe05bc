"""A climber and its wall, for the viewer."""

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final

import numpy as np

from ....viewing.browser.scenery import FOV, NARROW, Camera
from ....viewing.scene import Bounds
from ..planning.task import LimbedTask
from .climber_figure import ClimberFigure
from .wall_scene import WallScene

if TYPE_CHECKING:
    import viser

ASIDE: Final = (-0.38, 0.12)
"""From where the camera looks at the wall: to the left and up, over its distance [-]."""
ROOM: Final = 1.2
"""Around what is shown [-]."""


@dataclass(frozen=True, slots=True)
class ClimbScenery:
    """A climber's task."""

    task: LimbedTask
    bounds: Bounds
    """The part of the wall that is shown."""

    def with_bounds(self, bounds: Bounds) -> "ClimbScenery":
        """See `Scenery`."""
        return replace(self, bounds=bounds)

    def world(self, server: "viser.ViserServer") -> WallScene:
        """See `Scenery`."""
        return WallScene(server, self.task, self.bounds)

    def figure(self, server: "viser.ViserServer", name: str, opacity: float = 1.0) -> ClimberFigure:
        """See `Scenery`."""
        return ClimberFigure(server, name, self.task, opacity)

    def camera(self) -> Camera:
        """See `Scenery`: in front of the wall, a little aside."""
        x0, x1, y0, y1 = self.bounds
        size = ROOM * max(y1 - y0, (x1 - x0) / NARROW)
        far = 0.5 * size / math.tan(0.5 * FOV)
        middle = np.array((0.5 * (x0 + x1), 0.0, 0.5 * (y0 + y1)))
        return Camera(middle + far * np.array((ASIDE[0], -1.0, ASIDE[1])) / math.hypot(1.0, *ASIDE), middle)


def join(first: Bounds, second: Bounds) -> Bounds:
    """The part of a wall that holds both parts."""
    return min(first[0], second[0]), max(first[1], second[1]), min(first[2], second[2]), max(first[3], second[3])
