"""The first stance of a task in space: on the holds that its file names, or on those on which the robot stands best."""

import math
from itertools import product
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from ....errors import SpecError
from ....planning.problem.arrays import Params
from ....planning.problem.problem import Records
from ....types import Floats, Ints
from .checks import SPATIAL_CHECKS
from .records import HEIGHT, STANCE
from .robot_arrays import robot_arrays

if TYPE_CHECKING:
    from .task import SpatialTask

TRIED: Final = 4
"""Holds nearest each nominal tip that are tried."""
MOST: Final = 4096
"""Sets of holds that are tried at one height."""


def find_start(task: "SpatialTask", params: Params) -> Records:
    """The start stance, an array of one record.

    Raises:
        SpecError: If it violates a hard check, or if no holds near the nominal tips let the robot stand; the error says how near they are.
    """
    from .step_kernels import first_stance

    names = task.robot.chains.limb_names
    rules: Any = params.array("rules").copy()
    rules["exact"] = 1  # so that the best stance is the same one, whoever asks
    params = params.extended({}, rules=rules)
    margins, stance = np.full(len(SPATIAL_CHECKS), math.nan), np.zeros(1, STANCE)
    if task.start.holds is not None:
        chosen = np.array([task.start.holds[name] - 1 for name in names], np.int32)
        broken = first_stance(params.record, stance, 0, chosen, margins)
        if broken >= 0:
            raise _refused(task, broken, float(margins[broken]))
        return stance
    best, reasons = None, np.zeros(len(SPATIAL_CHECKS), np.int64)
    for height in sorted(range(-task.step.heights, task.step.heights + 1), key=abs):
        for chosen in _choices(task, params, height):
            broken = first_stance(params.record, stance, height, chosen, margins)
            if broken >= 0:
                reasons[broken] += 1
            elif best is None or stance["share"][0] > best["share"][0]:
                best = stance.copy()
        if best is not None:
            return best
    raise _nowhere(task, params, reasons)


def _choices(task: "SpatialTask", params: Params, height: int) -> list[Ints]:
    """Sets of holds to try, those with the smallest distances from the nominal tips first, shape (limbs,) each."""
    near, away = _nearest(task, params, height)
    sets = [
        (
            sum(away[limb, rank] for limb, rank in enumerate(ranks)),
            [near[limb, rank] for limb, rank in enumerate(ranks)],
        )
        for ranks in product(range(near.shape[1]), repeat=len(near))
    ]
    distinct = [(far, holds) for far, holds in sets if len(set(holds)) == len(holds)]
    distinct.sort(key=lambda entry: entry[0])
    return [np.array(holds, np.int32) for _, holds in distinct[:MOST]]


def _nearest(task: "SpatialTask", params: Params, height: int) -> tuple[Ints, Floats]:
    """For each limb the holds nearest its nominal tip, and their distances [m], shape (limbs, n) each."""
    from .step_kernels import set_pose

    stance = np.zeros(1, STANCE)
    stance["pose"][0, HEIGHT] = height
    set_pose(params.record, stance)
    turn = stance["turn"][0].reshape(3, 3)
    limbs = len(task.robot.chains.limb_names)
    number = min(TRIED if limbs <= 4 else 3, len(task.world.holds))
    tips = stance["place"][0] + robot_arrays(task.robot).tips @ turn.T
    apart = np.linalg.norm(task.world.places[None] - tips[:, None], axis=2)
    near = np.argsort(apart, axis=1, kind="stable")[:, :number].astype(np.int32)
    return near, np.take_along_axis(apart, near, axis=1)


def _refused(task: "SpatialTask", broken: int, margin: float) -> SpecError:
    check = SPATIAL_CHECKS[broken]
    unit = "" if check.unit == "1" else f" {check.unit}"
    short = f" by {-margin:.4g}{unit}" if math.isfinite(margin) and margin < 0.0 else ""
    return SpecError(
        f"task '{task.name}'", "start", _said(task), f"violates the hard check '{check.name}'{short} ({check.meaning})"
    )


def _nowhere(task: "SpatialTask", params: Params, reasons: Any) -> SpecError:
    near, away = _nearest(task, params, 0)
    names = task.robot.chains.limb_names
    worst = int(away[:, 0].argmax())
    most = int(reasons.argmax())
    told = (
        f"the robot stands on no holds near its nominal tips here: of {int(reasons.sum())} sets of holds tried, "
        f"{int(reasons[most])} violate '{SPATIAL_CHECKS[most].name}'; the nearest hold to the tip of {names[worst]} is "
        f"{int(near[worst, 0]) + 1}, {away[worst, 0]:.3g} m away; state another place, or 'start.holds'"
    )
    return SpecError(f"task '{task.name}'", "start", _said(task), told)


def _said(task: "SpatialTask") -> str:
    start = task.start
    return f"along {start.along:.4g} m, across {start.across:.4g} m, height {start.height:.4g} m"
