"""A board while it is edited, and the part of the panel that does: pegs, start and goal are dragged on the wall, or typed."""

import copy
import itertools
import math
import threading
from collections.abc import Callable
from contextlib import AbstractContextManager
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from ....tasks import task_from_document
from ....types import Floats, Json
from ....viewing.browser.inputs import (
    FINE,
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
from ....viewing.scene import length_unit
from ..execution.remaining_task import GENERATORS, hold_document
from ..planning.task import FREE, LimbedTask
from ..world.board import Hold
from .space import WallScene, in_space, on_wall

if TYPE_CHECKING:
    import viser

STEP: Final = 0.0762
"""How far beside its neighbour a new peg is first tried [m]: three inches, as on the thesis's boards."""
LABEL: Final = "the edited board"


class BoardDraft:
    """The pegs, the start and the goal of a task as they are now, whether or not they make a task.

    Args:
        task: As it was.
    """

    def __init__(self, task: LimbedTask) -> None:
        self.task = task
        self._start(task)

    def _start(self, task: LimbedTask) -> None:
        self.pegs: dict[int, Hold] = {hold.number: hold for hold in task.world.holds}
        self.goal: tuple[float, float] | None = None
        """Where the body is to go, where that was set [m]; None: as the task says."""
        self.start = task.start
        """Where the robot begins."""
        self._template = task.world.holds[0]

    def undo(self) -> None:
        """Pegs, start and goal as the task has them."""
        self._start(self.task)

    @property
    def changed(self) -> bool:
        """Whether anything is other than the task says."""
        moved = tuple(self.pegs.values()) != self.task.world.holds
        return moved or self.goal is not None or self.start is not self.task.start

    def move(self, number: int, x: float, y: float) -> None:
        """Put a peg at a place of the wall [m]; one that is not there stays away."""
        if number in self.pegs:
            self.pegs[number] = replace(self.pegs[number], x=float(x), y=float(y))

    def add(self, x: float, y: float) -> int:
        """A new peg like the board's first at a place of the wall [m]; its number."""
        number = max(self.pegs, default=0) + 1
        self.pegs[number] = replace(self._template, number=number, x=float(x), y=float(y))
        return number

    def room_beside(self, number: int | None) -> tuple[float, float]:
        """A place near a peg where another has room [m]."""
        beside = self.pegs.get(number) if number is not None else None
        x, y = (self._template.x, self._template.y) if beside is None else (beside.x, beside.y)
        for ring, (across, up) in itertools.product(range(1, 100), ((0, 1), (1, 0), (-1, 0), (0, -1), (1, 1))):
            at = x + ring * across * STEP, y + ring * up * STEP
            if all(math.dist(at, (hold.x, hold.y)) > 4.0 * hold.radius for hold in self.pegs.values()):
                return at
        return x, y

    def remove(self, number: int) -> None:
        """Take a peg away; one that is not there stays away."""
        self.pegs.pop(number, None)

    def set_goal(self, x: float, y: float) -> None:
        """Let the body go to a place of the wall, give or take a step of the task [m]."""
        self.goal = float(x), float(y)

    def set_start(self, x: float, y: float, angle: float) -> None:
        """Let the body begin at a place of the wall [m], turned by an angle [rad]."""
        self.start = replace(self.start, x=float(x), y=float(y), theta=float(angle))

    def hold(self, limb: str, number: int) -> None:
        """Let a limb begin on a peg, or free with 0."""
        self.start = replace(self.start, holds={**self.start.holds, limb: int(number)})

    def document(self) -> Json:
        """The task as its file would say it."""
        document = copy.deepcopy(self.task.document)
        board = {key: value for key, value in document["board"].items() if key not in GENERATORS}
        holds = [hold_document(hold, hold.direction, hold.cone) for _, hold in sorted(self.pegs.items())]
        document["board"] = board | {"holds": holds}
        document["labels"] = document.get("labels", {}) | {"board": LABEL}
        if self.start is not self.task.start:
            document["start"] = self._start_document(document["start"])
        if self.goal is not None:
            document["goal"] = goal_about(document["goal"], *self.goal, self.task.step.length)
        return document

    def _start_document(self, before: Json) -> Json:
        """The start as a task's file has it; what it said of limbs that hold, or of where the place comes from, is left out."""
        start = self.start
        kept = {key: value for key, value in before.items() if key not in ("between", "feet", "in_use")}
        feet = {limb: at for limb, at in before.get("feet", {}).items() if start.holds.get(limb, FREE) == FREE}
        in_use = before.get("in_use")
        kept |= {"feet": feet} if feet else {}
        kept |= {"in_use": in_use} if in_use is not None and start.holds.get(in_use, FREE) != FREE else {}
        place = {"x": f"{start.x!r} m", "y": f"{start.y!r} m", "theta": f"{start.theta!r} rad"}
        return kept | place | {"holds": dict(start.holds)}

    def build(self) -> LimbedTask:
        """The task, if pegs and goal make one.

        Raises:
            SpecError: If they do not: no pegs, pegs that overlap, a start on a peg that is gone, a goal far from all.
        """
        task = task_from_document(self.document(), LABEL)
        assert isinstance(task, LimbedTask)  # the robot stays what it is
        return task


NOWHERE: Final = "free"
HANDLE: Final = 0.14
"""Size of the handle at the body [m]."""


class StartPanel:
    """Controls for the start of a task.

    Args:
        server: Whose panel they are in; they are made where its context is.
        draft: What they change.
        depth: How far in front of the wall the handle is [m].
        lock: See `PosePart`.
        changed: Is called once the draft has another start.
    """

    def __init__(
        self,
        server: "viser.ViserServer",
        draft: BoardDraft,
        depth: Callable[[], float],
        lock: AbstractContextManager[Any],
        changed: Callable[[], None],
    ) -> None:
        self._draft, self._changed = draft, changed
        task: LimbedTask = draft.task
        plane = Plane(
            *length_unit(task), (True, False, True), lambda x, y: in_space(np.array((x, y)), depth()), lambda at: on_wall(at)
        )  # fmt: skip
        with server.gui.add_folder("Start"):
            self.limbs = {
                limb: server.gui.add_dropdown(f"{limb} is on", self._options(), initial_value=NOWHERE)
                for limb in task.robot.limb_names
            }
            self.body = PosePart(server, "start", ("body", "turned by"), plane, HANDLE, lock, self._moved)
        for limb, chosen in self.limbs.items():
            chosen.on_update(by_hand(self._taker(limb), lock))
        self.refresh()

    def refresh(self) -> None:
        """Show the draft's start, and offer the pegs that there are."""
        start, options = self._draft.start, self._options()
        for limb, chosen in self.limbs.items():
            held = start.holds.get(limb, FREE)
            name = NOWHERE if held == FREE else str(held)
            shown = options if name in options else (name, *options)  # a peg that is gone
            if tuple(chosen.options) != shown:
                chosen.options = shown
            if chosen.value != name:
                set_input(chosen, name)
        self.body.show(start.x, start.y, start.theta)

    def _options(self) -> tuple[str, ...]:
        return (NOWHERE, *(str(number) for number in sorted(self._draft.pegs)))

    def _moved(self, x: float, y: float, angle: float) -> None:
        self._draft.set_start(x, y, angle)
        self.refresh()
        self._changed()

    def _taker(self, limb: str) -> Callable[[Any], None]:
        def take(_: Any) -> None:
            name = self.limbs[limb].value
            self._draft.hold(limb, FREE if name == NOWHERE else int(name))
            self._changed()

        return take


NOTHING, ADDS, REMOVES, STARTS, GOES = "picks a peg", "adds a peg", "removes a peg", "sets the start", "sets the goal"
CLICKS: Final = (NOTHING, ADDS, REMOVES, STARTS, GOES)
"""What a click on the wall does."""
NO_PEG: Final = "none"


class BoardPanel:
    """Controls for the pegs of a board, the start and the goal.

    Args:
        server: Whose panel they are in; they are made where its context is.
        task: As it was.
        scene: Gives the wall as it is drawn.
        changed: Takes a task that the edited board makes, and may refuse it by an error.
    """

    def __init__(
        self,
        server: "viser.ViserServer",
        task: LimbedTask,
        scene: Callable[[], WallScene],
        changed: Callable[[LimbedTask], None],
    ) -> None:
        self.draft = BoardDraft(task)
        self._server, self._scene, self._changed = server, scene, changed
        self._unit, self._size = length_unit(task)
        gui = server.gui
        with gui.add_folder("Board"):
            self._editing = gui.add_checkbox(
                "edit on the wall", False, hint="Drag the picked peg and the body by their handles, and click"
            )
            self._click = gui.add_dropdown("a click on the wall", CLICKS, initial_value=NOTHING)
            self._peg = gui.add_dropdown("peg", self._names(), initial_value=self._names()[0])
            self._place = gui.add_vector2(f"its place [{self._unit}]", (0.0, 0.0), step=0.25)
            self._buttons = gui.add_button_group("", ("add", "remove", "as it was"))
            self._peg_words = gui.add_html("")
        lock = threading.RLock()  # the page's events come from many threads
        self.start = StartPanel(server, self.draft, lambda: self._scene().depth, lock, self.apply)
        with gui.add_folder("Goal"):
            self._goal = gui.add_vector2(f"goal [{self._unit}]", self._shown(*self._goal_place()), step=0.25)
            self._goal_words = gui.add_html("")
        self._gizmo = add_handle(server, "peg", 0.09, (True, False, True))
        self._editing.on_update(by_hand(lambda _: self.pick(self._picked()), lock))
        self._peg.on_update(by_hand(lambda _: self.pick(self._picked()), lock))
        self._place.on_update(by_hand(lambda _: self._typed_place(), lock))
        self._goal.on_update(by_hand(lambda _: self._typed_goal(), lock))
        self._buttons.on_click(by_hand(lambda event: self._pressed(event.target.value), lock))
        self._gizmo.on_update(by_hand(self._dragged, lock))
        server.scene.on_click()(by_hand(self._clicked, lock))
        self.pick(self._picked())

    def pick(self, number: int | None) -> None:
        """Take a peg into hand; None: none."""
        names = self._names()
        if tuple(self._peg.options) != names:
            self._peg.options = names
        if number is not None and number not in self.draft.pegs:
            number = None
        name = NO_PEG if number is None else str(number)
        if self._peg.value != name:
            set_input(self._peg, name)
        self._gizmo.visible = number is not None and self._editing.value
        self.start.body.handle.visible = self._editing.value
        if number is not None:
            peg = self.draft.pegs[number]
            set_input(self._place, self._shown(peg.x, peg.y))
            self._gizmo.position = tuple(in_space(np.array((peg.x, peg.y)), self._scene().depth))

    def apply(self) -> None:
        """Draw the board as it is now, and make a task of it; what is wrong with it is said beside what it is about."""
        scene = self._scene()
        scene.draw_pegs(tuple(self.draft.pegs.values()))
        self.start.refresh()
        wrong = refusal(lambda: self._changed(self.draft.build()))
        self._peg_words.content = message_html(wrong.get("world", ""), bad=True)
        self.start.body.say(wrong.get("start", ""))
        self._goal_words.content = message_html(wrong.get("goal", ""), bad=True)

    def task(self) -> LimbedTask:
        """The task as it is now.

        Raises:
            ClamberError: If pegs and goal make none.
        """
        return self.draft.build()

    def _names(self) -> tuple[str, ...]:
        return tuple(str(number) for number in sorted(self.draft.pegs)) or (NO_PEG,)

    def _picked(self) -> int | None:
        return int(self._peg.value) if self._peg.value != NO_PEG else None

    def _shown(self, x: float, y: float) -> tuple[float, float]:
        return round(x / self._size, 3), round(y / self._size, 3)

    def _goal_place(self) -> tuple[float, float]:
        """A place in the goal's box, for a start."""
        x_min, x_max, y_min, y_max = self.draft.task.goals[-1].box
        places = self.draft.task.world.positions()
        x, y = places.mean(axis=0).tolist()
        return middle(x_min, x_max, x), middle(y_min, y_max, y)

    def _typed_place(self) -> None:
        number = self._picked()
        if number is not None:
            x, y = self._place.value
            self.draft.move(number, x * self._size, y * self._size)
            self.pick(number)
            self.apply()

    def _typed_goal(self) -> None:
        x, y = self._goal.value
        self.draft.set_goal(x * self._size, y * self._size)
        self.apply()

    def _pressed(self, word: str) -> None:
        number = self._picked()
        if word == "add":
            number = self.draft.add(*self.draft.room_beside(number))
        elif word == "remove" and number is not None:
            self.draft.remove(number)
            number = min(self.draft.pegs, default=None)
        elif word == "as it was":
            self.draft.undo()
            set_input(self._goal, self._shown(*self._goal_place()))
        self.pick(number)
        self.apply()

    def _dragged(self, event: "viser.TransformControlsEvent") -> None:
        number = self._picked()
        if number is None:
            return
        x, y = (round(part / FINE) * FINE for part in on_wall(event.target.position))
        self.draft.move(number, x, y)
        set_input(self._place, self._shown(x, y))
        self._scene().draw_pegs(tuple(self.draft.pegs.values()))
        if event.phase == "end":
            self.apply()

    def _clicked(self, event: "viser.SceneClickEvent") -> None:
        if not self._editing.value:
            return
        origin, way = np.array(event.ray_origin), np.array(event.ray_direction)
        if abs(way[1]) < 1e-6 or -origin[1] / way[1] <= 0.0:
            return
        tips, wall = (
            np.array(on_wall(origin + (-depth - origin[1]) / way[1] * way)) for depth in (self._scene().depth, 0.0)
        )
        x, y = (round(part / FINE) * FINE for part in wall.tolist())
        if self._click.value == ADDS:
            self.pick(self.draft.add(x, y))
        elif self._click.value == STARTS:
            self.draft.set_start(x, y, self.draft.start.theta)
        elif self._click.value == GOES:
            self.draft.set_goal(x, y)
            set_input(self._goal, self._shown(x, y))
        else:
            number = self._nearest(tips, wall)
            if number is None:
                return
            if self._click.value == NOTHING:
                self.pick(number)
                return
            self.draft.remove(number)
            self.pick(None if not self.draft.pegs else min(self.draft.pegs))
        self.apply()

    def _nearest(self, tips: Floats, wall: Floats) -> int | None:
        """The peg that is seen nearest to a line of sight, if it is close.

        Args:
            tips: Where the line goes through the plane of the pegs' ends, shape (2,) [m].
            wall: Where it meets the wall, shape (2,) [m].
        """
        pegs = self.draft.pegs
        away = {number: _distance(np.array((peg.x, peg.y)), tips, wall) for number, peg in pegs.items()}
        number = min(away, key=lambda number: away[number], default=None)
        return number if number is not None and away[number] < 0.03 + pegs[number].radius else None


def _distance(point: Floats, start: Floats, end: Floats) -> float:
    """From a point to a stretch of a line, shape (2,) each [m]."""
    along = end - start
    share = float(np.clip((point - start) @ along / max(float(along @ along), 1e-18), 0.0, 1.0))
    return float(np.linalg.norm(point - start - share * along))
