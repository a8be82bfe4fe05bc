"""The part of the panel that edits a ground: its steps, ditches and patches, and where a walker starts and goes on it."""

import threading
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from scipy.spatial.transform import Rotation

from ....errors import ClamberError
from ....types import Floats
from ....viewing import style
from ....viewing.browser.inputs import about, by_hand, set_input
from ....viewing.browser.panel_html import message_html
from ....viewing.browser.pose_part import Plane, PosePart
from ....viewing.browser.solids import colour
from ....viewing.scene import Bounds
from ..planning import Walk
from ..planning.task import WalkerTask
from .ground_draft import KINDS, GroundDraft

if TYPE_CHECKING:
    import viser

PICKS, STARTS, GOES = "picks a piece", "sets the start", "sets the goal"
CLICKS: Final = (PICKS, STARTS, GOES)
"""What a click on the ground does."""
NOTHING: Final = "none"
UNIT: Final = ("cm", 0.01)
HANDLE: Final = 0.25
"""Size of handles [m]."""
THIN: Final = 0.004
"""Least height of the box about the picked piece [m]."""


class GroundPanel:
    """Controls for the pieces of a ground, the start and the goal.

    Args:
        server: Whose panel they are in; they are made where its context is.
        task: As it was.
        bounds: Gives the part of the ground that is shown.
        changed: Takes a task or walk that the edited ground makes, and may refuse it by an error.
    """

    def __init__(
        self,
        server: "viser.ViserServer",
        task: WalkerTask | Walk,
        bounds: Callable[[], Bounds],
        changed: Callable[[WalkerTask | Walk], None],
    ) -> None:
        self.draft = GroundDraft(task)
        self._bounds, self._changed, self._picked = bounds, changed, -1
        self._axes = self.draft.ground.axes()
        gui, lock = server.gui, threading.RLock()
        with gui.add_folder("Ground"):
            self._editing = gui.add_checkbox(
                "edit on ground",
                False,
                hint="Drag the picked piece, the start and the goal by their handles, and click",
            )
            self._click = gui.add_dropdown("a click there", CLICKS, initial_value=PICKS)
            self._piece = gui.add_dropdown("piece", (NOTHING,), initial_value=NOTHING)
            self._from = gui.add_vector2(f"from [{UNIT[0]}]", (0.0, 0.0), step=1.0)
            self._to = gui.add_vector2(f"to [{UNIT[0]}]", (0.0, 0.0), step=1.0)
            self._height = gui.add_number(f"height [{UNIT[0]}]", 0.0, step=0.5, hint="A ditch has one below 0")
            self._adds = gui.add_button_group("add", KINDS)
            self._buttons = gui.add_button_group("", ("remove", "as it was"))
            self._words = gui.add_html("")
        plane = Plane(*UNIT, (True, True, False), self._standing_on, lambda at: (float(at[0]), float(at[1])))
        with gui.add_folder("Start"):
            self.start = PosePart(server, "start", ("place", "heading"), plane, HANDLE, lock, self._set_start)
        with gui.add_folder("Goal"):
            self.goal = PosePart(server, "goal", ("place", "heading"), plane, HANDLE, lock, self._set_goal)
        wxyz = tuple(Rotation.from_matrix(self._axes).as_quat(scalar_first=True).tolist())
        self._handle = server.scene.add_transform_controls(
            "/piece handle", scale=HANDLE, active_axes=(True, True, False), disable_rotations=True, depth_test=False, visible=False,
            line_width=3.0, wxyz=wxyz,
        )  # fmt: skip
        self._box = server.scene.add_box(
            "/picked piece", color=colour(style.INK), wireframe=True, visible=False, wxyz=wxyz, cast_shadow=False
        )
        for handle, act in (
            (self._editing, lambda _: self.refresh()), (self._piece, lambda _: self._pick_named()), (self._from, lambda _: self._typed()),
            (self._to, lambda _: self._typed()), (self._height, lambda _: self._typed()), (self._handle, self._dragged),
        ):  # fmt: skip
            handle.on_update(by_hand(act, lock))
        self._adds.on_click(by_hand(lambda event: self._add(event.target.value), lock))
        self._buttons.on_click(by_hand(lambda event: self._pressed(event.target.value), lock))
        server.scene.on_click()(by_hand(self._clicked, lock))
        self.pick(0)

    def pick(self, k: int) -> None:
        """Take a piece into hand; -1: none."""
        self._picked = k if 0 <= k < len(self.draft.pieces) else -1
        self.refresh()

    def refresh(self) -> None:
        """Show the draft as it is now."""
        draft, k, on = self.draft, self._picked, bool(self._editing.value)
        names = draft.names()
        shown = names or (NOTHING,)
        if tuple(self._piece.options) != shown:
            self._piece.options = shown
        set_input(self._piece, names[k] if k >= 0 else shown[0])
        if k >= 0:
            x0, x1, y0, y1 = draft.box(k)
            for field, place in ((self._from, (x0, y0)), (self._to, (x1, y1))):
                set_input(field, tuple(round(part / UNIT[1], 3) for part in place))
            set_input(self._height, round(draft.height(k) / UNIT[1], 3))
            self._put_box(k)
        for handle in (self._handle, self._box):
            handle.visible = on and k >= 0
        self.start.show(*draft.start)
        self.goal.show(*draft.goal_pose())
        self.start.handle.visible = self.goal.handle.visible = on

    def apply(self) -> None:
        """Make a task or walk of the ground as it is now, and show it; what is wrong with it is said beside what it is about."""
        wrong: dict[str, str] = {}
        try:
            self._changed(self.draft.build())
        except ClamberError as error:
            wrong[about(error)] = str(error)
        self._words.content = message_html(wrong.get("world", ""), bad=True)
        self.start.say(wrong.get("start", ""))
        self.goal.say(wrong.get("goal", ""))
        self.refresh()

    def task(self) -> WalkerTask | Walk:
        """The task or walk as it is now.

        Raises:
            ClamberError: If ground, start and goal make none.
        """
        return self.draft.build()

    def _standing_on(self, x: float, y: float) -> Floats:
        height = float(self.draft.ground.heights((x, y)))
        return np.array((x, y, (height if np.isfinite(height) else 0.0) + 0.02))

    def _put_box(self, k: int) -> None:
        """The box about a piece, as far as it is shown, and the handle at its middle."""
        x0, x1, y0, y1 = self.draft.box(k)
        xa, xb, ya, yb = self._bounds()
        low, high = np.maximum((x0, y0), (xa, ya)), np.minimum((x1, y1), (xb, yb))
        if (low >= high).any():  # out of what is shown, or inside out
            low, high = np.minimum((x0, y0), (x1, y1)), np.maximum((x0, y0), (x1, y1))
        height = self.draft.height(k)
        middle = self._axes @ np.array((*(0.5 * (low + high)), 0.5 * height))
        self._box.dimensions = (*np.maximum(high - low, THIN).tolist(), max(abs(height), THIN))
        self._box.position = tuple(middle)
        self._handle.position = tuple(middle + self._axes[:, 2] * (0.5 * abs(height) + 0.02))
        self._handle_at = self._axes.T @ np.array(self._handle.position)

    def _set_start(self, x: float, y: float, angle: float) -> None:
        self.draft.set_start(x, y, angle)
        self.apply()

    def _set_goal(self, x: float, y: float, angle: float) -> None:
        self.draft.set_goal(x, y, angle)
        self.apply()

    def _pick_named(self) -> None:
        names = self.draft.names()
        self.pick(names.index(self._piece.value) if self._piece.value in names else -1)

    def _typed(self) -> None:
        if self._picked >= 0:
            (x0, y0), (x1, y1), size = self._from.value, self._to.value, UNIT[1]
            self.draft.reshape(self._picked, (x0 * size, x1 * size, y0 * size, y1 * size), self._height.value * size)
            self.apply()

    def _add(self, kind: str) -> None:
        self._picked = self.draft.add(kind)
        self.apply()

    def _pressed(self, word: str) -> None:
        if word == "as it was":
            self.draft.undo()
            self._picked = 0 if self.draft.pieces else -1
        elif self._picked >= 0:
            self.draft.remove(self._picked)
            self._picked = min(self._picked, len(self.draft.pieces) - 1)
        self.apply()

    def _dragged(self, event: "viser.TransformControlsEvent") -> None:
        if self._picked < 0:
            return
        way = self._axes.T @ np.array(event.target.position) - self._handle_at
        x0, x1, y0, y1 = self.draft.box(self._picked)
        middle = self._axes @ np.array((0.5 * (x0 + x1), 0.5 * (y0 + y1), 0.5 * self.draft.height(self._picked)))
        self._box.position = tuple(middle + self._axes @ np.array((way[0], way[1], 0.0)))
        if event.phase == "end":
            self.draft.move(self._picked, *(round(float(part), 4) for part in way[:2]))
            self.apply()

    def _clicked(self, event: "viser.SceneClickEvent") -> None:
        if not self._editing.value:
            return
        origin, way = self._axes.T @ np.array(event.ray_origin), self._axes.T @ np.array(event.ray_direction)
        if way[2] > -1e-6 or origin[2] <= 0.0:
            return
        at = origin - origin[2] / way[2] * way  # on the slope
        if self._click.value == PICKS:
            self._pick_at(at)
            return
        x, y = (round(float(part), 3) for part in (self._axes @ at)[:2])
        act, pose = (
            (self._set_start, self.draft.start)
            if self._click.value == STARTS
            else (self._set_goal, self.draft.goal_pose())
        )
        act(x, y, pose[2])

    def _pick_at(self, at: Floats) -> None:
        """Take the last piece into hand that lies at a place of the ground."""
        found: list[Any] = []
        for k in range(len(self.draft.pieces)):
            x0, x1, y0, y1 = self.draft.box(k)
            if x0 <= at[0] <= x1 and y0 <= at[1] <= y1:
                found.append(k)
        if found:
            self.pick(found[-1])
