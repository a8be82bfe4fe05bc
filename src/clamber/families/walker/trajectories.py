"""Joint trajectories of walkers: of plans and of runs."""

import math
from typing import Final

import numpy as np

from ...execution.log import Log
from ...exports.joint_trajectory import JointTrajectory, Trajectories, moved, resting
from ...planning.problem.problem import Replay
from .execution.walk_trace import WalkTrace
from .planning.problem import outline
from .planning.task import WalkerTask
from .robot import FRAMES
from .robot.plane_poses import seen_from

PLACE: Final = ("slide_x", "slide_y", "turn")
"""Joints of the Y-frame in the Delta-frame, as the exported robot calls them."""

ACTUATORS: Final = tuple(f"actuator_{k}" for k in range(3))

LEGS: Final = tuple(f"{frame}_leg_{k}" for frame in FRAMES for k in range(3))


def walk_trajectory(log: Log) -> JointTrajectory:
    """The joints of a walk: the Y-frame in the Delta-frame as believed, legs as sensed, actuators as commanded."""
    trace = WalkTrace.from_log(log)
    names = (*PLACE, *LEGS, *ACTUATORS)
    positions = np.hstack([trace.place, trace.lengths, trace.actuators])
    return moved(names, tuple(name != PLACE[2] for name in names), trace.time, positions, log.label)


def walk_stances(task: WalkerTask, replay: Replay) -> JointTrajectory:
    """Joints of a walker: the Y-frame in the Delta-frame, and the actuators that move it; plans say nothing of legs."""
    rows = []
    for stance in replay.stances:
        x, y, turn = seen_from(*stance["pose"])
        ends = outline(task, stance).actuators
        lengths = np.hypot(*(ends[:, 1] - ends[:, 0]).T)
        rows.append((x, y, math.remainder(turn, math.tau), *lengths))
    names = (*PLACE, *ACTUATORS)
    time = np.cumsum(replay.stances["duration"])
    return resting(names, tuple(name != PLACE[2] for name in names), time - time[0], np.array(rows), None)


TRAJECTORIES: Final = Trajectories(walk_stances, "walker", walk_trajectory)
