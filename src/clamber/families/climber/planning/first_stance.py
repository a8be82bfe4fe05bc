"""Where a robot could start: the lowest place on a board with a stance that every hard check allows."""

import math
from collections.abc import Iterator
from itertools import islice, product
from typing import TYPE_CHECKING, Final

import numpy as np
import numpy.typing as npt

from ....planning.problem.check import TICKS
from ....planning.problem.codes import pack
from ....planning.problem.loops import replay
from ....planning.problem.problem import Records
from ....types import Json
from ..statics.elbows import EVERY
from ..statics.records import STANCE
from .arrays import CHECKS, limbed_params
from .task import LimbedTask

if TYPE_CHECKING:
    from scipy.spatial import cKDTree

CHOICES: Final = 5
"""Holds that are tried for each limb, and free."""
COMFORTABLE: Final = 0.7
"""Limbs bent to this share of their length are tried first [-]."""
MOST_COMBINATIONS: Final = 400
"""Combinations of holds that are tried at one place."""


def first_stance(task: LimbedTask) -> Json | None:
    """The `[start]` of a task file: low, in the middle if possible, with as many holders and as much torque to spare as can be.

    The task's own start is only where the lattice of poses lies. The places about each hold are looked at, band by band from the bottom.

    Args:
        task: The task, with any start.

    Returns:
        x, y, theta and holds; None if no place has a valid stance with two holders.
    """
    from scipy.spatial import cKDTree  # takes a tenth of a second to import

    params = limbed_params(task, every_check=False)
    points = task.world.positions()
    tree = cKDTree(points)
    numbers = task.world.numbers()
    for ix, iy in _places(task, points):
        x, y = task.start.x + ix * task.step.length, task.start.y + iy * task.step.length
        found = _best_here(task, params.record, tree, points, x, y, (ix * TICKS, iy * TICKS))
        if found is not None:
            holds = {
                limb.name: int(numbers[h]) if h >= 0 else 0 for limb, h in zip(task.robot.limbs, found, strict=True)
            }
            place = {"x": f"{round(x, 9)!r} m", "y": f"{round(y, 9)!r} m"}
            return {**place, "theta": f"{task.start.theta!r} rad", "holds": holds}
    return None


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
    tree: "cKDTree",
    points: npt.NDArray[np.float64],
    x: float,
    y: float,
    ticks: tuple[int, int],
) -> tuple[int, ...] | None:
    """The best valid combination of holds at one place: most holders, then the largest torque margin."""
    choices = []
    c, s = math.cos(task.start.theta), math.sin(task.start.theta)
    for limb in task.robot.limbs:
        port = np.array([x + c * limb.port_x - s * limb.port_y, y + s * limb.port_x + c * limb.port_y])
        near = np.array(tree.query_ball_point(port, limb.length - task.rules.reach_offset), np.int64)
        bent = np.abs(np.hypot(*(points[near] - port).T) - COMFORTABLE * limb.length) if len(near) else np.zeros(0)
        choices.append([*near[np.lexsort((near, bent))][:CHOICES].tolist(), -1])
    if sum(len(choice) > 1 for choice in choices) < 2:
        return None
    best: tuple[int, ...] | None = None
    best_rank = (1, -math.inf)
    stances = np.zeros(2, STANCE)
    margins, reasons = np.zeros((1, len(CHECKS))), np.zeros(1, np.int32)
    for holds in islice(_different(choices), MOST_COMBINATIONS):
        holders = sum(h >= 0 for h in holds)
        if holders < max(2, best_rank[0], task.rules.min_supports):
            continue
        start = _stance(task, holds, ticks)
        replay(record, start, np.array([pack(0)], np.int32), True, stances, margins, reasons)
        rank = (holders, float(margins[0, CHECKS.index("torque")]))
        if reasons[0] < 0 and rank > best_rank:
            best, best_rank = holds, rank
    return best


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
