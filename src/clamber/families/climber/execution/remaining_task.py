"""The task that is left: from where the robot is, the goals that it has not met, on a board without the holds that it could not get."""

import copy
import math
from collections.abc import Mapping, Set
from typing import Final

from ....tasks import task_from_document
from ....types import Json
from ..planning.task import LimbedTask
from ..world.board import Hold
from .executable_plan import ExecutablePlan

GENERATORS: Final = ("ladder", "grid", "random", "csv", "added", "holds")
"""Keys of a board's document that say where its holds are."""

LEAST_TURN: Final = 1e-9
"""Of a goal that asks for no more turns than there have been [-]."""


def hold_document(hold: Hold, direction: float | None, cone: float | None) -> Json:
    """A hold as a board's document has it, with a direction and a cone about it [rad]."""
    made: Json = {"number": hold.number, "x": f"{hold.x!r} m", "y": f"{hold.y!r} m", "radius": f"{hold.radius!r} m"}
    made |= {} if direction is None else {"direction": f"{direction!r} rad"}
    made |= {} if cone is None else {"cone": f"{cone!r} rad"}
    return made | ({} if hold.strength is None else {"strength": f"{hold.strength!r} N"})


def task_from_here(course: ExecutablePlan, step: int, held: Mapping[str, int], missed: Set[int]) -> LimbedTask:
    """The task that starts in the plan's pose before a step, with the holds that the robot has and the goals that are left by then.

    Args:
        course: The plan that went wrong.
        step: The action that failed, from 1.
        held: Limb -> number of its hold, 0 if it is free.
        missed: Holds that are left out, unless a limb is on them or a goal asks for them.
    """
    task = course.task
    document = copy.deepcopy(task.document)
    document["start"] = _start(course, step - 1, held)
    document |= _goals_left(course, step - 1)
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


def _start(course: ExecutablePlan, step: int, held: Mapping[str, int]) -> Json:
    """A start after a step of the plan: free limbs where the plan has them, and the limb that moved last, if it holds."""
    pose, stance, limbs = course.pose(step), course.stances[step], course.task.robot.limbs
    made: Json = {
        "x": f"{float(pose[0])!r} m",
        "y": f"{float(pose[1])!r} m",
        "theta": f"{float(pose[2])!r} rad",
        "holds": dict(held),
        "feet": {
            limb.name: [f"{float(place)!r} m" for place in stance["foot"][i]]
            for i, limb in enumerate(limbs)
            if not held.get(limb.name) and stance["hold"][i] < 0
        },
    }
    moved = limbs[int(stance["in_use"])].name
    return made | ({"in_use": moved} if held.get(moved) else {})


def _goals_left(course: ExecutablePlan, step: int) -> Json:
    """The goals that the plan has not met after a step, and of turns what is left of them."""
    task, stance = course.task, course.stances[step]
    met = min(int(stance["stage"]), len(task.goals) - 1)
    goals = [*copy.deepcopy(task.document.get("subgoals", [])), copy.deepcopy(task.document["goal"])][met:]
    for stated, goal in zip(goals, task.goals[met:], strict=True):
        if goal.turns is not None:
            assert goal.centre is not None  # stated both or neither
            at_start = math.atan2(task.start.y - goal.centre[1], task.start.x - goal.centre[0])
            swept = 2.0 * math.pi * int(stance["laps"]) + float(stance["bearing"]) - at_start
            left = abs(goal.turns) - swept * math.copysign(1.0, goal.turns) / (2.0 * math.pi)
            stated["turns"] = math.copysign(max(left, LEAST_TURN), goal.turns)
    return {"subgoals": goals[:-1], "goal": goals[-1]}
