"""A ground while it is edited: pieces come, go and move, start and goal are set, and the task or walk of it is built."""

import copy
import math
from dataclasses import replace
from typing import Final

import numpy as np

from ....errors import SpecError
from ....tasks import task_from_document
from ....types import Json
from ..planning import Walk
from ..planning.task import WalkerTask
from ..planning.walks import walk_from_document
from ..world.ground import Block, Rectangle
from .way import way_poses

LABEL: Final = "the edited ground"
STEP, DITCH, PATCH = "step", "ditch", "patch"
KINDS: Final = (STEP, DITCH, PATCH)
"""What can be added."""
AHEAD: Final = 0.5
"""Before the start is where something new is put, along the robot's heading [m]."""
NEW: Final[dict[str, tuple[float, float, float]]] = {
    STEP: (0.4, 0.8, 0.03), DITCH: (0.08, 0.8, -0.3), PATCH: (0.1, 0.1, 0.0),
}  # fmt: skip
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
        return _middle(x_min, x_max, self.start[0]), _middle(y_min, y_max, self.start[1]), angle

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
        room, turn = self.task.step.length, self.task.step.angle
        ends = {"x_min": x - room, "x_max": x + room, "y_min": y - room, "y_max": y + room}
        turns = {"theta_min": angle - turn, "theta_max": angle + turn}
        named = {"name": document["goal"]["name"]} if document["goal"].get("name") else {}
        placed = {key: f"{value!r} m" for key, value in ends.items()}
        return {"goal": named | placed | {key: f"{value!r} rad" for key, value in turns.items()}}

    def build(self) -> WalkerTask | Walk:
        """The task or walk, if ground, start and goal make one.

        Raises:
            SpecError: If they do not: a rectangle that encloses nothing, a foot or a goal where there is no ground.
        """
        if isinstance(self.task, Walk):
            made: WalkerTask | Walk = walk_from_document(self.document(), LABEL)
        else:
            task = task_from_document(self.document(), LABEL)
            assert isinstance(task, WalkerTask)  # the robot stays what it is
            made = task
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


def _middle(low: float, high: float, usual: float) -> float:
    known = [end for end in (low, high) if math.isfinite(end)]
    return math.fsum(known) / len(known) if known else usual
