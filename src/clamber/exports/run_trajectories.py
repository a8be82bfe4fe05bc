"""Joint trajectories of runs, from their logs: what the encoders read and the motors were asked for."""

from pathlib import Path

from ..execution.log import LogError
from ..execution.log_files import read_log
from ..family import families
from .joint_trajectory import JointTrajectory


def run_trajectory(path: Path) -> JointTrajectory:
    """The joints of a run, from the log of `clamber run -o`.

    Raises:
        FileError: If the file cannot be read.
        LogError: If it is no log of a run.
    """
    log = read_log(path, None)
    for family in families():
        trajectories = family.trajectories
        if trajectories is not None and trajectories.note in log.notes:
            return trajectories.run(log)
    raise LogError(log.label, None, None, None, "is no log of a run; `clamber run PLAN -o run.mcap` writes one")
