"""Another plan from where a robot in space stands, without holds that could not be had, and without limbs a joint of which is locked."""

from collections.abc import Mapping, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import replace

import numpy as np

from ....files import Document
from ....types import Floats
from ..planning.task import SpatialTask, Start, build_task
from ..robot.chains import Chains
from .course import Course, Standing
from .run_trace import Named


def task_from_here(
    task: SpatialTask, at: Standing, missed: AbstractSet[int], limbs: Sequence[str]
) -> SpatialTask | None:
    """The rest of a task from a stance, in a world whose missed holds are not where they were.

    A plan names holds by their numbers, so a missed hold keeps its number and lies where its nearest neighbour lies (`without`).

    Args:
        task: The task.
        at: Where the robot stands, on its lattice and level with its guide.
        missed: Indices of holds.
        limbs: Names of those that `at` has, of which the task's robot may have fewer.

    Returns:
        None where a start can't say how the robot stands.
    """
    if not at.level:
        return None
    instead = neighbours(task, missed)
    holds = list(task.world.holds)
    for index, other in instead.items():
        holds[index] = replace(holds[other], number=index + 1)
    held = dict(zip(limbs, at.holds.tolist(), strict=True))
    return replace(
        task,
        world=replace(task.world, holds=tuple(holds)),
        start=Start(
            along=at.along,
            across=at.across,
            height=at.height,
            yaw=at.yaw,
            holds={name: held[name] + 1 for name in task.robot.limb_names},
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

    return course.changed(standing, lambda one: replace(one, hold=instead.get(one.hold, one.hold)))


def without_limb(task: SpatialTask, limb: str, places: Mapping[str, float]) -> SpatialTask | None:
    """A task of a robot one of whose limbs is folded and no limb any more, but a part of the body.

    Args:
        task: The task.
        limb: Name of the limb.
        places: Joint of it -> where it stays [rad] or [m].

    Returns:
        None where no limb would be left.
    """
    robot = task.document["robot"]
    limbs = [one for one in robot["limb"] if one["name"] != limb]
    if not limbs:
        return None
    chains = task.robot.chains
    index = chains.limb_names.index(limb)
    units = ["m" if sliding else "rad" for sliding in chains.sliding[index]]
    stays = {name: f"{places[name]!r} {unit}" for name, unit in zip(chains.joint_names[index], units, strict=False)}
    half = [f"{float(length)!r} m" for length in chains.base_half]
    changed = robot | {"limb": limbs, "trunk": robot.get("trunk", {}) | stays, "half": half}
    start = {key: value for key, value in task.document["start"].items() if key != "holds"}
    built = build_task(Document(f"the rest of '{task.name}'", task.document | {"robot": changed, "start": start}))
    return replace(built, goals=task.goals)


def widened(course: Course, chains: Chains, whole: Chains, posture: Floats) -> Course:
    """A course of a robot some limbs of which are left out as one of the whole robot.

    Args:
        course: As planned.
        chains: Of the robot that it was planned for.
        whole: Of the whole robot.
        posture: Of the whole robot, which those limbs keep, shape (n,).
    """
    limbs = [whole.limb_names.index(name) for name in chains.limb_names]
    joints = [Named.of(whole).joints.index(name) for name in Named.of(chains).joints]

    def loads(of: Floats) -> Floats:
        all_of = np.zeros((len(whole.limb_names), of.shape[1]))
        all_of[limbs] = of
        return all_of

    def standing(at: Standing) -> Standing:
        holds, all_joints = np.full(len(whole.limb_names), -1, np.int32), posture.copy()
        holds[limbs] = at.holds
        all_joints[joints] = at.joints
        return replace(at, holds=holds, joints=all_joints, loads=loads(at.loads))

    return course.changed(standing, lambda one: replace(one, limb=limbs[one.limb], loads=loads(one.loads)))
