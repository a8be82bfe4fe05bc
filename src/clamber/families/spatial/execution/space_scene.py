"""A run of a robot in space in three dimensions, as its log tells it: the world frame is the task's."""

import math
from collections.abc import Sequence
from typing import Any, Final

import numpy as np

from ....execution.log_scene import BODY, HOLD, LIMBS, WORLD, Frame, LoggedScene, Shape, ball, rod, turn_of
from ....execution.sample_log import columns_of
from ....types import Floats
from ..planning.task import SpatialTask
from .run_trace import Named

BASE: Final = "base"


def space_scene(task: SpatialTask, *, true: bool) -> LoggedScene:
    """Holds of a world and a robot on them; its links are sticks between their joints.

    Args:
        task: Robot and world, as it is mapped.
        true: Whether samples tell how things truly are; then the frames are there, else where the controller believes them.
    """
    chains: Any = task.robot.chains
    columns = columns_of(Named.of(chains).titles(true=true))
    pose_at, joints_at = columns["true_pose" if true else "believed"], columns["true_joints" if true else "joints"]

    def frames(row: Floats) -> list[Frame]:
        x, y, z, *turn = row[pose_at].tolist()
        made = [Frame(BASE, WORLD, (x, y, z), (turn[1], turn[2], turn[3], turn[0]))]
        joints = iter(row[joints_at].tolist())
        for limb, name in enumerate(chains.limb_names):
            parent = BASE
            for k in range(int(chains.n_joints[limb])):
                value, axes = next(joints), chains.rotation[limb, k]
                slides = bool(chains.sliding[limb, k])
                at = chains.offset[limb, k] + (value * axes[:, 2] if slides else 0.0)
                made.append(Frame(_link(name, k), parent, at, turn_of(axes if slides else axes @ _about_z(value))))
                parent = _link(name, k)
            last = int(chains.n_joints[limb])
            made.append(Frame(f"{name} tip", parent, chains.offset[limb, last], turn_of(chains.rotation[limb, last])))
        return made

    holds = [ball(0.008, HOLD, hold) for hold in task.world.places] if len(task.world.holds) else []
    return LoggedScene({WORLD: holds} | _robot(chains), frames)


def _link(limb: str, k: int) -> str:
    return f"{limb} link {k + 1}"


def _about_z(angle: float) -> Floats:
    c, s = math.cos(angle), math.sin(angle)
    return np.array(((c, -s, 0.0), (s, c, 0.0), (0.0, 0.0, 1.0)))


def _robot(chains: Any) -> dict[str, Sequence[Shape]]:
    shapes: dict[str, Sequence[Shape]] = {
        BASE: [Shape("cubes", (0.0, 0.0, 0.0), 2.0 * np.maximum(chains.base_half, 0.01), BODY)]
    }
    for limb, name in enumerate(chains.limb_names):
        shade = LIMBS[limb % len(LIMBS)]
        for k in range(int(chains.n_joints[limb])):
            radius, end = max(float(chains.radius[limb, k]), 0.005), chains.offset[limb, k + 1]
            link = [rod(np.zeros(3), end, radius, shade)] if float(np.linalg.norm(end)) > 1e-6 else []
            shapes[_link(name, k)] = [ball(1.2 * radius, shade), *link]
        shapes[f"{name} tip"] = [ball(0.012, shade)]
    return shapes
