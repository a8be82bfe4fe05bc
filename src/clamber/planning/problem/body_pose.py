"""A body's pose in any number of coordinates, and the lattice that body moves keep it on."""

from dataclasses import dataclass
from typing import Any, Final, Literal, NamedTuple

import numpy as np

from ...shown_units import ShownUnits
from ...types import Floats, Ints
from ...units import DEGREE


class PoseAxis(NamedTuple):
    """One coordinate of a body's pose."""

    name: str
    unit: Literal["m", "rad"]

    @property
    def column(self) -> str:
        """Name with its unit, as files and tables have it."""
        return f"{self.name}_{self.unit}"


PLANE: Final = (PoseAxis("x", "m"), PoseAxis("y", "m"), PoseAxis("theta", "rad"))
SPACE: Final = (
    PoseAxis("along", "m"), PoseAxis("across", "m"), PoseAxis("height", "m"),
    PoseAxis("yaw", "rad"), PoseAxis("pitch", "rad"), PoseAxis("roll", "rad"),
)  # fmt: skip


def axis_names(number: int) -> tuple[str, ...]:
    """Names of so many coordinates, for those who do not know whose they are."""
    axes = next((axes for axes in (PLANE, SPACE) if len(axes) == number), None)
    return tuple(f"axis {k + 1} " for k in range(number)) if axes is None else tuple(axis.name for axis in axes)


def named_pose(axes: tuple[PoseAxis, ...], pose: tuple[float, ...]) -> dict[str, float]:
    """A pose as plain data: each coordinate, named with its unit [m] or [rad]."""
    return {axis.column: value for axis, value in zip(axes, pose, strict=True)}


def on_map(axes: tuple[PoseAxis, ...], pose: tuple[float, ...]) -> tuple[float, float, float]:
    """Where a body is on a map: the first two coordinates [m] and the first angle [rad], 0 where there is none."""
    return pose[0], pose[1], next((value for axis, value in zip(axes, pose, strict=True) if axis.unit == "rad"), 0.0)


def describe_body_pose(axes: tuple[PoseAxis, ...], pose: tuple[float, ...], units: ShownUnits) -> str:
    """A pose in words: each coordinate with its name, lengths in the unit of places, angles in degrees."""
    shown = (
        units.length(value) if axis.unit == "m" else f"{value / DEGREE + 0.0:.1f} deg"
        for axis, value in zip(axes, pose, strict=True)
    )
    return ", ".join(f"{axis.name} {text}" for axis, text in zip(axes, shown, strict=True))


@dataclass(frozen=True, slots=True, kw_only=True)
class PoseLattice:
    """The poses that body moves lead to from a task's start: a whole number of steps along each axis."""

    axes: tuple[PoseAxis, ...]
    """At least two: maps are drawn over the first two."""
    origin: Floats
    """The start's pose [m] or [rad], shape (n,)."""
    step: Floats
    """[m] or [rad], shape (n,)."""
    period: Ints
    """Steps of a whole turn, 0 for axes that do not come round, shape (n,)."""

    def values(self, steps: Ints, axis: int) -> Floats:
        """One coordinate [m] of points of the lattice, shape (m, n), or [rad] in (-pi, pi]; shape (m,)."""
        along: Floats = self.origin[axis] + steps[:, axis] * self.step[axis]
        return along if self.axes[axis].unit == "m" else np.pi - np.mod(np.pi - along, 2.0 * np.pi)

    @property
    def turns_alone(self) -> bool:
        """Whether only angles tell apart poses at one place of a map."""
        return all(axis.unit == "rad" for axis in self.axes[2:])


def plane_lattice(task: Any, turn_steps: int) -> PoseLattice:
    """The lattice of a task in a plane, with `start.x`, `.y`, `.theta` and `step.length`, `.angle`.

    Args:
        task: The task.
        turn_steps: Steps of angle in a whole turn.
    """
    start, step = task.start, task.step
    return PoseLattice(
        axes=PLANE,
        origin=np.array((start.x, start.y, start.theta)),
        step=np.array((step.length, step.length, step.angle)),
        period=np.array((0, 0, turn_steps), np.int64),
    )
