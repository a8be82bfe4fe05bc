"""What a family of robots brings to the viewer: its world in space, its figure, and where to look from."""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, Protocol

from ...types import Floats
from ..scene import Bounds

if TYPE_CHECKING:
    import viser


class Figure(Protocol):
    """A robot in space."""

    def show(self, at: Any, grade: int = 3) -> None:
        """Put everything where a moment has it, in the colours of a grade."""
        ...

    def hide(self, hidden: bool = True) -> None:
        """Take the figure out of sight, or bring it back."""
        ...

    def remove(self) -> None:
        """Take the figure away for good."""
        ...


class World(Protocol):
    """What stands still in a scene."""

    def remove(self) -> None:
        """Take all of it away."""
        ...


@dataclass(frozen=True, slots=True, eq=False)
class Camera:
    """Where to look from, in space [m]."""

    position: Floats
    look_at: Floats


class Scenery(Protocol):
    """A task's world and robot, ready to be put into a scene."""

    @property
    def bounds(self) -> Bounds:
        """The part of the world that is shown."""
        ...

    def with_bounds(self, bounds: Bounds) -> "Scenery":
        """The same with another part shown."""
        ...

    def world(self, server: "viser.ViserServer") -> World:
        """Put the world into the scene."""
        ...

    def figure(self, server: "viser.ViserServer", name: str, opacity: float = 1.0) -> Figure:
        """Put the robot into the scene."""
        ...

    def camera(self) -> Camera:
        """Where to look from at first."""
        ...


FOV: Final = math.radians(40.0)
"""Of the camera, from the bottom to the top of the picture [rad]."""

NARROW: Final = 0.9
"""Least width of a picture over its height that everything fits into [-]."""
