"""Grabs of a plan to which a limb would find no way: looked for on paper, before anything moves."""

import math
from typing import Final

import numpy as np

from ....types import Floats
from ..control.limb_chain import legs_of
from .approach import Approach, Approaches, Wish, discs_of
from .body_gains import USUAL_WEIGHT
from .elbows import load_capacity
from .executable_plan import ExecutablePlan
from .hook import NEAR
from .hook_release import AWAY, stand_off
from .motions import WEAKER
from .parking import park, poses_between
from .postures import bent_postures, postures

BACK: Final = (1.0, 0.5, 0.0)
"""Parts of its way back off a hold that a limb may reach, the most first [-]."""
DRAWS: Final = 12
"""Maps on which a way is looked for where the body has to make room for it."""
SEED: Final = 0
"""Of these maps: the same for every plan."""


def grabs_without_way(course: ExecutablePlan, error: float) -> list[int]:
    """Steps of the grabs to which the limb that acts finds no way, or not wherever the holds may be, its elbow where the course has it.

    Each limb stands where its hook was drawn back off the hold that it had, its elbow as it was there; a free one waits where it is clear
    of holds as the body moves. Then the way is looked for as it is before a grab, the body making room where the other limbs hold it
    hardly worse: on the map as it is, and where the body has to make room also on maps as they might be learned by then, each hold off
    by as much as it may be. What a second try with the other elbow, or from another pose, may find is left out.

    Args:
        course: A plan, carried out on paper.
        error: How far the map may be off, each way along each axis [m].
    """
    robot = course.task.robot.at_weight(USUAL_WEIGHT)
    holds = course.task.world.places()
    radius = max(hold.radius for hold in course.task.world.holds)
    ways = Approaches(robot, legs_of(robot))
    discs = discs_of(holds.values(), radius + error)
    rng = np.random.default_rng(SEED)
    maps = [{number: place + rng.uniform(-error, error, 2) for number, place in holds.items()} for _ in range(DRAWS)]

    def reaches(i: int, step: int, start: Floats) -> bool:
        found = _way(ways, course, i, step, start, holds, error)
        if found is None or not found.shift.any():
            return found is not None
        return all(_way(ways, course, i, step, start, drawn, error) is not None for drawn in maps)

    waits: list[Floats | None] = [None] * len(robot.limbs)
    blocked = []
    for step in range(1, len(course.stances)):
        before, after = course.holds(step - 1), course.holds(step)
        for i, limb in enumerate(robot.limbs):
            old, new = before[limb.name], after[limb.name]
            start = waits[i] if not old else _drawn_back(course, i, step, holds[old], radius + error)
            if new and new != old:
                # without a place to start from nothing is known of the way
                if start is not None and not reaches(i, step, start):
                    blocked.append(step)
                waits[i] = None
            elif old and not new:
                waits[i] = start
            elif not new and start is not None:
                way = park(ways, i, start, poses_between(course.pose(step - 1), course.pose(step)), discs)
                waits[i] = start if way is None else way[-1]
    return blocked


def _drawn_back(course: ExecutablePlan, i: int, step: int, hold: Floats, radius: float) -> Floats | None:
    """Joint angles of a limb whose hook has been drawn back off its hold in an action, shape (2,) [rad]."""
    limb, pose, side = course.task.robot.limbs[i], course.pose(step), int(course.elbows[step - 1, i])
    on = [one for one in postures(limb, pose, hold) if side * one.angles[1] > 0.0]
    if not on:
        return None
    away = stand_off(limb, radius, 0.0) + AWAY
    for part in BACK:
        off = bent_postures(limb, pose, hold - part * away * on[0].grab, side)
        if off:
            return off[0].angles
    return None


def _way(
    ways: Approaches, course: ExecutablePlan, i: int, step: int, start: Floats, holds: dict[int, Floats], error: float
) -> Approach | None:
    """A way to the hold that a limb takes in an action, as it is looked for when the limb is there."""
    task, names = course.task, course.task.robot.limb_names
    places, stance = task.world.positions(), course.stances[step - 1].copy()
    held = course.holds(step - 1)
    stance["carriers"] = sum(1 << j for j, name in enumerate(names) if j != i and held[name])

    def bears(pose: Floats) -> float:
        stance["x"], stance["y"], stance["angle"] = pose
        return load_capacity(ways.robot, ways.legs, places, stance, course.elbows[step - 1])

    pose = course.pose(step)
    least = min(0.0, bears(pose)) - WEAKER
    radius = max(hold.radius for hold in task.world.holds)
    hold, doubt = holds[course.holds(step)[names[i]]], math.sqrt(2.0) * error
    distance = stand_off(task.robot.limbs[i], radius, doubt)
    wish = Wish(elbow=int(course.elbows[step, i]), stand_off=distance, near=NEAR + doubt)
    return ways.find(
        i, start, pose, hold, discs_of(holds.values(), radius + error), wish, stands=lambda pose: bears(pose) >= least
    )
