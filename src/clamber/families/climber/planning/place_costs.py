"""How far it is from every place of a wall to each goal: the coarse map that leads a route."""

from typing import Final

import numpy as np
import numpy.typing as npt

from ....planning.problem.arrays import CostToGoMap
from ....types import Floats
from .task import Goal, LimbedTask

MOST_PLACES: Final = 400_000
"""Most places of a map; larger walls get a coarser one."""

BARREN: Final = 50.0
"""What a step over a place costs where too few holds are in reach, or one is too close; not infinite, for a hang may lead on."""

SPARSE: Final = 2.0
"""A place with n holds in reach costs 1 + SPARSE / n: more holds, more ways to go on."""


def way_fields(task: LimbedTask) -> CostToGoMap:
    """The map of a task: shortest ways along x and y over places, dearer where few holds are in reach.

    Args:
        task: A task; goals that ask for turns or an angle lead as far as their boxes do.
    """
    from scipy.sparse.csgraph import dijkstra
    from scipy.spatial import cKDTree

    points = task.world.positions()
    reach, stride = task.robot.longest_reach, task.step.length
    low, high = points.min(axis=0) - reach, points.max(axis=0) + reach
    grain = max(stride, float(np.sqrt(np.prod(high - low) / MOST_PLACES)))
    # The start is one of the places, so that those of the lattice of steps are, too.
    start = np.array([task.start.x, task.start.y])
    low = start - np.ceil((start - low) / grain) * grain
    columns, rows = (np.ceil((high - low) / grain).astype(int) + 1).tolist()
    x, y = low[0] + grain * np.arange(columns), low[1] + grain * np.arange(rows)
    places = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    tree = cKDTree(points)
    near = tree.query_ball_point(places, reach, return_length=True)
    fewest = max(2, task.rules.min_supports) if task.rules.max_hangs == 0 else task.rules.min_supports
    cost = np.where(near >= fewest, 1.0 + SPARSE / np.maximum(near, 1), BARREN) * (grain / stride)
    if "clearance" in task.rules.hard and task.rules.clearance > 0.0:
        cost[tree.query(places)[0] < task.rules.clearance] = BARREN * grain / stride
    graph = _graph(cost, rows, columns)
    here = ((points - low) / grain + 0.5).astype(int)
    fields = np.zeros((len(task.goals), rows, columns))
    after = np.zeros(len(task.goals))
    for index, goal in enumerate(task.goals):
        inside = _inside(goal, places, task, points)
        fields[index] = dijkstra(graph, indices=np.flatnonzero(inside), min_only=True).reshape(rows, columns)
    for index in range(len(task.goals) - 2, -1, -1):
        inside = _inside(task.goals[index], places, task, points).reshape(rows, columns)
        after[index] = after[index + 1] + fields[index + 1][inside].max()
    holds = fields[:, here[:, 1], here[:, 0]]
    return CostToGoMap(np.array([*low, grain]), fields, np.ascontiguousarray(holds), after)


def _graph(cost: Floats, rows: int, columns: int) -> object:
    """Neighbouring places, each way at the mean of their costs."""
    from scipy.sparse import coo_array

    index = np.arange(rows * columns).reshape(rows, columns)
    a = np.concatenate([index[:, :-1].ravel(), index[:-1].ravel()])
    b = np.concatenate([index[:, 1:].ravel(), index[1:].ravel()])
    between = 0.5 * (cost[a] + cost[b])
    size = rows * columns
    ends = (np.concatenate([a, b]), np.concatenate([b, a]))
    return coo_array((np.concatenate([between, between]), ends), shape=(size, size)).tocsr()


def _inside(goal: Goal, places: Floats, task: LimbedTask, points: Floats) -> npt.NDArray[np.bool_]:
    """Places that a goal's box holds, or the one nearest to it; named holds draw the body to where they are all in reach."""
    off = goal.off(places)
    x, y = places.T
    for number in goal.holds.values():
        hold = task.world.by_number(number)
        off += np.maximum(np.hypot(x - hold.x, y - hold.y) - task.robot.longest_reach, 0.0)
    inside: npt.NDArray[np.bool_] = off <= off.min() + 1e-9
    return inside
