"""What a seed drew for a run of a robot in space, one number for each key of the noise: what failures are looked for in."""

import numpy as np

from ....planning.problem.plan import Plan
from ....types import Floats
from ....units import GRAVITY
from ..control.believed_tree import flat
from ..execution.course import Course
from ..planning.task import SpatialTask
from ..sim.imu import chance_of, drawn_biases
from ..sim.spatial_flaws import SpatialFlaws
from .noise import SpatialNoise


def drawn(noise: SpatialNoise, task: SpatialTask, plan: Plan, seed: int) -> dict[str, float]:
    """One number for each key that differs from seed to seed, in SI; play, delay, steps and misses are as wide in each run.

    Of the holds that the plan takes, those of the start included, the root mean square of places and tilts, and of friction and strength
    the least, for the weakest one decides; of masses that of the whole robot; of gyro and accelerometer the size of their biases; of
    pushes the root mean square. Holds of the plan count whether a run came to them or not: runs that end early would else draw less.
    """
    robot, world = task.robot, task.world
    made, flaws = noise.deviations(robot, world, seed), noise.flaws(SpatialFlaws(), seed)
    holds = holds_of(task, plan)
    tilts = np.arccos(np.clip(np.sum(made.normals[holds] * world.normals[holds], axis=1), -1.0, 1.0))
    biases = drawn_biases(flaws, chance_of(flaws))
    parts = np.concatenate(([robot.chains.base_mass], flat(robot, robot.chains.mass)))
    weight = GRAVITY * robot.chains.total_mass
    found = {
        "hold_place": _mean(np.linalg.norm(made.places[holds] - world.places[holds], axis=1)),
        "hold_tilt": _mean(tilts),
        "friction": float(made.frictions[holds].min()) - 1.0,
        "strength": float(made.strengths[holds].min()) - 1.0,
        "mass": float(parts @ made.masses) / robot.chains.total_mass - 1.0,
        "payload": made.payload / robot.chains.total_mass,
        "gear_friction": flaws.friction - 1.0,
        "gyro": float(np.linalg.norm(biases[:3])),
        "accelerometer": float(np.linalg.norm(biases[3:])),
        "push": _mean(np.array([np.linalg.norm(push.force) / weight for push in made.pushes])),
    }
    return {key: value if noise.widths[key] else 0.0 for key, value in found.items()}


def holds_of(task: SpatialTask, plan: Plan) -> list[int]:
    """Indices of the holds that a plan takes, those of its start included."""
    start = Course.of(task, plan).start.holds
    return sorted(
        {int(hold) for hold in start if hold >= 0} | {action.hold - 1 for action in plan.actions if action.hold}
    )


def _mean(sizes: Floats) -> float:
    """Root mean square; 0 of none."""
    return float(np.sqrt(np.mean(sizes**2))) if len(sizes) else 0.0
