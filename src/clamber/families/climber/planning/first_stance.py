"""Where a robot could start: the lowest place on a board with a stance that every hard check allows."""

import math
from collections.abc import Iterator
from itertools import islice, product
from typing import Final

import numpy as np
import numpy.typing as npt
from scipy.spatial import cKDTree

from ....planning.problem.check import TICKS
from ....planning.problem.problem import Records
from ....types import Floats, Json
from ..statics.checks import LIMBED_CHECKS
from ..statics.elbows import EVERY
from ..statics.records import STANCE
from .arrays import CHECKS, limbed_params
from .problem import judge_stance
from .task import LimbedTask

CHOICES: Final = 5
"""Holds that are tried for each limb, and free."""
COMFORTABLE: Final = 0.7
"""Limbs bent to this share of their length are tried first [-]."""
MOST_COMBINATIONS: Final = 400
"""Combinations of holds that are tried at one place."""
MOST_STANCES: Final = 60_000
"""Stances that are looked at for one that every check likes: about two seconds."""
ENOUGH: Final = 0.1
"""Room beyond a check's limit, as a share of its scale, that is as good as more [-]."""


def first_stance(task: LimbedTask) -> Json | None:
    """The `[start]` of a task file: low, in the middle if possible, with as many holders and as much torque to spare as can be.

    The task's own start is only where the lattice of poses lies. The places about each hold are looked at, band by band from the bottom.

    Args:
        task: The task, with any start.

    Returns:
        x, y, theta and holds; None if no place has a valid stance with two holders.
    """
    params = limbed_params(task, every_check=False)
    points = task.world.positions()
    tree = cKDTree(points)
    for ix, iy in _places(task, points):
        found = _best_here(task, params.record, tree, points, (ix, iy))
        if found is not None:
            return _stated(task, found, (ix, iy))
    return None


def liked_stance(task: LimbedTask) -> Json | None:
    """The `[start]` of a task file that every check likes, those that only report, too: near the bottom, most limbs on holds.

    Where no stance among those that are looked at is liked by all, the one that the fewest dislike.

    Args:
        task: The task, with any start.

    Returns:
        As `first_stance`.
    """
    params, points, n = limbed_params(task, every_check=True), task.world.positions(), len(task.robot.limbs)
    tree, scales = cKDTree(points), _scales(task)
    most, top = max(2, int(MOST_COMBINATIONS ** (1.0 / n) + 0.5)), float(points[:, 1].min()) + task.robot.longest_reach
    best: tuple[tuple[int, int, float, float], tuple[int, ...], tuple[int, int]] | None = None
    looked = 0
    for place in _places(task, points):
        looked += 1
        choices = [[*near[: most - 1], -1] for near in _near(task, tree, points, place, outwards=True)]
        if sum(len(choice) > 1 for choice in choices) < 2 or (best is not None and _at(task, place)[1] > top):
            continue
        for holds in _different(choices):
            holders = sum(hold >= 0 for hold in holds)
            if holders < max(2, task.rules.min_supports):
                continue
            margins, reason = _judged(task, params.record, holds, place)
            looked += 1
            if reason < 0:
                room = np.where(np.isnan(margins), np.inf, margins)[: len(scales)] / scales
                spare = np.minimum(room, ENOUGH)
                rank = (-int(np.sum(room < 0.0)), holders, float(spare.min()), float(spare.mean()))
                if best is None or rank > best[0]:
                    best = rank, holds, place
        if looked > MOST_STANCES or (best is not None and best[0][1:3] == (n, ENOUGH)):
            break
    return None if best is None else _stated(task, best[1], best[2])


def _scales(task: LimbedTask) -> npt.NDArray[np.float64]:
    """What the room that a check leaves is a share of, in the check's unit; infinite where whole numbers are counted, shape (checks,)."""
    sizes = {
        "m": min(limb.length for limb in task.robot.limbs),
        "rad": 1.0,
        "N m": task.robot.motor.torque_limit,
        "N": task.robot.weight,
    }
    return np.array([sizes.get(check.unit, np.inf) for check in LIMBED_CHECKS])


def _stated(task: LimbedTask, holds: tuple[int, ...], place: tuple[int, int]) -> Json:
    """A start as a task file has it."""
    (x, y), numbers = _at(task, place), task.world.numbers()
    named = {limb.name: int(numbers[h]) if h >= 0 else 0 for limb, h in zip(task.robot.limbs, holds, strict=True)}
    where = {"x": f"{round(x, 9)!r} m", "y": f"{round(y, 9)!r} m"}
    return {**where, "theta": f"{task.start.theta!r} rad", "holds": named}


