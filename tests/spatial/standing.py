"""Robots in space that stand at the start of a task, held by stiff joints alone: for tests of their plant."""

import numpy as np

from clamber.families.spatial.execution.plant import Pose
from clamber.families.spatial.planning.problem import SpatialProblem
from clamber.families.spatial.planning.task import SpatialTask
from clamber.families.spatial.sim.spatial_flaws import Deviations, SpatialFlaws
from clamber.families.spatial.sim.spatial_plant import SpatialSim
from clamber.tasks.library import load_task
from clamber.types import Floats

STIFF, DAMPED = 5.0, 0.05
"""Of a joint that is held: its largest torque per radian, and per rad/s."""


class Standing:
    """A plant at the start of a task, and what holds its joints where they are there."""

    def __init__(self, name: str, flaws: SpatialFlaws | None = None, deviations: Deviations | None = None) -> None:
        task = load_task(name)
        assert isinstance(task, SpatialTask)
        self.task, self.robot = task, task.robot
        start = SpatialProblem(task, 1).start[0]
        chains = task.robot.chains
        limbs = len(chains.limb_names)
        used = np.arange(chains.torque.shape[1]) < chains.n_joints[:, None]
        self.joints: Floats = start["q"][:limbs, : used.shape[1]][used]
        self.limits: Floats = chains.torque[used] / task.robot.spec.torque_share
        self.pose, self.held = Pose(start["turn"].reshape(3, 3), start["place"].copy()), start["hold"][:limbs].copy()
        self.plant = SpatialSim(task.robot, task.world, flaws or SpatialFlaws(), deviations)
        self.weight = task.robot.chains.total_mass * float(np.linalg.norm(task.world.gravity))
        self.plant.reset(self.pose, self.joints, self.held)

    def stay(self, seconds: float) -> None:
        """Let time pass."""
        for _ in range(round(seconds / self.plant.period)):
            angles, speeds = self.plant.sense().joints
            wanted = STIFF * (self.joints - angles) - DAMPED * speeds
            self.plant.actuate(self.limits * np.clip(wanted, -1.0, 1.0))
            self.plant.step()
