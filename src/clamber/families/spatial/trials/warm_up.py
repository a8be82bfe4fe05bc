"""What carrying out a plan of a robot in space runs, compiled ahead."""

from typing import Final

import numpy as np

from ....execution.sequencer import Sequencer
from ....kernel_cache import Use
from ..control.laws import USUAL
from ..execution.carrying import Carrying
from ..execution.course import Course, Standing
from ..execution.plant import Pose
from ..execution.run_trace import TracedBody
from ..sim.spatial_flaws import SpatialFlaws
from ..sim.spatial_plant import SpatialSim
from .law_trials import first_steps, spatial_task
from .run_plan import body_of

CARRYING: Final = Use("clamber.families.spatial.trials.warm_up:warm_up_beside_planning", "write_and_solve")


def warm_up_beside_planning() -> None:
    """Carry first steps out while another process plans: first what planning does without, so that each of them compiles its own."""
    task = spatial_task("wall-gripper")

    def body() -> TracedBody:
        plant = SpatialSim(task.robot, task.world, SpatialFlaws())
        return body_of(task, plant, plant.flaws, USUAL)

    floating, limbs = body(), len(task.robot.limb_names)
    nowhere = Standing(
        pose=Pose(np.eye(3), np.zeros(3)),
        joints=np.zeros(len(floating.law.torques)),
        holds=np.full(limbs, -1, np.int32),
        loads=np.zeros((limbs, 6)),
        along=0.0,
        across=0.0,
        height=0.0,
        yaw=0.0,
        level=True,
        stage=0,
    )
    floating.start(nowhere)
    floating.tick()
    Sequencer(Carrying(body(), task, Course.of(task, first_steps(task)))).run()
