"""The point that a walk's tool is held at: laid out from where the robot stands, and how far the tool truly was from it."""

from dataclasses import dataclass
from typing import Annotated

import numpy as np

from ....json_form import HIDDEN, INLINE, Jsonable, Key, in_json
from ....types import Floats
from ..control.track import Track
from ..execution.tool_hold import HeldPart, ToolHold
from ..execution.true_walk import TrueWalk
from ..execution.walker import Walker
from ..planning.walk import Hold
from ..robot.plane_poses import compose, seen_from


@dataclass(frozen=True, slots=True, eq=False)
class HeldPoint(Jsonable):
    """A point that the tool was to be held at, as it truly was."""

    part: Annotated[HeldPart, INLINE]
    """Where on the way, and what the robot believes."""
    point: Annotated[Floats, Key("true_point", kind=tuple[float, float, float])]
    """Where it was to be at first, world, as it truly lies [m], shape (3,)."""
    time: Annotated[Floats, HIDDEN]
    """Of the ticks at which it was held, shape (rows,) [s]."""
    errors: Annotated[Floats, HIDDEN]
    """Distance of the tool from where it was to be then, shape (rows,) [m]."""

    @in_json()
    def held_seconds(self) -> float:
        """For which it was held."""
        return float(self.time[-1] - self.time[0]) if len(self.time) else 0.0

    @property
    @in_json(key="largest_error")
    def largest(self) -> float | None:
        """Largest true distance of the tool from where it was to be while it was held [m]; None where the robot did not come so far."""
        return float(self.errors.max()) if len(self.errors) else None

    @in_json()
    def mean_error(self) -> float | None:
        """Mean of that distance [m]."""
        return float(self.errors.mean()) if len(self.errors) else None


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
