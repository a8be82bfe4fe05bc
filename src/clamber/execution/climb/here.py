"""The task that is left: it starts where the robot is, on a board without the holds that it could not get."""

import copy
from collections.abc import Mapping, Set
from typing import Final

from ...tasks import task_from_document
from ...tasks.limbed import LimbedTask
from ...types import Json
from ...worlds.board import Hold
from .course import Course

GENERATORS: Final = ("ladder", "grid", "random", "csv", "added", "holds")
"""Keys of a board's document that say where its holds are."""


def hold_document(hold: Hold, direction: float | None, cone: float | None) -> Json:
    """A hold as a board's document has it, with a direction and a cone about it [rad]."""
    made: Json = {"number": hold.number, "x": f"{hold.x!r} m", "y": f"{hold.y!r} m", "radius": f"{hold.radius!r} m"}
    made |= {} if direction is None else {"direction": f"{direction!r} rad"}
    made |= {} if cone is None else {"cone": f"{cone!r} rad"}
    return made | ({} if hold.strength is None else {"strength": f"{hold.strength!r} N"})


def task_from_here(course: Course, step: int, held: Mapping[str, int], missed: Set[int]) -> LimbedTask:
    """The task that starts in the plan's pose before a step, with the holds that the robot has.

    Args:
        course: The plan that went wrong.
        step: The action that failed, from 1.
        held: Limb -> number of its hold, 0 if it is free.
        missed: Holds that are left out, unless a limb is on them or a goal asks for them.
    """
    task, pose = course.task, course.pose(step - 1)
    document = copy.deepcopy(task.document)
    document["start"] = {
        "x": f"{float(pose[0])!r} m",
        "y": f"{float(pose[1])!r} m",
        "theta": f"{float(pose[2])!r} rad",
        "holds": dict(held),
    }
    wanted = {number for goal in task.goals for number in goal.holds.values()}
    gone = missed - set(held.values()) - wanted
    barred = document.get("rules", {}).get("barred", {})
    for limb, numbers in barred.items():
        barred[limb] = [number for number in numbers if number not in gone]
    board = {key: value for key, value in document["board"].items() if key not in GENERATORS}
    kept = [hold_document(hold, hold.direction, hold.cone) for hold in task.world.holds if hold.number not in gone]
    document["board"] = board | {"holds": kept}
    changed = task_from_document(document, "where the robot is")
    assert isinstance(changed, LimbedTask)  # the robot stays what it is
    return changed
