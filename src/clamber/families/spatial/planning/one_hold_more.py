"""One hold more, and where on the guide: places of a lattice, each settled by exact search (`planning/infeasibility/places.py`)."""

import math
from typing import Any

import numpy as np

from ....planning.infeasibility.find import Places
from ....planning.infeasibility.places import PER_LIMB, opening, reached_poses, settle_each, smallest_radius
from ....planning.infeasibility.trial import Trial
from ....planning.problem.problems import pose_problem
from ....toml_text import toml_value
from ....types import Floats
from .task import SpatialTask

Site = tuple[float, float, float]
"""Along, across and height over the guide [m]."""


def find_places(
    trial: Trial, near: tuple[float, float], *, spacing: float | None, threads: int
) -> tuple[Places | None, bool]:
    """Where one hold more, its normal that of the guide, opens a task of a robot in space.

    Args:
        trial: Of the task.
        near: Along and across where the furthest stance is [m]; places near it are tried first.
        spacing: Of the lattice, which goes through the task's start [m]; None: a quarter of the longest limb, in whole steps.
        threads: Places tried at once; the answer doesn't depend on it.

    Returns:
        The places, and whether Ctrl-C ended it; None where the poses that can be reached are too many to be seen.
    """
    task: Any = trial.task
    problem: Any = pose_problem(task, threads=1).problem
    size = float(problem.params.array("robot")["size"][0])
    wide = max(1, round(size / PER_LIMB / task.step.length)) * task.step.length if spacing is None else spacing
    reached = reached_poses(trial, problem, threads)
    if reached is None:
        return None, trial.stopped.is_set()
    poses = np.unique(reached[:, :2], axis=0)  # along and across come first
    sites = _sites(task, problem, poses, wide)
    sites.sort(key=lambda site: (math.dist(site[:2], near), site))
    trial.grant(1.0)
    overrides = [_override(task, site) for site in sites]
    answers = settle_each(trial, overrides, threads)
    opened = [
        (site, override, answer)
        for site, override, answer in zip(sites, overrides, answers, strict=False)
        if answer.status == "open"
    ]
    opened.sort(key=lambda item: len(item[2].codes))
    openings = tuple(opening("world.patterns", _in_words(site), override, answer) for site, override, answer in opened)
    settled = sum(answer.status != "unsettled" for answer in answers)
    return Places(openings=openings, spacing=wide, places=len(sites), tried=settled), trial.stopped.is_set()


def _sites(task: SpatialTask, problem: Any, poses: Floats, wide: float) -> list[Site]:
    """Places of the lattice in reach of poses that can be reached, as high as the hold that is nearest, none on a hold."""
    holds = problem.params.array("holds")
    taken = np.column_stack((holds["along"], holds["across"]))
    reach = float(problem.params.array("spans").max())
    start = np.array((task.start.along, task.start.across))
    low = np.ceil((poses.min(axis=0) - reach - start) / wide).astype(int)
    high = np.floor((poses.max(axis=0) + reach - start) / wide).astype(int)
    sites = []
    for i in range(low[0], high[0] + 1):
        for j in range(low[1], high[1] + 1):
            at = start + wide * np.array((i, j))
            away = np.linalg.norm(taken - at, axis=1)
            beside = int(away.argmin())
            if np.linalg.norm(poses - at, axis=1).min() <= reach and away[beside] >= 2.0 * smallest_radius(task):
                sites.append((float(at[0]), float(at[1]), float(holds["height"][beside])))
    return sites


def _override(task: SpatialTask, site: Site) -> str:
    """The world with a pattern of one hold more, numbered after all others, as an override."""
    along, across, height = (f"{value:.9g} m" for value in site)
    hold = {"along": [along, along], "across": [across, across], "spacing": "1 m", "height": height}
    hold["radius"] = f"{smallest_radius(task):.9g} m"
    return f"world.patterns={toml_value([*task.document['world'].get('patterns', []), hold])}"


def _in_words(site: Site) -> str:
    return f"a hold at along {site[0]:.4g} m, across {site[1]:.4g} m, height {site[2]:.3g} m"
