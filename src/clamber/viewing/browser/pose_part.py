"""A part of the panel that puts something at a place: its numbers, a handle in the scene, and what is wrong with it beside them."""

import math
from collections.abc import Callable
from contextlib import AbstractContextManager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from ...types import Floats
from ...units import DEGREE
from .inputs import by_hand, set_input
from .panel_html import message_html

if TYPE_CHECKING:
    import viser

FINE: Final = 1e-4
"""Places that are dragged are rounded to this [m]."""


@dataclass(frozen=True, slots=True)
class Plane:
    """Where places are in the scene, and how they are told."""

    unit: str
    """Of length, for people."""
    size: float
    """Of that unit [m]."""
    axes: tuple[bool, bool, bool]
    """Of the scene, along which a handle moves."""
    in_scene: Callable[[float, float], Floats]
    """Place [m] -> point of the scene, shape (3,)."""
    from_scene: Callable[[Floats], tuple[float, float]]
    """The other way round."""


class PosePart:
    """A place and an angle.

    Args:
        server: Whose panel it is in; the inputs are made where its context is.
        name: Of what is put there.
        labels: Of its place and its angle.
        plane: Of its places.
        handle: How large the handle is [m].
        lock: Held while something is moved: the page's events come from many threads.
        moved: Takes a new place [m] and angle [rad].
    """

    def __init__(
        self,
        server: "viser.ViserServer",
        name: str,
        labels: tuple[str, str],
        plane: Plane,
        handle: float,
        lock: AbstractContextManager[Any],
        moved: Callable[[float, float, float], None],
    ) -> None:
        self._plane, self._moved = plane, moved
        gui = server.gui
        self._place = gui.add_vector2(f"{labels[0]} [{plane.unit}]", (0.0, 0.0), step=0.25)
        self._angle = gui.add_number(f"{labels[1]} [°]", 0.0, step=1.0)
        self.handle = server.scene.add_transform_controls(
            f"/{name} handle", scale=handle, active_axes=plane.axes, disable_rotations=True, depth_test=False, visible=False,
            line_width=3.0,
        )  # fmt: skip
        self._words = gui.add_html("")
        self._place.on_update(by_hand(lambda _: self._typed(), lock))
        self._angle.on_update(by_hand(lambda _: self._typed(), lock))
        self.handle.on_update(by_hand(self._dragged, lock))

    def show(self, x: float, y: float, angle: float) -> None:
        """Show a place [m] and an angle [rad]."""
        set_input(self._place, (round(x / self._plane.size, 3), round(y / self._plane.size, 3)))
        set_input(self._angle, round(math.remainder(angle, math.tau) / DEGREE, 3) + 0.0)
        self.handle.position = tuple(self._plane.in_scene(x, y))

    def say(self, words: str) -> None:
        """Say what is wrong with it; nothing if it is well."""
        self._words.content = message_html(words, bad=True)

    def _typed(self) -> None:
        x, y = self._place.value
        self._moved(x * self._plane.size, y * self._plane.size, self._angle.value * DEGREE)

    def _dragged(self, event: "viser.TransformControlsEvent") -> None:
        x, y = (round(part / FINE) * FINE for part in self._plane.from_scene(np.array(event.target.position)))
        set_input(self._place, (round(x / self._plane.size, 3), round(y / self._plane.size, 3)))
        if event.phase == "end":
            self._moved(x, y, self._angle.value * DEGREE)
