"""Poses and places of the body as tables: what the stances at each have in common, at best and at worst."""

import csv
import io
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from ...types import Floats, Ints
from ..problem.body_pose import PoseLattice
from .exploration import Exploration

Columns = dict[str, npt.NDArray[np.generic]]


@dataclass(frozen=True, slots=True, kw_only=True)
class Table:
    """One row per pose, or per place, that the body can reach, in the order of the lattice."""

    lattice: Ints
    """Steps from the start along each axis of poses, or the first two of places; shape (n, axes) or (n, 2)."""
    columns: Mapping[str, npt.NDArray[np.generic]]
    """Name, with its unit at the end, -> values, shape (n,): the axes of poses, such as `x_m`, `y_m`, `theta_rad`,
    and the first two of places, `stances`, `angles` of places (`poses` where more than angles differ), `first_step`, `least_` and
    `most_` of each cost of the family's stances (not a number where no stance has one), `margin`, `margin_check`."""

    def __len__(self) -> int:
        return len(self.lattice)

    def floats(self, column: str) -> Floats:
        """One column of numbers."""
        return self.columns[column].astype(np.float64)

    def to_json(self) -> dict[str, list[float | int | str | None]]:
        """Plain data: column -> list; null where there is no number, "inf" where nothing limits."""
        return {name: [_plain(value) for value in values.tolist()] for name, values in self.columns.items()}

    def to_csv(self) -> str:
        """The rows as CSV, numbers in full."""
        text = io.StringIO()
        table = csv.writer(text, lineterminator="\n")
        table.writerow(self.columns)
        rows = zip(*(values.tolist() for values in self.columns.values()), strict=True)
        table.writerows(["" if value != value else value for value in row] for row in rows)
        return text.getvalue()


def _plain(value: Any) -> Any:
    if isinstance(value, float) and not math.isfinite(value):
        return None if math.isnan(value) else "inf" if value > 0 else "-inf"
    return value


def pose_table(
    seen: Exploration,
    stance_costs: tuple[str, ...],
    checks: tuple[str, ...],
    lattice: PoseLattice,
) -> Table:
    """The poses that the body can reach.

    Args:
        seen: The exploration.
        stance_costs: Names of what being in a stance costs.
        checks: Names of the checks.
        lattice: The lattice of the body's poses.
    """
    reached = np.flatnonzero(seen.notes["stances"] > 0)
    order = reached[np.lexsort(seen.poses[reached].T[::-1])]
    steps, notes = seen.poses[order].astype(np.int32), seen.notes[order]
    columns: Columns = {axis.column: lattice.values(steps, k) for k, axis in enumerate(lattice.axes)}
    columns |= {"stances": notes["stances"], "first_step": notes["depth"]}
    for k, name in enumerate(stance_costs):
        none = notes["low"][:, k] > notes["high"][:, k]
        columns[f"least_{name}"] = np.where(none, np.nan, notes["low"][:, k])
        columns[f"most_{name}"] = np.where(none, np.nan, notes["high"][:, k])
    columns["margin"] = notes["room"]
    columns["margin_check"] = np.array([*checks, ""])[notes["closest"]]
    return Table(lattice=steps, columns=columns)


def place_table(poses: Table, axes: PoseLattice) -> Table:
    """The places of the poses: the same over all poses there."""
    lattice, first = np.unique(poses.lattice[:, :2], axis=0, return_index=True)  # the poses are in this order, too
    columns: Columns = {}
    for name, values in poses.columns.items():
        if name == "stances":
            columns["angles" if axes.turns_alone else "poses"] = np.diff(np.append(first, len(poses)))
            columns[name] = np.add.reduceat(values.astype(np.int64), first)
        elif name == "margin":
            ends = np.append(first[1:], len(poses))
            best = np.array([a + int(np.argmax(values[a:b])) for a, b in zip(first, ends, strict=True)])
            columns |= {name: values[best], "margin_check": poses.columns["margin_check"][best]}
        elif name == "first_step" or name.startswith("least_"):
            columns[name] = np.fmin.reduceat(values, first)
        elif name.startswith("most_"):
            columns[name] = np.fmax.reduceat(values, first)
        elif name in [axis.column for axis in axes.axes[:2]]:
            columns[name] = values[first]
    return Table(lattice=lattice, columns=columns)


@dataclass(frozen=True, slots=True, kw_only=True)
class Rim:
    """Places next to the map that the body can't get to, though a reachable stance could try."""

    lattice: Ints
    """Steps from the start along the first two axes, shape (n, 2)."""
    checks: tuple[str, ...]
    """Names of the checks."""
    forbidden: Ints
    """Body moves there that each check forbids, shape (n, n_checks)."""


def rim_of(seen: Exploration, places: Table, checks: tuple[str, ...]) -> Rim:
    """The rim of the places."""
    tried = np.flatnonzero(seen.notes["stances"] == 0)
    spots, where = np.unique(seen.poses[tried, :2], axis=0, return_inverse=True)
    forbidden = np.zeros((len(spots), len(checks)), np.int32)
    np.add.at(forbidden, where.ravel(), seen.notes["forbidden"][tried, : len(checks)])
    known = set(map(tuple, places.lattice.tolist()))
    outside = np.array([tuple(body_pose) not in known for body_pose in spots.tolist()], bool)
    return Rim(lattice=spots[outside].astype(np.int32), checks=checks, forbidden=forbidden[outside])
