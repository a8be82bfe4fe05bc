"""How climbers are drawn."""

from typing import Final

import numpy as np

from ....types import Floats
from ....viewing.pictures import Pictures
from ..planning.task import LimbedTask
from .climb_route import climb_route
from .climb_view import ClimbView, draw_climb
from .torques import torque_limits
from .wall import draw_scene


def wall_points(task: LimbedTask) -> Floats:
    """Holds and corners of regions to keep out of, world frame [m], shape (n, 2)."""
    return np.vstack([task.world.positions(), *(np.array(polygon) for polygon in task.world.keep_out)])


PICTURES: Final = Pictures(ClimbView, draw_climb, climb_route, wall_points, draw_scene, torque_limits)
