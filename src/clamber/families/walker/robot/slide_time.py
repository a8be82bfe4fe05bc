"""How long a slide takes, the actuators as fast as they are and nothing else in the way."""

import numpy as np
import numpy.typing as npt

from ....types import Floats
from .geometry import TwoFrames

PIECES = 400


def slide_seconds(frames: TwoFrames, speed: float, start: npt.ArrayLike, end: npt.ArrayLike) -> float:
    """Least time of a straight slide, which may turn evenly on its way: at every place the busiest actuator runs at full speed [s].

    Starting and stopping take no time here.

    Args:
        frames: The mechanism.
        speed: Of the actuators [m/s].
        start, end: Poses of the Y-frame in the Delta-frame, shape (3,) [m], [rad].
    """
    begin = np.asarray(start, np.float64)
    change = np.asarray(end, np.float64) - begin
    lengths: Floats = np.array([frames.lengths(begin + share * change) for share in np.linspace(0.0, 1.0, PIECES + 1)])
    return float(abs(np.diff(lengths, axis=0)).max(axis=1).sum() / speed)
