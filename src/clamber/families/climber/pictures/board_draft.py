"""A board while it is edited: pegs come, go and move, start and goal are set, and the task of it is built as any task is."""

import copy
import itertools
import math
from dataclasses import replace
from typing import Final

from ....tasks import task_from_document
from ....types import Json
from ..execution.here import GENERATORS, hold_document
from ..planning.task import FREE, LimbedTask
from ..world.board import Hold

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
            room = self.task.step.length
            (x, y), goal = self.goal, document["goal"]
            box = {"x_min": x - room, "x_max": x + room, "y_min": y - room, "y_max": y + room}
            named = {"name": goal["name"]} if goal.get("name") else {}
            document["goal"] = named | {key: f"{value!r} m" for key, value in box.items()}
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
