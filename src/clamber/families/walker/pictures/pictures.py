"""How walkers are drawn."""

from typing import Final

import numpy as np

from ....types import Floats
from ....viewing.pictures import Pictures
from ..planning.task import WalkerTask
from .walker_artists import draw_ground
from .walker_route import walker_route
from .walker_view import WalkerView, draw_walk


def start_point(task: WalkerTask) -> Floats:
    """Where the robot starts, world frame [m], shape (1, 2)."""
    return np.array([[task.start.x, task.start.y]])


PICTURES: Final = Pictures(WalkerView, draw_walk, walker_route, start_point, draw_ground)
