"""Places that the tool goes through while the plate goes along a part of its way; one place is a point that it stays at."""

from dataclasses import dataclass

import numpy as np

from ....types import Floats


@dataclass(frozen=True, slots=True, eq=False)
class ToolLine:
    """Straight pieces, evenly with the plate's way: the tool waits while the plate stands, and slides along with it."""

    points: Floats
    """World, shape (n, 3) [m]."""
    first: float
    """Way of the plate at which the tool is at the first of them [m] ..."""
    last: float
    """... and at the last."""

    def at(self, way: float) -> Floats:
        """Where the tool is to be when the plate has come so far [m], shape (3,) [m]."""
        whole = self.last - self.first
        return along(self.points, min(1.0, max(0.0, (way - self.first) / whole)) if whole > 0.0 else 0.0)


def along(points: Floats, share: float) -> Floats:
    """The place at a share of the length of straight pieces through points, shape (3,) [m]."""
    ends = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    return np.array([np.interp(share * ends[-1], ends, column) for column in points.T])
