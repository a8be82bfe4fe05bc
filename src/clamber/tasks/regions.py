"""Regions of goals and worlds, whatever the family: boxes of places and ranges of angles, polygons."""

import math
from dataclasses import replace
from itertools import pairwise
from typing import Self

from pydantic import StrictStr

from ..files import Document
from ..specs import spec
from ..units import Angle, Length, Point, Polygon


@spec
class GoalBox:
    """Where the body is to be, world frame: all that is given must hold at once; boxes include their edges."""

    name: StrictStr = ""
    at: Point | None = None
    """In a file, short for a box of half a step each way about this point [m]."""
    x_min: Length | None = None
    """Least x of the body's origin [m]."""
    x_max: Length | None = None
    """Largest x of the body's origin [m]."""
    y_min: Length | None = None
    """Least y of the body's origin [m]."""
    y_max: Length | None = None
    """Largest y of the body's origin [m]."""
    theta_min: Angle | None = None
    """Least angle of the body [rad]."""
    theta_max: Angle | None = None
    """Largest angle of the body [rad]."""

    @property
    def box(self) -> tuple[float, float, float, float]:
        """x_min, x_max, y_min, y_max [m]; infinite where open."""
        low, high = -math.inf, math.inf
        return (
            low if self.x_min is None else self.x_min,
            high if self.x_max is None else self.x_max,
            low if self.y_min is None else self.y_min,
            high if self.y_max is None else self.y_max,
        )

    def middle(self, start: tuple[float, float]) -> tuple[float, float]:
        """The place that stands for it when ways from a start add up: nearest in open directions, the middle of closed ones [m]."""
        x_min, x_max, y_min, y_max = self.box
        place = []
        for lower, upper, at in ((x_min, x_max, start[0]), (y_min, y_max, start[1])):
            closed = math.isfinite(lower) and math.isfinite(upper)
            place.append(0.5 * (lower + upper) if closed else min(max(at, lower), upper))
        return place[0], place[1]

    def around_point(self, step: float) -> Self:
        """The goal with its point, if it has one, as a box of half a `step` [m] each way, cut with the box that it states besides."""
        if self.at is None:
            return self
        half, (x, y) = step / 2.0, self.at
        x_min, x_max, y_min, y_max = self.box
        return replace(
            self,
            x_min=max(x_min, x - half),
            x_max=min(x_max, x + half),
            y_min=max(y_min, y - half),
            y_max=min(y_max, y + half),
        )

    def check_ranges(self, key: str, document: Document) -> None:
        """Make sure that no range is empty, and that the angle's has both ends or neither.

        Raises:
            SpecError: Otherwise; `key` is where the document has the goal.
        """
        if (self.theta_min is None) != (self.theta_max is None):
            raise document.problem(key, "states theta_min and theta_max both or neither")
        check_order(self, key, ("x", "y", "theta"), document)


def check_order(box: object, key: str, axes: tuple[str, ...], document: Document) -> None:
    """Make sure that the least value of each axis, such as `x_min`, is at most the largest, where a box states both.

    Raises:
        SpecError: Otherwise; `key` is where the document has the box.
    """
    for axis in axes:
        low, high = getattr(box, f"{axis}_min"), getattr(box, f"{axis}_max")
        if low is not None and high is not None and low > high:
            raise document.problem(f"{key}.{axis}_min", f"must be at most {axis}_max")


def check_polygon(polygon: Polygon, document: Document, key: str) -> None:
    """Makes sure that a polygon encloses something.

    Raises:
        SpecError: If it has less than three corners or no area.
    """
    if len(polygon) < 3:
        raise document.problem(key, "a region needs at least three corners")
    (x0, y0), rest = polygon[0], polygon[1:]
    doubled = sum((x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0) for (x1, y1), (x2, y2) in pairwise(rest))
    if abs(doubled) < 1e-12:
        raise document.problem(key, "the corners must enclose an area")
