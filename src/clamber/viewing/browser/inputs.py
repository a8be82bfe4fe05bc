"""Inputs of the panel: set by the viewer, or by whoever looks at it; such as put something at a place, by numbers or a handle."""

import math
from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from ...errors import ClamberError, SpecError, StartError
from ...types import Floats, Json
from ...units import DEGREE, split_quantity
from .panel_html import message_html

if TYPE_CHECKING:
    import viser


def set_input(handle: Any, value: Any) -> None:
    """Set what an input shows; nothing that listens to whoever looks at the page hears of it."""
    handle.value = value  # its type says that it can only be read


def by_hand(act: Callable[[Any], None], lock: AbstractContextManager[Any] | None = None) -> Callable[[Any], None]:
    """What is to happen when an input is changed on the page, and not when the viewer sets it; one after the other under a lock."""

    def heard(event: Any) -> None:
        if event.client is not None:
            with nullcontext() if lock is None else lock:
                act(event)

    return heard


def readable(said: Any) -> Any:
    """A document whose lengths and angles are rounded to 1e-9, so that three inches are saved as 0.0762 m and no 0.07619999999999999 m."""
    if isinstance(said, dict):
        return {key: readable(value) for key, value in said.items()}
    if isinstance(said, list | tuple):
        return [readable(value) for value in said]
    parts = split_quantity(said) if isinstance(said, str) and said.endswith((" m", " rad")) else None
    return said if parts is None or parts[1] not in ("m", "rad") else f"{round(parts[0], 9) + 0.0!r} {parts[1]}"


def about(error: Exception) -> str:
    """What an error is about: "start", "goal", or "world", the board or the ground."""
    if isinstance(error, StartError):
        return "start"
    key = str(error.key).split(".")[0] if isinstance(error, SpecError) else ""
    return "start" if key == "start" else "goal" if key in ("goal", "subgoals", "way") else "world"


def refusal(act: Callable[[], Any]) -> dict[str, str]:
    """What an error that something raises is about -> what it says; empty where it raises none."""
    try:
        act()
    except ClamberError as error:
        return {about(error): str(error)}
    return {}


def add_handle(
    server: "viser.ViserServer", name: str, size: float, axes: tuple[bool, bool, bool], **place: Any
) -> "viser.TransformControlsHandle":
    """A handle in the scene, out of sight at first, that is dragged along some of its axes."""
    return server.scene.add_transform_controls(
        f"/{name} handle", scale=size, active_axes=axes, disable_rotations=True, depth_test=False, visible=False,
        line_width=3.0, **place,
    )  # fmt: skip


def middle(low: float, high: float, usual: float) -> float:
    """Half-way between two ends; one that is infinite does not count, without either it is as usual."""
    known = [end for end in (low, high) if math.isfinite(end)]
    return math.fsum(known) / len(known) if known else usual


def goal_about(goal: Json, x: float, y: float, room: float) -> Json:
    """A goal of the same name whose box reaches so far about a place [m], as a task's file has it."""
    box = {"x_min": x - room, "x_max": x + room, "y_min": y - room, "y_max": y + room}
    named = {"name": goal["name"]} if goal.get("name") else {}
    return named | {key: f"{value!r} m" for key, value in box.items()}


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
        self.handle = add_handle(server, name, handle, plane.axes)
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
