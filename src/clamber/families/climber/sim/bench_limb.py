"""A climber's limb for the limb bench."""

from functools import partial

import numpy as np

from ....sim.bench_limb import BenchLimb
from ..control.limb_chain import chain_of_limb, chosen_limb, closed_branches
from ..robot.robot import LimbedRobot


def limb_for_bench(robot: LimbedRobot, limb: str | None, *, upright: bool) -> BenchLimb:
    """A limb by its name or its place from 1, stretched along its port's x axis; None: the first.

    Raises:
        UnknownNameError: If there is no such limb.
    """
    name = robot.limb_names[0] if limb is None else chosen_limb(robot, limb)
    spec = robot.limbs[robot.limb_index(name)]
    return BenchLimb(
        robot=robot,
        name=name,
        chain=chain_of_limb(robot, name, upright=upright),
        gears=np.array((spec.shoulder.gear, spec.elbow.gear)),
        links=(spec.l1, spec.l2_effective),
        branches=partial(closed_branches, spec),
        q0=np.zeros(2),
    )
