"""One hold more, and where on the guide: places of a lattice, each settled by exact search in the world with a hold there.

As for climbers, a plan that the added hold opens must take it, and only stances that can be reached without it come before that. So only
places count that lie in reach from a pose of the body that can be reached.
"""

import math
from concurrent.futures import ThreadPoolExecutor
from typing import Any, Final

import numpy as np

from ....planning.infeasibility.find import FeasibleRelaxation, Places
from ....planning.infeasibility.trial import Answer, Trial
from ....planning.problem.problems import normalisation_of, plan_family, pose_problem
from ....planning.reach.exploration import explore_breadth_first
from ....toml_text import toml_value
from ....types import Floats
from .task import SpatialTask

PER_LIMB: Final = 4
"""Unless told otherwise, the lattice is as wide as the longest limb over this, in whole steps of the task."""
SHARE: Final = 0.25
"""Of the time, at most this much goes into seeing every pose that can be reached [-]."""
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
    trial.grant(SHARE)
    problem: Any = pose_problem(task, threads=1).problem
    size = float(problem.params.array("robot")["size"][0])
    wide = max(1, round(size / PER_LIMB / task.step.length)) * task.step.length if spacing is None else spacing
    lattice = plan_family(task).lattice(task, problem)
    seen = explore_breadth_first(
        problem,
        normalisation_of(task),
        lattice,
        holds=len(task.world.holds),
        threads=threads,
        most_stances=trial.max_stances,
        seconds=trial.granted(),
    )
    if seen.ended:
        return None, seen.ended == "interrupt"
    steps = seen.poses[seen.notes["stances"] > 0]
    poses = np.unique((lattice.origin + steps * lattice.step)[:, :2], axis=0)  # along and across come first
    sites = _sites(task, problem, poses, wide)
    sites.sort(key=lambda site: (math.dist(site[:2], near), site))
    trial.grant(1.0)
    answers: list[Answer] = []
    with ThreadPoolExecutor(threads, thread_name_prefix="clamber") as pool:
        asked = [pool.submit(trial.settle, (_override(task, site),), threads) for site in sites]
        try:
            answers += (future.result() for future in asked)
        except KeyboardInterrupt:
            trial.stopped.set()
            pool.shutdown(cancel_futures=True)
    opened = [(site, answer) for site, answer in zip(sites, answers, strict=False) if answer.status == "open"]
    opened.sort(key=lambda item: len(item[1].codes))
    openings = tuple(_opening(task, site, answer) for site, answer in opened)
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
            if np.linalg.norm(poses - at, axis=1).min() <= reach and away[beside] >= 2.0 * _radius(task):
                sites.append((float(at[0]), float(at[1]), float(holds["height"][beside])))
    return sites


def _radius(task: SpatialTask) -> float:
    """Of the added hold [m]: that of the smallest there is."""
    return min(hold.radius for hold in task.world.holds)


def _override(task: SpatialTask, site: Site) -> str:
    """The world with a pattern of one hold more, numbered after all others, as an override."""
    along, across, height = (f"{value:.9g} m" for value in site)
    hold = {"along": [along, along], "across": [across, across], "spacing": "1 m", "height": height}
    hold["radius"] = f"{_radius(task):.9g} m"
    return f"world.patterns={toml_value([*task.document['world'].get('patterns', []), hold])}"


def _opening(task: SpatialTask, site: Site, answer: Answer) -> FeasibleRelaxation:
    return FeasibleRelaxation(
        key="world.patterns",
        before=None,
        after=f"a hold at along {site[0]:.4g} m, across {site[1]:.4g} m, height {site[2]:.3g} m",
        unit="",
        overrides=(_override(task, site),),
        length=len(answer.codes),
        shortest=answer.shortest,
        least=True,
    )
