"""The point that a walk's tool is held at: laid out from where the robot stands, and how far the tool truly was from it."""

from dataclasses import dataclass

import numpy as np

from ...control.track import Track, compose, seen_from
from ...execution.walk.tool_hold import HeldPart, ToolHold
from ...execution.walk.true_walk import TrueWalk
from ...execution.walk.walker import Walker
from ...tasks.walks.walk import Hold
from ...types import Floats, Json


@dataclass(frozen=True, slots=True, eq=False)
class HeldPoint:
    """A point that the tool was to be held at, as it truly was."""

    part: HeldPart
    """Where on the way, and what the robot believes."""
    point: Floats
    """World, truly [m], shape (3,)."""
    time: Floats
    """Of the ticks at which it was held, shape (rows,) [s]."""
    errors: Floats
    """Distance of the tool from the point then, shape (rows,) [m]."""

    @property
    def largest(self) -> float | None:
        """Largest of the errors [m]; None where the robot did not come so far."""
        return float(self.errors.max()) if len(self.errors) else None

    def to_json(self) -> Json:
        """Plain data."""
        held = len(self.errors) > 0
        return self.part.to_json() | {
            "true_point": self.point.tolist(),
            "held_seconds": float(self.time[-1] - self.time[0]) if held else 0.0,
            "largest_error": self.largest,
            "mean_error": float(self.errors.mean()) if held else None,
        }


@dataclass(frozen=True, slots=True, eq=False)
class LaidHold:
    """A hold, and where its point truly is."""

    hold: ToolHold
    point: Floats
    """World, truly [m], shape (3,)."""

    def as_it_was(self, true: TrueWalk) -> HeldPoint:
        """What became of it."""
        part = self.hold.told()
        if part.began is None:
            return HeldPoint(part, self.point, np.empty(0), np.empty(0))
        until = np.inf if part.ended is None else part.ended
        # what is commanded at a tick is done at the next
        rows = (true.time > part.began) & (true.time <= until)
        return HeldPoint(part, self.point, true.time[rows], np.linalg.norm(true.tool[rows] - self.point, axis=1))


def lay_hold(walker: Walker, track: Track, hold: Hold) -> LaidHold:
    """A walk's point where the robot believes it, and where that truly is: the robot knows the point relative to itself, here and now.

    Raises:
        RefusedError: If the arm can hold it nowhere on the way.
    """
    true = walker.plant.truth()
    assert true is not None, "only simulated walks are measured"
    frame = np.array((walker.pose[0], walker.pose[1], walker.pose[3]))
    there = compose(frame, np.array((hold.x, hold.y, 0.0)))
    point = np.array((there[0], there[1], walker.heights[walker.stands > 0].mean() + hold.z))
    seen = seen_from(frame, np.array((point[0], point[1], 0.0)))
    truly = compose(true.pose[[0, 1, 3]], seen)
    at = np.array((truly[0], truly[1], true.pose[2] + point[2] - walker.pose[2]))
    return LaidHold(ToolHold(walker, track, point, hold.within), at)