def _at(task: LimbedTask, place: tuple[int, int]) -> tuple[float, float]:
    """World coordinates of a place on the lattice of steps [m]."""
    return task.start.x + place[0] * task.step.length, task.start.y + place[1] * task.step.length


def _places(task: LimbedTask, points: npt.NDArray[np.float64]) -> Iterator[tuple[int, int]]:
    """Poses of the lattice within reach of some hold and not below the lowest: from the bottom up, the middle first, each once."""
    (left, bottom), (right, _) = points.min(axis=0), points.max(axis=0)
    reach, stride = task.robot.longest_reach, task.step.length
    band = np.floor((points[:, 1] - bottom) / reach)
    seen: set[tuple[int, int]] = set()
    for x, y in points[np.lexsort((np.abs(points[:, 0] - 0.5 * (left + right)), band))]:
        for iy in _steps(max(bottom, y - reach) - task.start.y, y + reach - task.start.y, stride):
            for ix in _steps(x - reach - task.start.x, x + reach - task.start.x, stride):
                if (ix, iy) not in seen:
                    seen.add((ix, iy))
                    yield ix, iy


def _steps(low: float, high: float, stride: float) -> range:
    return range(math.ceil(low / stride), math.floor(high / stride) + 1)


def _best_here(
    task: LimbedTask,
    record: np.void,
    tree: cKDTree,
    points: npt.NDArray[np.float64],
    place: tuple[int, int],
) -> tuple[int, ...] | None:
    """The best valid combination of holds at one place: most holders, then the largest torque margin."""
    choices = [[*near[:CHOICES], -1] for near in _near(task, tree, points, place)]
    if sum(len(choice) > 1 for choice in choices) < 2:
        return None
    best: tuple[int, ...] | None = None
    best_rank = (1, -math.inf)
    for holds in islice(_different(choices), MOST_COMBINATIONS):
        holders = sum(h >= 0 for h in holds)
        if holders < max(2, best_rank[0], task.rules.min_supports):
            continue
        margins, reason = _judged(task, record, holds, place)
        rank = (holders, float(margins[CHECKS.index("torque")]))
        if reason < 0 and rank > best_rank:
            best, best_rank = holds, rank
    return best


def _near(
    task: LimbedTask,
    tree: cKDTree,
    points: npt.NDArray[np.float64],
    place: tuple[int, int],
    *,
    outwards: bool = False,
) -> list[list[int]]:
    """Holds that each limb reaches from a place, the most comfortable first: by how it is bent, or so and straight out from its port."""
    (x, y), found = _at(task, place), []
    c, s = math.cos(task.start.theta), math.sin(task.start.theta)
    for limb in task.robot.limbs:
        port = np.array([x + c * limb.port_x - s * limb.port_y, y + s * limb.port_x + c * limb.port_y])
        near = np.array(tree.query_ball_point(port, limb.length - task.rules.reach_offset), np.int64)
        out = limb.port_angle + task.start.theta
        tip = port + COMFORTABLE * limb.length * np.array([math.cos(out), math.sin(out)])
        bent = np.hypot(*(points[near] - (tip if outwards else port)).T) if len(near) else np.zeros(0)
        bent = bent if outwards else np.abs(bent - COMFORTABLE * limb.length)
        found.append(near[np.lexsort((near, bent))].tolist())
    return found


def _judged(task: LimbedTask, record: np.void, holds: tuple[int, ...], place: tuple[int, int]) -> tuple[Floats, int]:
    """Margins of a stance, shape (checks,), and the hard check that it violates, -1 for none."""
    _, margins, reason = judge_stance(record, _stance(task, holds, (place[0] * TICKS, place[1] * TICKS)))
    return margins, reason


def _different(choices: list[list[int]]) -> Iterator[tuple[int, ...]]:
    """Combinations in which no two limbs share a hold."""
    for holds in product(*choices):
        taken = [h for h in holds if h >= 0]
        if len(set(taken)) == len(taken):
            yield holds


def _stance(task: LimbedTask, holds: tuple[int, ...], ticks: tuple[int, int]) -> Records:
    start = np.zeros(1, STANCE)
    start["hold"] = start["left"] = start["resolved"] = -1
    start["ix"], start["iy"] = ticks
    start["elbows"] = EVERY
    for i, (limb, hold) in enumerate(zip(task.robot.limbs, holds, strict=True)):
        start["hold"][0, i] = hold
        start["foot"][0, i] = task.start.feet.get(limb.name, (limb.port_x, limb.port_y))
        if hold >= 0:
            start["in_use"] = i
    return start
