"""Another plan from where a robot in space stands, without holds that could not be had."""

from collections.abc import Set as AbstractSet
from dataclasses import replace

import numpy as np

from ..planning.task import SpatialTask, Start
from .course import Course, Motion, Regrab, Standing


def task_from_here(task: SpatialTask, at: Standing, missed: AbstractSet[int]) -> SpatialTask | None:
    """The rest of a task from a stance, in a world whose missed holds are not where they were.

    A plan names holds by their numbers, so a missed hold keeps its number and lies where its nearest neighbour lies (`without`).

    Args:
        task: The task.
        at: Where the robot stands, on its lattice and level with its guide.
        missed: Indices of holds.

    Returns:
        None where a start can't say how the robot stands.
    """
    if not at.level:
        return None
    instead = neighbours(task, missed)
    holds = list(task.world.holds)
    for index, other in instead.items():
        holds[index] = replace(holds[other], number=index + 1)
    names = task.robot.limb_names
    return replace(
        task,
        world=replace(task.world, holds=tuple(holds)),
        start=Start(
            along=at.along,
            across=at.across,
            height=at.height,
            yaw=at.yaw,
            holds={name: int(hold) + 1 for name, hold in zip(names, at.holds, strict=True)},
        ),
        goals=task.goals[min(at.stage, len(task.goals) - 1) :],
    )


def neighbours(task: SpatialTask, missed: AbstractSet[int]) -> dict[int, int]:
    """Index of each missed hold -> that of the nearest one that is not missed."""
    places = task.world.places
    there = np.array([index for index in range(len(places)) if index not in missed])
    return {
        index: int(there[np.argmin(np.linalg.norm(places[there] - places[index], axis=1))]) for index in sorted(missed)
    }


def without(course: Course, instead: dict[int, int]) -> Course:
    """A course with each missed hold called by its neighbour's index."""

    def standing(at: Standing) -> Standing:
        return replace(at, holds=np.array([instead.get(int(hold), int(hold)) for hold in at.holds], np.int32))

    def motion(one: Motion) -> Motion:
        if isinstance(one, Regrab):
            hold = instead.get(one.hold, one.hold)
            return replace(one, hold=hold, before=standing(one.before), after=standing(one.after))
        return replace(one, way=tuple(map(standing, one.way)))

    return Course(standing(course.start), tuple(map(motion, course.motions)))
