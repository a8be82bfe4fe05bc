"""The tables of `bounding_kernels`, for exact search."""

import math
from collections.abc import Callable
from typing import Any, Final

import numpy as np

from ....planning.problem.arrays import Params
from ....planning.problem.problem import Records
from .bounding_kernels import count_down, join_poses, list_poses, mark_region, reach_holds
from .records import ACROSS, ALONG, AXES, HEIGHT, PITCH, ROLL, YAW
from .step_kernels import MOVES

MOST_SLACK: Final = 12
"""Moves beside the least that a way through the region may need, at most."""
MOST_PAIRS: Final = 600_000
"""Of a pose and a hold that are looked at for each limb, about: a microsecond and a half each, at most."""
MOST_BOX: Final = 20_000_000
"""Poses of the box about the region."""


def with_bound(params: Params, start: Records, is_late: Callable[[], bool]) -> Params:
    """The parameters with the tables for the largest region that the effort allows; as they are where there is no time for any.

    Args:
        params: Of a task.
        start: Its start stance.
        is_late: Asked whether there is no more time.
    """
    row: Any = params.record
    reach = 0.5 * float(row["reach"])
    holds: Any = params.array("holds")
    places = holds["place"]
    near = float(np.median((np.linalg.norm(places[None] - places[:, None], axis=2) < reach).sum(axis=1)))
    pose, best = start["pose"][0], None
    for slack in range(MOST_SLACK + 1):
        low, count = _box(params, pose, slack)
        if is_late() or math.prod(count.tolist()) > MOST_BOX:
            break
        region = np.zeros(math.prod(count.tolist()), np.int32)
        n = mark_region(row, pose, slack, low, count, region, np.zeros(AXES, np.int64))
        if n * near * int(row["n_limbs"]) > MOST_PAIRS:
            break
        if best is not None and n == best[3]:
            continue
        best = low, count, region, n
    if best is None:
        return params
    low, count, region, n = best
    left = np.zeros((int(row["n_limbs"]), n, len(holds)), np.int16)
    poses, scratch = np.zeros((n, AXES), np.int64), start.copy()
    list_poses(row, low, count, region, poses)
    made = params.extended({"n_poses": n}, region=region, left=left)
    record: Any = made.record
    record["region_low"], record["region_count"] = low, count
    beside, exits, met = np.zeros((n, MOVES), np.int32), np.zeros(n, np.int64), np.zeros(n, np.uint8)
    join_poses(made.record, poses, beside, exits, met, scratch)
    robot: Any = params.array("robot")
    joints = robot["n_joints"][0]
    for limb, table in enumerate(left):
        postures = np.zeros((*table.shape, int(joints[limb])), np.float32)
        reach_holds(row, limb, poses, table, postures, scratch)
        count_down(row, limb, table, postures, beside, exits, met, np.zeros(table.size, np.int64))
    return made


def _box(params: Params, pose: Any, slack: int) -> tuple[Any, Any]:
    """Least step and number of steps of each axis that ways with so many moves to spare may come to."""
    row: Any = params.record
    goal: Any = params.array("goals")[-1]
    low, high = pose.copy(), pose.copy()
    far = int(row["far"])
    for axis, name in ((ALONG, "along"), (ACROSS, "across")):
        length, at = float(row["length"]), float(row[name])
        least = max(0.0, float(goal[f"{name}_min"]) - at) / length
        most = min(0.0, float(goal[f"{name}_max"]) - at) / length
        low[axis] += math.floor(most - far * (slack + 1))
        high[axis] += math.ceil(least + far * (slack + 1))
    yaws = slack + math.ceil(math.pi / float(row["angle"])) if float(goal["yaw_width"]) < math.tau else slack
    for axis, limit in ((HEIGHT, int(row["heights"])), (PITCH, int(row["tilts"])), (ROLL, int(row["tilts"]))):
        limit = limit if axis == HEIGHT or float(row["tilt"]) else 0
        low[axis], high[axis] = max(-limit, int(pose[axis]) - slack), min(limit, int(pose[axis]) + slack)
    low[YAW], high[YAW] = pose[YAW] - yaws, pose[YAW] + yaws
    if high[YAW] - low[YAW] >= int(row["turns"]):
        low[YAW], high[YAW] = 0, int(row["turns"]) - 1
    return low, (high - low + 1).astype(np.int64)
