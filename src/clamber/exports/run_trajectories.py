"""Joint trajectories of runs, from their logs: what the encoders read and the motors were asked for."""

from collections.abc import Callable
from pathlib import Path
from typing import Final

import numpy as np

from ..execution.climb.climb_trace import JOINTS, ClimbTrace
from ..execution.log import Log, LogError
from ..execution.log_files import read_log
from ..execution.walk.walk_trace import LEG_NAMES, WalkTrace
from ..robots.walker import FRAMES
from .joint_trajectory import JointTrajectory, moved

PLACE: Final = ("slide_x", "slide_y", "turn")
"""Joints of the Y-frame in the Delta-frame, as the exported robot calls them."""
ACTUATORS: Final = tuple(f"actuator_{k}" for k in range(3))
LEGS: Final = tuple(f"{frame}_leg_{k}" for frame in FRAMES for k in range(3))


def climb_trajectory(log: Log) -> JointTrajectory:
    """The joints of a climb: angles by the encoders, torques as commanded, before motors saturate."""
    trace = ClimbTrace.from_log(log)
    rows, names = len(trace.time), tuple(f"{limb}_{joint}" for limb in trace.limbs for joint in JOINTS)
    flat = (array.reshape(rows, -1) for array in (trace.angles, trace.torques))
    angles, torques = flat
    return moved(names, (False,) * len(names), trace.time, angles, log.label, torques)


def walk_trajectory(log: Log) -> JointTrajectory:
    """The joints of a walk: the Y-frame in the Delta-frame as believed, legs as sensed, actuators as commanded."""
    trace = WalkTrace.from_log(log)
    assert len(LEGS) == len(LEG_NAMES)
    names = (*PLACE, *LEGS, *ACTUATORS)
    positions = np.hstack([trace.place, trace.lengths, trace.actuators])
    return moved(names, tuple(name != PLACE[2] for name in names), trace.time, positions, log.label)


KINDS: Final[dict[str, Callable[[Log], JointTrajectory]]] = {"limbs": climb_trajectory, "walker": walk_trajectory}
"""Note that only logs of a kind have -> what makes a trajectory of them."""


def run_trajectory(path: Path) -> JointTrajectory:
    """The joints of a run, from the log of `clamber run -o`.

    Raises:
        FileError: If the file cannot be read.
        LogError: If it is no log of a run.
    """
    log = read_log(path, None)
    for note, make in KINDS.items():
        if note in log.notes:
            return make(log)
    raise LogError(log.label, None, None, None, "is no log of a run; `clamber run PLAN -o run.mcap` writes one")
