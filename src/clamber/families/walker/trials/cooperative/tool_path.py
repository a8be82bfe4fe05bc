"""The path that a tool is to follow: columns x, y, z and perhaps t of a file, as a smooth curve over time."""

from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Final

import numpy as np
from scipy.interpolate import PchipInterpolator

from .....control.quintic import quintic_share
from .....errors import UnitError, UnknownNameError, describe_choices
from .....execution.log import Log, LogError
from .....execution.log_files import read_log
from .....regular_files import user_path
from .....types import Floats
from .....units import UNITS, convert, si_unit

DATA: Final = Path(__file__).parents[2] / "data" / "paths"
PLACES: Final = ("x", "y", "z")
TIME: Final = "t"
LARGEST: Final = 1e3
"""No coordinate may be larger [m]."""
FINE: Final = 24
"""Pieces between two points, by which the way along the curve is measured."""
PEAK: Final = 1.875
"""Largest speed of a motion from rest to rest by the quintic law, over its mean."""


@dataclass(frozen=True, slots=True, eq=False)
class ToolPath:
    """A curve through points, as a function of time."""

    label: str
    """What errors call it: the file's path."""
    points: Floats
    """World [m], shape (points, 3)."""
    times: Floats | None
    """When the tool is to be there [s], shape (points,), from 0; None if the file leaves that open."""
    notes: tuple[str, ...] = ()
    """What had to be assumed."""

    @property
    def length(self) -> float:
        """From point to point [m]."""
        return float(np.linalg.norm(np.diff(self.points, axis=0), axis=1).sum())

    def sample(self, speed: float) -> "TimedPath":
        """The path over time.

        Args:
            speed: Largest of the tool where the file has no times [m/s]; then it starts and ends at rest.
        """
        if self.times is not None:
            return TimedPath(PchipInterpolator(self.times, self.points), float(self.times[-1]), False)
        rough = PchipInterpolator(_ways(self.points), self.points)
        knots = [np.linspace(a, b, FINE, endpoint=False) for a, b in pairwise(rough.x)]
        dense = rough(np.append(np.concatenate(knots), rough.x[-1]))
        ways = _ways(dense)
        return TimedPath(PchipInterpolator(ways, dense), PEAK * float(ways[-1]) / speed, True)


def _ways(points: Floats) -> Floats:
    """Way from the first point to each [m]."""
    out: Floats = np.concatenate([[0.0], np.linalg.norm(np.diff(points, axis=0), axis=1).cumsum()])
    return out


@dataclass(frozen=True, slots=True, eq=False)
class TimedPath:
    """Place and velocity by time."""

    curve: PchipInterpolator
    lasts: float
    """[s]."""
    by_way: bool
    """Whether the curve's parameter is the way along it, run through from rest to rest; else it is time."""

    def at(self, time: float) -> tuple[Floats, Floats]:
        """Place [m] and velocity [m/s], each of shape (3,), at a time [s]; at rest before the start and after the end."""
        u = min(1.0, max(0.0, time / self.lasts)) if self.lasts > 0.0 else 1.0
        if self.by_way:
            end = float(self.curve.x[-1])
            way = end * quintic_share(u)
            rate = 0.0 if self.lasts == 0.0 else end * 30.0 * u * u * (1.0 - u) * (1.0 - u) / self.lasts
            return self.curve(way), self.curve(way, 1) * rate
        moving = 0.0 <= time <= self.lasts
        return self.curve(u * self.lasts), self.curve(u * self.lasts, 1) * (1.0 if moving else 0.0)


def path_names() -> tuple[str, ...]:
    """Names of the shipped paths."""
    return tuple(sorted(path.stem for path in DATA.glob("*.csv")))


def load_tool_path(name_or_file: str) -> ToolPath:
    """A shipped path by name, or one from a file (.csv, .mcap) with columns x, y, z and perhaps t, each with its unit: `x [mm]`.

    Raises:
        UnknownNameError: If it looks like a name and no shipped path has it.
        FileError: If it cannot be read.
        LogError: If it is no path.
    """
    if Path(name_or_file).suffix or "/" in name_or_file:
        return path_of(read_log(user_path(name_or_file)))
    if name_or_file not in path_names():
        raise UnknownNameError("tool path", name_or_file, path_names())
    return path_of(read_log(DATA / f"{name_or_file}.csv"), name_or_file)


def path_of(log: Log, label: str | None = None) -> ToolPath:
    """A path from a log's columns.

    Raises:
        LogError: If a column is missing or unknown, its unit is none of a length or a time, a coordinate is too large, two points that
            follow each other are the same, or times do not increase.
    """
    for name in log.columns:
        if name not in (*PLACES, TIME):
            allowed = f"no such column of a path; there are {describe_choices(name, (*PLACES, TIME))}"
            raise LogError(log.label, name, None, None, allowed)
    notes: list[str] = []
    points = np.column_stack([_in_si(log, name, "length", notes) for name in PLACES])
    far = np.argwhere(np.abs(points) > LARGEST)
    if far.size:
        row, column = far[0]
        allowed = f"must be within {LARGEST:g} m"
        raise LogError(log.label, PLACES[column], int(row) + 1, f"{points[row, column]:.6g} m", allowed)
    if len(points) < 2:
        raise LogError(log.label, None, None, "1 row", "must have two points or more")
    if TIME not in log.columns:
        same = np.flatnonzero((np.diff(points, axis=0) == 0.0).all(axis=1))
        if same.size:
            raise LogError(log.label, None, int(same[0]) + 2, None, "must be another point than the row before")
        return ToolPath(label or log.label, points, None, tuple(notes))
    times = _in_si(log, TIME, "time", notes)
    back = np.flatnonzero(~(np.diff(times) > 0.0))
    if back.size:
        k = int(back[0])
        allowed = f"must be later than the row before, {times[k]:.9g} s"
        raise LogError(log.label, TIME, k + 2, f"{times[k + 1]:.9g} s", allowed)
    return ToolPath(label or log.label, points, times - times[0], tuple(notes))


def _in_si(log: Log, column: str, dimension: str, notes: list[str]) -> Floats:
    values = log.column(column)
    unit = log.units.get(column)
    if unit is None:
        unit = si_unit(dimension)
        notes.append(f"column '{column}' states no unit: read as {unit}")
    try:
        size = convert(1.0, unit, dimension)
    except UnitError:
        allowed = f"is no unit of {dimension}; allowed are {describe_choices(unit, UNITS[dimension])}"
        raise LogError(log.label, column, None, f"[{unit}]", allowed) from None
    out: Floats = values * size
    return out
