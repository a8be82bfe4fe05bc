"""Joints over time: as CSV, and in the field names of ROS 2's `trajectory_msgs/msg/JointTrajectory`."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from ..errors import SpecError
from ..execution.log import Log
from ..family import NotOfFamilyError, family_of
from ..files import csv_text
from ..planning.problem.problem import Replay
from ..types import Floats, Json

NANO: Final = 1_000_000_000
FRAME: Final = "world"
"""`header.frame_id`; joints have none of their own."""
QUANTITIES: Final = {
    "positions": ("position", "rad", "m"),
    "velocities": ("velocity", "rad/s", "m/s"),
    "accelerations": ("acceleration", "rad/s^2", "m/s^2"),
    "effort": ("effort", "N m", "N"),
}
"""Field of a point -> its word in a column's title, its unit for turning and for sliding joints."""


@dataclass(frozen=True, slots=True, eq=False)
class JointTrajectory:
    """Joints at `rows` moments. What is not known is None, as the message leaves such lists empty."""

    names: tuple[str, ...]
    """Of the joints, as the exported robot calls them."""
    sliding: tuple[bool, ...]
    """Whether each slides [m, N], or turns [rad, N m]."""
    time: Floats
    """Since the start, rising, shape (rows,) [s]."""
    positions: Floats
    """Shape (rows, joints)."""
    velocities: Floats | None = None
    accelerations: Floats | None = None
    effort: Floats | None = None

    def to_json(self) -> Json:
        """The message as plain data."""
        stamps = [round(float(time) * NANO) for time in self.time]
        lists = {field: None if values is None else values.tolist() for field, values in self._fields().items()}
        return {
            "header": {"stamp": {"sec": 0, "nanosec": 0}, "frame_id": FRAME},
            "joint_names": list(self.names),
            "points": [
                {field: [] if values is None else values[k] for field, values in lists.items()}
                | {"time_from_start": {"sec": stamp // NANO, "nanosec": stamp % NANO}}
                for k, stamp in enumerate(stamps)
            ],
        }

    def to_csv(self) -> str:
        """A table with a row for each moment; titles name joint, quantity and unit."""
        titles, columns = ["time [s]"], [self.time]
        for field, values in self._fields().items():
            word, turning, along = QUANTITIES[field]
            if values is None:
                continue
            for k, (name, slides) in enumerate(zip(self.names, self.sliding, strict=True)):
                titles.append(f"{name} {word} [{along if slides else turning}]")
                columns.append(values[:, k])
        return csv_text([titles, *np.column_stack(columns).tolist()])

    def _fields(self) -> dict[str, Floats | None]:
        return {field: getattr(self, field) for field in QUANTITIES}


def moved(
    names: tuple[str, ...],
    sliding: tuple[bool, ...],
    time: Floats,
    positions: Floats,
    label: str,
    effort: Floats | None = None,
) -> JointTrajectory:
    """A trajectory of samples: velocities and accelerations are their central differences.

    Args:
        names: Of the joints.
        sliding: Whether each slides.
        time: Of the samples, shape (rows,) [s].
        positions: Shape (rows, joints).
        label: What errors call the samples' file.
        effort: Torques and forces, shape (rows, joints); None: not known.

    Raises:
        SpecError: If there are fewer than two samples, or their times do not rise.
    """
    if len(time) < 2 or not np.all(np.diff(time) > 0.0):
        allowed = "must hold two samples or more, each later than the one before"
        raise SpecError(label, "time", len(time), allowed)
    velocities = np.gradient(positions, time, axis=0)
    return JointTrajectory(
        names, sliding, time - time[0], positions, velocities, np.gradient(velocities, time, axis=0), effort
    )


def resting(
    names: tuple[str, ...], sliding: tuple[bool, ...], time: Floats, positions: Floats, effort: Floats | None
) -> JointTrajectory:
    """A trajectory that is at rest in all of its points; arguments as `moved` takes them."""
    still = np.zeros_like(positions)
    return JointTrajectory(names, sliding, time, positions, still, still, effort)


@dataclass(frozen=True, slots=True)
class Trajectories:
    """What makes joint trajectories of a family's plans and runs."""

    plan: Callable[[Any, Replay], JointTrajectory]
    """Of a task and a plan's replay."""
    note: str
    """That only logs of its runs have."""
    run: Callable[[Log], JointTrajectory]
    """Of a log."""
    contacts: Callable[[Any, Replay], Json] | None = None
    """Contact sequence of a task and a plan's replay, as plain data; None: the family exports none."""


def _body_over_plan(task: Any, replay: Replay) -> JointTrajectory:
    """The body's pose after each action; an action takes a second where the model has no time."""
    plans = family_of(task).plans
    poses = np.array([plans.pose(task, stance) for stance in replay.stances])
    time = np.arange(len(poses), dtype=np.float64) * (plans.duration(task) or 1.0)
    names = tuple(f"body_{'angle' if axis.name == 'theta' else axis.name}" for axis in plans.pose_axes)
    return resting(names, tuple(axis.unit == "m" for axis in plans.pose_axes), time, poses, None)


def _no_runs(log: Log) -> JointTrajectory:
    raise NotOfFamilyError("robot of this log", "joint trajectories")


BODY: Final = Trajectories(_body_over_plan, "", _no_runs)
"""Of families that say nothing of joints."""
