"""How the limbs of a robot in space share its load while one of them swings."""

import math

import numpy as np

from ....types import Floats
from ..statics.checks import EQUILIBRIUM
from .checks import SPATIAL_CHECKS
from .judging_kernels import judge_stance
from .problem import problem_params
from .task import SpatialTask


class SwingLoads:
    """How limbs share the load while one of them swings, as the planner judged it.

    Args:
        task: Robot, world and rules.
    """

    def __init__(self, task: SpatialTask) -> None:
        self._params, self._limbs = problem_params(task, True), len(task.robot.chains.limb_names)

    def wrenches(self, stance: np.void, limb: int) -> Floats:
        """Of the contacts of a stance without one limb's, world frame, shape (limbs, 6); NaN where the others cannot hold the robot.

        Args:
            stance: Record of `planning.records.STANCE`.
            limb: Index of the limb that swings.
        """
        rows, margins = np.array([stance, stance]), np.full(len(SPATIAL_CHECKS), math.nan)
        judge_stance(self._params.record, rows[0], rows[1], limb, -1, margins)
        if not margins[EQUILIBRIUM] >= 0.0:
            return np.full((self._limbs, 6), math.nan)
        judged = self._params.array("work_judged")[1]
        frames = judged["frame"][: self._limbs].reshape(-1, 3, 3)
        turn = np.asarray(stance["turn"]).reshape(3, 3)
        own = judged["wrench"][: self._limbs].reshape(-1, 2, 3)
        found: Floats = np.einsum("ij,lkj,lpk->lpi", turn, frames, own).reshape(-1, 6)
        found[limb] = 0.0
        return found
