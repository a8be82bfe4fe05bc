"""The part of the viewer's panel that edits holds in space: by clicks, by a handle that moves and turns them, or by numbers."""

import threading
from collections.abc import Callable
from typing import TYPE_CHECKING, Final

import numpy as np

from ....types import Floats
from ....viewing.browser.inputs import by_hand, refusal, set_input
from ....viewing.browser.panel_html import message_html
from ....viewing.scene import length_unit
from ..planning.task import SpatialTask
from ..robot.bodies import rotation
from ..robot.kinematics import quaternions
from ..world.solids import frame_about, unit
from .hold_draft import HoldDraft
from .space import WorldScene

if TYPE_CHECKING:
    import viser

PICKS, ADDS, REMOVES = "picks a hold", "adds a hold", "removes a hold"
CLICKS: Final = (PICKS, ADDS, REMOVES)
"""What a click in the scene does."""
HANDLE: Final = 0.12
"""Size of the handle at a hold, over the world's size [-]."""
LARGEST: Final = 0.25
"""The same at most [m]."""


class HoldPanel:
    """Controls for the holds of a world.

    Args:
        server: Whose panel they are in; they are made where its context is.
        task: As it was.
        scene: Gives the world as it is drawn.
        changed: Takes a task that the edited world makes, and may refuse it by an error.
    """

    def __init__(
        self,
        server: "viser.ViserServer",
        task: SpatialTask,
        scene: Callable[[], WorldScene],
        changed: Callable[[SpatialTask], None],
    ) -> None:
        self.draft = HoldDraft(task)
        self._scene, self._changed = scene, changed
        self.unit, self.size = length_unit(task)  # of places as they are shown, and its size [m]
        gui = server.gui
        with gui.add_folder("Holds"):
            self._editing = gui.add_checkbox(
                "edit in the scene", False, hint="Drag and turn the picked hold by its handle, and click"
            )
            self._click = gui.add_dropdown("a click in the scene", CLICKS, initial_value=PICKS)
            self._number = gui.add_number("hold", 1, min=0, max=max(1, len(self.draft.holds)), step=1)
            self._place = gui.add_vector3(f"its place [{self.unit}]", (0.0, 0.0, 0.0), step=0.1)
            self._normal = gui.add_vector3("its normal", (0.0, 0.0, 1.0), step=0.05)
            self._buttons = gui.add_button_group("", ("add", "remove", "as it was"))
            self._words = gui.add_html("")
        lock = threading.RLock()  # the page's events come from many threads
        size = min(HANDLE * scene().size, LARGEST)
        self._gizmo = server.scene.add_transform_controls(
            "/hold handle", scale=size, depth_test=False, visible=False, line_width=3.0
        )
        self._editing.on_update(by_hand(lambda _: self.pick(self.picked()), lock))
        self._number.on_update(by_hand(lambda _: self.pick(self.picked()), lock))
        self._place.on_update(by_hand(lambda _: self._typed(), lock))
        self._normal.on_update(by_hand(lambda _: self._typed(), lock))
        self._buttons.on_click(by_hand(lambda event: self._pressed(event.target.value), lock))
        self._gizmo.on_update(by_hand(self._dragged, lock))
        server.scene.on_click()(by_hand(self._clicked, lock))
        self.pick(1 if self.draft.holds else None)

    def task(self) -> SpatialTask:
        """The task as it is now.

        Raises:
            ClamberError: If the holds make none.
        """
        return self.draft.build()

    def pick(self, number: int | None) -> None:
        """Take a hold into hand; None, or one that is not there: none."""
        if number is not None and not self.draft.has(number):
            number = None
        self._number.max = max(1, len(self.draft.holds))
        if self._number.value != (number or 0):
            set_input(self._number, number or 0)
        self._gizmo.visible = number is not None and self._editing.value
        if number is None:
            return
        hold = self.draft.holds[number - 1]
        self._show(np.array(hold.at), np.array(hold.normal))
        self._gizmo.position = hold.at
        self._gizmo.wxyz = tuple(quaternions(frame_about(unit(hold.normal)).T))

    def apply(self) -> None:
        """Draw the holds as they are now, and make a task of them; what is wrong is said below."""
        self._draw()
        wrong = refusal(lambda: self._changed(self.draft.build()))
        self._words.content = message_html(" ".join(wrong.values()), bad=True)

    def _draw(self) -> None:
        holds = self.draft.holds
        places = np.array([hold.at for hold in holds]).reshape(-1, 3)
        normals = np.array([unit(hold.normal) for hold in holds]).reshape(-1, 3)
        self._scene().draw_holds(places, normals, np.array([hold.radius for hold in holds]))

    def _show(self, place: Floats, normal: Floats) -> None:
        x, y, z = (round(float(value) / self.size, 3) + 0.0 for value in place)
        set_input(self._place, (x, y, z))
        x, y, z = (round(float(value), 3) + 0.0 for value in unit(normal))
        set_input(self._normal, (x, y, z))

    def picked(self) -> int | None:
        """The hold in hand."""
        number = int(self._number.value)
        return number if self.draft.has(number) else None

    def _typed(self) -> None:
        number = self.picked()
        if number is not None:
            self.draft.move(number, self.size * np.array(self._place.value))
            self.draft.turn(number, np.array(self._normal.value))
            self.pick(number)
            self.apply()

    def _pressed(self, word: str) -> None:
        number = self.picked()
        if word == "add":
            number = self.draft.add(*self.draft.beside(number), like=number)
        elif word == "remove" and number is not None:
            self.draft.remove(number)
            number = min(number, len(self.draft.holds)) or None
        elif word == "as it was":
            self.draft.undo()
        self.pick(number)
        self.apply()

    def _dragged(self, event: "viser.TransformControlsEvent") -> None:
        number = self.picked()
        if number is None:
            return
        place, wxyz = np.array(event.target.position), np.array(event.target.wxyz)
        normal = rotation(wxyz / np.linalg.norm(wxyz))[:, 2]
        self.draft.move(number, place)
        self.draft.turn(number, normal)
        self._show(place, normal)
        self._draw()
        if event.phase == "end":
            self.apply()

    def _clicked(self, event: "viser.SceneClickEvent") -> None:
        if not self._editing.value:
            return
        eye, towards = np.array(event.ray_origin), np.array(event.ray_direction)
        if self._click.value == ADDS:
            found = self.draft.met(eye, towards)
            if found is not None:
                self.pick(self.draft.add(*found, like=self.picked()))
                self.apply()
            return
        number = self.draft.picked(eye, towards)
        if number is None:
            return
        if self._click.value == PICKS:
            self.pick(number)
            return
        self.draft.remove(number)
        self.pick(min(number, len(self.draft.holds)) or None)
        self.apply()
