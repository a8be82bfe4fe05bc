"""A ground while it is edited, and the part of the panel that does: steps, ditches, patches, where a walker starts and goes."""

import copy
import math
import threading
from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Final

import numpy as np
from scipy.spatial.transform import Rotation

from ....errors import SpecError
from ....tasks import task_from_document
from ....types import Floats, Json
from ....viewing import style
from ....viewing.browser.inputs import (
    Plane,
    PosePart,
    add_handle,
    by_hand,
    goal_about,
    middle,
    refusal,
    set_input,
)
from ....viewing.browser.panel_html import message_html
from ....viewing.browser.solids import colour
from ....viewing.scene import Bounds
from ..planning import Walk
from ..planning.task import WalkerTask
from ..planning.walks import walk_from_document
from ..world.ground import Block, Rectangle
from .walk_film import way_poses

if TYPE_CHECKING:
    import viser

LABEL: Final = "the edited ground"
STEP, DITCH, PATCH = "step", "ditch", "patch"
KINDS: Final = (STEP, DITCH, PATCH)
"""What can be added."""
AHEAD: Final = 0.5
"""Before the start is where something new is put, along the robot's heading [m]."""
NEW: Final[dict[str, tuple[float, float, float]]] = {
    STEP: (0.4, 0.8, 0.03),
    DITCH: (0.08, 0.8, -0.3),
    PATCH: (0.1, 0.1, 0.0),
}
"""Length, width and height of something new [m]."""
Piece = Block | Rectangle | tuple[tuple[float, float], ...]
"""A step or a ditch, or a patch: a rectangle, or the corners of a polygon."""


