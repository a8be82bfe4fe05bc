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
    """World, truly [m], shape (3,): where it was to be at first."""
    time: Floats
    """Of the ticks at which it was held, shape (rows,) [s]."""
    errors: Floats
    """Distance of the tool from where it was to be then, shape (rows,) [m]."""

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
    believed: Floats
    """Of the plate where the way begins: x, y, heading, height, shape (4,) [m], [rad] ..."""
    true: Floats
    """... and as it truly was: what the robot is to reach lies relative to it."""

    def truly(self, points: Floats) -> Floats:
        """Where points that the robot believes somewhere truly are, shape (n, 3) [m]."""
        flat = [compose(self.true[:3], seen_from(self.believed[:3], np.array((x, y, 0.0))))[:2] for x, y, _ in points]
        return np.column_stack([np.reshape(flat, (-1, 2)), points[:, 2] + (self.true[3] - self.believed[3])])

    def as_it_was(self, true: TrueWalk) -> HeldPoint:
        """What became of it."""
        part, point = self.hold.told(), self.truly(self.hold.line.points[:1])[0]
        if part.began is None:
            return HeldPoint(part, point, np.empty(0), np.empty(0))
        until = np.inf if part.ended is None else part.ended
        # what is commanded at a tick is done at the next
        rows = (true.time > part.began) & (true.time <= until)
        time, wanted = self.hold.wanted()
        before = np.maximum(0, np.searchsorted(time, true.time[rows] - 1e-6) - 1)
        errors = np.linalg.norm(true.tool[rows] - self.truly(wanted)[before], axis=1)
        return HeldPoint(part, point, true.time[rows], errors)


def lay_hold(walker: Walker, track: Track, hold: Hold) -> LaidHold:
    """A walk's point where the robot believes it, and where that truly is: the robot knows the point relative to itself, here and now.

    Raises:
        RefusedError: If the arm can hold it nowhere on the way.
    """
    true = walker.plant.truth()
    assert true is not None, "only simulated walks are measured"
    frame = walker.pose[[0, 1, 3]]
    floor = walker.heights[walker.stands > 0].mean()
    places = hold.points()
    flat = [compose(frame, np.array((x, y, 0.0)))[:2] for x, y, _ in places]
    points = np.column_stack([flat, floor + places[:, 2]])
    believed, truly = walker.pose[[0, 1, 3, 2]], true.pose[[0, 1, 3, 2]]
    return LaidHold(ToolHold(walker, track, points, hold.within, hold.served), believed, truly)
