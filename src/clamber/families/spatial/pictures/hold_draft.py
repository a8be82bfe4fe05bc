"""The holds of a world in space while they are edited: added, moved, turned, removed, and what a line of sight meets."""

import copy
from dataclasses import replace
from typing import Final

import numpy as np

from ....tasks import task_from_document
from ....types import Floats, Json
from ..planning.task import SpatialTask
from ..world.solids import frame_about, unit
from ..world.terrain_kernels import terrain_distance
from ..world.world import MOST_HOLDS, Hold

LABEL: Final = "the edited world"
GENERATORS: Final = ("patterns", "table")
"""Keys of a world that make holds; what they made is listed instead."""
CLOSE: Final = 2.5
"""A line of sight picks a hold that it passes by within so many of its radii [-]."""
LEAST: Final = 0.02
"""The same at least [m]."""
MARCHED: Final = 200
"""Steps along a line of sight towards a solid, at most."""
NEAR: Final = 1e-4
"""A line that is so near to a solid meets it [m]."""
FARTHEST: Final = 100.0
"""Of what a line of sight meets [m]."""
FINE: Final = 1e-4
"""Places are rounded to this [m]."""


class HoldDraft:
    """The holds of a task's world as they are now, whether or not they make a task; hold n is the n-th.

    Args:
        task: As it was.
    """

    def __init__(self, task: SpatialTask) -> None:
        self.task = task
        self.undo()

    def undo(self) -> None:
        """Holds as the task has them."""
        self.holds: list[Hold] = list(self.task.world.holds)
        self._renamed = {hold.number: hold.number for hold in self.holds}

    @property
    def changed(self) -> bool:
        """Whether any hold is other than the task says."""
        return tuple(self.holds) != self.task.world.holds

    def has(self, number: int) -> bool:
        """Whether there is such a hold."""
        return 1 <= number <= len(self.holds)

    def move(self, number: int, place: Floats) -> None:
        """Put a hold somewhere, world frame [m]; one that is not there stays away."""
        if self.has(number):
            x, y, z = (round(float(value) / FINE) * FINE for value in place)
            self.holds[number - 1] = replace(self.holds[number - 1], at=(x, y, z))

    def turn(self, number: int, normal: Floats) -> None:
        """Give a hold another normal, of any length but 0."""
        if self.has(number) and float(np.linalg.norm(normal)) > 1e-6:
            x, y, z = (round(float(value), 6) + 0.0 for value in unit(normal))
            self.holds[number - 1] = replace(self.holds[number - 1], normal=(x, y, z))

    def add(self, place: Floats, normal: Floats, like: int | None = None) -> int:
        """A new hold like another, or like the first; its number, or that of the last where there is no room for more."""
        if len(self.holds) >= MOST_HOLDS:
            return len(self.holds)
        number = len(self.holds) + 1
        template = self.holds[like - 1] if like is not None and self.has(like) else None
        made = Hold(number=number, at=(0.0, 0.0, 0.0), normal=(0.0, 0.0, 1.0))
        if template is not None or self.task.world.holds:
            made = replace(template or self.task.world.holds[0], number=number)
        self.holds.append(made)
        self.move(number, place)
        self.turn(number, normal)
        return number

    def remove(self, number: int) -> None:
        """Take a hold away; those behind it move up by one."""
        if not self.has(number):
            return
        del self.holds[number - 1]
        self.holds = [replace(hold, number=k) for k, hold in enumerate(self.holds, 1)]
        kept = {old: now for old, now in self._renamed.items() if now != number}
        self._renamed = {old: now - (now > number) for old, now in kept.items()}

    def beside(self, number: int | None) -> tuple[Floats, Floats]:
        """A place beside a hold, on its plane, and its normal; without one, a place on the guide."""
        if number is None or not self.has(number):
            frame = self.task.world.frames[0]
            return frame[:3].copy(), frame[9:].copy()
        hold = self.holds[number - 1]
        axes = frame_about(unit(hold.normal))
        return np.array(hold.at) + max(4.0 * hold.radius, 2.0 * LEAST) * axes[0], axes[2]

    def document(self) -> Json:
        """The task as its files would say it."""
        document = copy.deepcopy(self.task.document)
        if not self.changed:
            return document
        world = {key: value for key, value in document["world"].items() if key not in GENERATORS}
        if "terrain" in world:
            rows = [{key: value for key, value in row.items() if key != "spacing"} for row in world["terrain"]]
            world["terrain"] = rows
        document["world"] = world | {"holds": [hold_row(hold) for hold in self.holds]}
        document["labels"] = document.get("labels", {}) | {"world": LABEL}
        stated = document.get("start", {}).get("holds")
        if stated:
            document["start"]["holds"] = {
                limb: self._renamed[number] for limb, number in stated.items() if number in self._renamed
            }
        return document

    def build(self) -> SpatialTask:
        """The task, if the holds make one.

        Raises:
            SpecError: If they do not: none is left, or one that the start names is gone.
        """
        task = task_from_document(self.document(), LABEL)
        assert isinstance(task, SpatialTask)  # the robot stays what it is
        return task

    def picked(self, eye: Floats, towards: Floats) -> int | None:
        """The hold that a line of sight passes by the nearest, of those that are close to it; the first that it comes to.

        Args:
            eye: Where it begins, world frame [m].
            towards: Its direction.
        """
        if not self.holds:
            return None
        way = unit(towards)
        places = np.array([hold.at for hold in self.holds])
        ahead = (places - eye) @ way
        aside = np.linalg.norm(places - eye - ahead[:, None] * way, axis=1)
        room = np.array([max(CLOSE * hold.radius, LEAST) for hold in self.holds])
        close = np.flatnonzero((aside <= room) & (ahead > 0.0))
        return int(close[np.argmin(ahead[close] + 20.0 * aside[close])]) + 1 if len(close) else None

    def met(self, eye: Floats, towards: Floats) -> tuple[Floats, Floats] | None:
        """Where a line of sight meets the surface, and the surface's normal there: a solid, or else the plane of the nearest hold.

        Args:
            eye: Where it begins, world frame [m].
            towards: Its direction.
        """
        way = unit(towards)
        on_solid = self._met_solid(eye, way)
        if on_solid is not None:
            return on_solid
        if not self.holds:
            return None
        places = np.array([hold.at for hold in self.holds])
        ahead = (places - eye) @ way
        aside = np.where(ahead > 0.0, np.linalg.norm(places - eye - ahead[:, None] * way, axis=1), np.inf)
        hold = self.holds[int(aside.argmin())]
        normal = unit(hold.normal)
        slope = float(way @ normal)
        if not np.isfinite(aside.min()) or abs(slope) < 1e-3:
            return None
        far = float((np.array(hold.at) - eye) @ normal) / slope
        return (eye + far * way, normal) if 0.0 < far < FARTHEST else None

    def _met_solid(self, eye: Floats, way: Floats) -> tuple[Floats, Floats] | None:
        solids = self.task.world.solid_records
        far = 0.0
        if not len(solids) or terrain_distance(solids, *map(float, eye)) <= 0.0:
            return None
        for _ in range(MARCHED):
            at = eye + far * way
            away = float(terrain_distance(solids, *map(float, at)))
            if away < NEAR:
                nudge = 1e-3 * np.eye(3)
                slopes = [
                    terrain_distance(solids, *(at + side)) - terrain_distance(solids, *(at - side)) for side in nudge
                ]
                normal = np.array(slopes)
                return (at, unit(normal)) if float(np.linalg.norm(normal)) > 1e-9 else None
            far += max(away, NEAR)
            if far > FARTHEST:
                return None
        return None


def hold_row(hold: Hold) -> Json:
    """A hold as a world's file has it, lengths in metres."""
    row: Json = {
        "number": hold.number,
        "at": [f"{float(value)!r} m" for value in hold.at],
        "normal": [float(value) for value in hold.normal],
        "radius": f"{float(hold.radius)!r} m",
    }
    if hold.friction is not None:
        row["friction"] = hold.friction
    if hold.strength is not None:
        row["strength"] = f"{float(hold.strength)!r} N"
    return row