class GroundDraft:
    """A ground's pieces, the start and the goal of a task or a walk as they are now, whether or not they make one.

    Args:
        task: As it was.
    """

    def __init__(self, task: WalkerTask | Walk) -> None:
        self.task = task
        self.ground = task.ground if isinstance(task, Walk) else task.world
        self.undo()

    def undo(self) -> None:
        """Everything as the task has it."""
        self.pieces: list[Piece] = [*self.ground.blocks, *self.ground.patches]
        start = self.task.start
        angle = start.heading if isinstance(self.task, Walk) else start.theta  # type: ignore[union-attr]
        self.start = start.x, start.y, angle
        """Where the Delta-frame begins, and its heading [m], [rad]."""
        self._begins = self.start
        self.goal: tuple[float, float, float] | None = None
        """Where it is to go, likewise, where that was set; None: as the task says."""

    @property
    def changed(self) -> bool:
        """Whether anything is other than the task says."""
        as_it_was = [*self.ground.blocks, *self.ground.patches]
        return self.goal is not None or self.start != self._begins or self.pieces != as_it_was

    def names(self) -> tuple[str, ...]:
        """What the pieces are called, in their order."""
        return tuple(f"{self._kind(piece)} {k + 1}" for k, piece in enumerate(self.pieces))

    def box(self, k: int) -> tuple[float, float, float, float]:
        """x_min, x_max, y_min, y_max of a piece, in the ground's frame [m]."""
        piece = self.pieces[k]
        if isinstance(piece, Rectangle):
            return piece.x_min, piece.x_max, piece.y_min, piece.y_max
        corners = np.array(piece)
        (x0, y0), (x1, y1) = corners.min(axis=0).tolist(), corners.max(axis=0).tolist()
        return x0, x1, y0, y1

    def height(self, k: int) -> float:
        """Of a piece above the slope [m]; 0 for a patch."""
        piece = self.pieces[k]
        return piece.height if isinstance(piece, Block) else 0.0

    def move(self, k: int, dx: float, dy: float) -> None:
        """Push a piece along the ground [m]."""
        piece = self.pieces[k]
        if isinstance(piece, Rectangle):
            x0, x1, y0, y1 = self.box(k)
            self.reshape(k, (x0 + dx, x1 + dx, y0 + dy, y1 + dy), self.height(k))
        else:
            self.pieces[k] = tuple((x + dx, y + dy) for x, y in piece)

    def reshape(self, k: int, box: tuple[float, float, float, float], height: float) -> None:
        """Give a piece other ends [m]; a patch has no height, and a polygon is moved to where its ends fit best."""
        piece = self.pieces[k]
        if not isinstance(piece, Rectangle):
            x0, x1, y0, y1 = self.box(k)
            self.move(k, 0.5 * (box[0] + box[1] - x0 - x1), 0.5 * (box[2] + box[3] - y0 - y1))
            return
        x_min, x_max, y_min, y_max = map(float, box)
        made = replace(piece, x_min=x_min, x_max=x_max, y_min=y_min, y_max=y_max)
        self.pieces[k] = replace(made, height=float(height)) if isinstance(made, Block) else made

    def add(self, kind: str) -> int:
        """Something new before the start; its place among the pieces."""
        length, width, height = NEW[kind]
        x, y, angle = self.start
        here = self.ground.axes().T @ np.array((x + AHEAD * math.cos(angle), y + AHEAD * math.sin(angle), 0.0))
        x0, y0 = (round(float(part), 3) for part in (here[0], here[1] - 0.5 * width))
        ends = {"x_min": x0, "x_max": x0 + length, "y_min": y0, "y_max": y0 + width}
        self.pieces.append(Rectangle(**ends) if kind == PATCH else Block(**ends, height=height))
        return len(self.pieces) - 1

    def remove(self, k: int) -> None:
        """Take a piece away."""
        del self.pieces[k]

    def set_start(self, x: float, y: float, angle: float) -> None:
        """Let the robot begin at a place of the world [m] with a heading [rad]."""
        self.start = float(x), float(y), float(angle)

    def set_goal(self, x: float, y: float, angle: float) -> None:
        """Let it go to a place of the world [m] with a heading [rad]: of a task give or take a step, of a walk straight there."""
        self.goal = float(x), float(y), float(angle)

    def goal_pose(self) -> tuple[float, float, float]:
        """Where it is to go: as was set, or a place in the task's goal, or the end of the walk's way [m], [rad]."""
        if self.goal is not None:
            return self.goal
        if isinstance(self.task, Walk):
            x, y, angle = way_poses(self.task)[-1].tolist()
            return x, y, angle
        goal = self.task.goals[-1]
        low, high = goal.theta_min, goal.theta_max
        angle = self.start[2] if low is None or high is None else 0.5 * (low + high)
        x_min, x_max, y_min, y_max = goal.box
        return middle(x_min, x_max, self.start[0]), middle(y_min, y_max, self.start[1]), angle

    def document(self) -> Json:
        """The task or walk as its file would say it."""
        document = copy.deepcopy(self.task.document)
        blocks = [piece for piece in self.pieces if isinstance(piece, Block)]
        patches = [piece for piece in self.pieces if not isinstance(piece, Block)]
        document["ground"] |= {"blocks": [*map(_rectangle, blocks)], "patches": [*map(_rectangle, patches)]}
        document["labels"] = document.get("labels", {}) | {"ground": LABEL}
        walk = isinstance(self.task, Walk)
        if self.start != self._begins:
            x, y, angle = self.start
            place = {"x": f"{x!r} m", "y": f"{y!r} m", "heading" if walk else "theta": f"{angle!r} rad"}
            document["start"] = document.get("start", {}) | place
        if walk:
            for piece in document["way"]:
                piece.pop("path", None)  # its places have been read
        if self.goal is not None:
            document |= self._goal_document(self.goal, document)
        return document

    def _goal_document(self, goal: tuple[float, float, float], document: Json) -> Json:
        x, y, angle = goal
        if isinstance(self.task, Walk):
            return {"way": [{"to": [f"{x!r} m", f"{y!r} m"], "heading": f"{angle!r} rad"}]}
        turn = self.task.step.angle
        turns = {"theta_min": f"{angle - turn!r} rad", "theta_max": f"{angle + turn!r} rad"}
        return {"goal": goal_about(document["goal"], x, y, self.task.step.length) | turns}

    def build(self) -> WalkerTask | Walk:
        """The task or walk, if ground, start and goal make one.

        Raises:
            SpecError: If they do not: a rectangle that encloses nothing, a foot or a goal where there is no ground.
        """
        read = walk_from_document if isinstance(self.task, Walk) else task_from_document
        made = read(self.document(), LABEL)
        assert isinstance(made, Walk | WalkerTask)  # the robot stays what it is
        ground = made.ground if isinstance(made, Walk) else made.world
        for key, place in (("start", self.start), ("goal", self.goal)):
            if place is not None and not np.isfinite(ground.heights(place[:2])):
                at = f"x {place[0]:.3g} m, y {place[1]:.3g} m"
                raise SpecError(LABEL, key, at, "is where there is no ground")
        return made

    @staticmethod
    def _kind(piece: Piece) -> str:
        return PATCH if not isinstance(piece, Block) else DITCH if piece.height < 0.0 else STEP


def _rectangle(piece: Piece) -> Json | list[list[str]]:
    """A piece as a ground's file has it."""
    if not isinstance(piece, Rectangle):
        return [[f"{x!r} m", f"{y!r} m"] for x, y in piece]
    keys = ("x_min", "x_max", "y_min", "y_max", *(("height",) if isinstance(piece, Block) else ()))
    return {key: f"{getattr(piece, key)!r} m" for key in keys}


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
            hint = "Drag the picked piece, the start and the goal by their handles, and click"
            self._editing = gui.add_checkbox("edit on ground", False, hint=hint)
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
        self._handle = add_handle(server, "piece", HANDLE, (True, True, False), wxyz=wxyz)
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
        wrong = refusal(lambda: self._changed(self.draft.build()))
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
        if self._click.value == STARTS:
            self._set_start(x, y, self.draft.start[2])
        else:
            self._set_goal(x, y, self.draft.goal_pose()[2])

    def _pick_at(self, at: Floats) -> None:
        """Take the last piece into hand that lies at a place of the ground."""
        for k in reversed(range(len(self.draft.pieces))):
            x0, x1, y0, y1 = self.draft.box(k)
            if x0 <= at[0] <= x1 and y0 <= at[1] <= y1:
                self.pick(k)
                return
