"""One hold more, and where: places on a lattice of the board, each settled by exact search (`planning/infeasibility/places.py`)."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from ....planning.infeasibility.find import Places
from ....planning.infeasibility.places import PER_LIMB, opening, reached_poses, settle_each, smallest_radius
from ....planning.infeasibility.trial import Trial
from ....planning.problem.problems import pose_problem
from ....toml_text import toml_value
from ....types import Floats
from ....units import UNITS, split_quantity
from .task import LimbedTask


@dataclass(frozen=True, slots=True)
class _Site:
    column: int
    row: int
    x: float
    y: float


def find_places(
    trial: Trial, near: tuple[float, float], *, spacing: float | None, threads: int
) -> tuple[Places | None, bool]:
    """Where one hold more opens a climber's task.

    Args:
        trial: Of the task.
        near: Where the furthest stance is [m]; places near it are tried first.
        spacing: Of the lattice, which goes through the task's start [m]; None: a quarter of the shortest limb, in whole steps.
        threads: Places tried at once; the answer doesn't depend on it.

    Returns:
        The places, and whether Ctrl-C ended it; None where the poses that can be reached are too many to be seen.
    """
    task: Any = trial.task
    step = task.step.length
    quarter = min(limb.length for limb in task.robot.limbs) / PER_LIMB
    wide = max(1, round(quarter / step)) * step if spacing is None else spacing
    reached = reached_poses(trial, pose_problem(task, threads=1).problem, threads)
    if reached is None:
        return None, trial.stopped.is_set()
    sites = sorted(
        _sites(task, reached, wide), key=lambda site: (math.hypot(site.x - near[0], site.y - near[1]), site.row, site.column)
    )  # fmt: skip
    trial.grant(1.0)
    overrides = [_override(task, site) for site in sites]
    answers = settle_each(trial, overrides, threads)
    opened = [
        (site, override, answer)
        for site, override, answer in zip(sites, overrides, answers, strict=False)
        if answer.status == "open"
    ]
    found = {(site.column, site.row) for site, _, _ in opened}
    opened.sort(key=lambda item: (len(item[2].codes), -_company(item[0], found)))
    openings = tuple(
        opening("board.added", f"at {', '.join(_written(task, site))}", override, answer)
        for site, override, answer in opened
    )
    settled = sum(answer.status != "unsettled" for answer in answers)
    return Places(openings=openings, spacing=wide, places=len(sites), tried=settled), trial.stopped.is_set()


def _sites(task: LimbedTask, poses: Floats, wide: float) -> Iterator[_Site]:
    """Places of the lattice that some limb could grab from some pose, and that overlap no hold."""
    from scipy.spatial import cKDTree  # takes a tenth of a second to import

    c, s = np.cos(poses[:, 2]), np.sin(poses[:, 2])
    # A hang leaves the body between the poses of the lattice, and these are rounded
    off = 0.0 if task.rules.max_hangs == 0 and "hangs" in task.rules.hard else 1.0
    slack = 1e-9 + off * (task.step.length + 0.5 * task.step.angle * task.robot.longest_reach)
    found: set[tuple[int, int]] = set()
    for limb in task.robot.limbs:
        ports = poses[:, :2] + np.stack([c * limb.port_x - s * limb.port_y, s * limb.port_x + c * limb.port_y], axis=1)
        reach = limb.length - task.rules.reach_offset + slack
        low = np.ceil((ports.min(axis=0) - reach - (task.start.x, task.start.y)) / wide).astype(int)
        high = np.floor((ports.max(axis=0) + reach - (task.start.x, task.start.y)) / wide).astype(int)
        columns, rows = np.meshgrid(np.arange(low[0], high[0] + 1), np.arange(low[1], high[1] + 1))
        lattice = np.stack([columns.ravel(), rows.ravel()], axis=1)
        if not len(lattice):
            continue
        points = np.array((task.start.x, task.start.y)) + wide * lattice
        away, _ = cKDTree(np.unique(np.round(ports, 9), axis=0)).query(points)
        found |= {(int(column), int(row)) for column, row in lattice[away <= reach]}
    radius = smallest_radius(task)
    for column, row in sorted(found):
        x, y = task.start.x + column * wide, task.start.y + row * wide
        if all(math.hypot(hold.x - x, hold.y - y) >= hold.radius + radius for hold in task.world.holds):
            yield _Site(column, row, x, y)


def _override(task: LimbedTask, site: _Site) -> str:
    """The board with a hold more, as an override; lengths in the unit of the task's step."""
    raw = task.document["board"]
    x, y = _written(task, site)
    hold = {"number": 1 + max(hold.number for hold in task.world.holds), "x": x, "y": y}
    if raw.get("hold_radius") is None:
        hold["radius"] = f"{smallest_radius(task):.10g} m"
    return f"board.added={toml_value([*raw.get('added', []), hold])}"


def _written(task: LimbedTask, site: _Site) -> tuple[str, str]:
    unit = _unit(task)
    size = UNITS["length"][unit]
    return f"{site.x / size:.9g} {unit}", f"{site.y / size:.9g} {unit}"


def _unit(task: LimbedTask) -> str:
    """The unit in which the task's step is written."""
    raw = task.document["step"]["length"]
    parts = split_quantity(raw) if isinstance(raw, str) else (0.0, raw.get("unit", ""))
    unit = "" if parts is None else str(parts[1])
    return unit if unit in UNITS["length"] else "m"


def _company(site: _Site, found: set[tuple[int, int]]) -> int:
    """How many places beside it open the task, too."""
    return sum((site.column + i, site.row + j) in found for i in (-1, 0, 1) for j in (-1, 0, 1))
