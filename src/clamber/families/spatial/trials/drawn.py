"""What a seed drew for a run of a robot in space, one number for each key of the noise: what failures are looked for in."""

import numpy as np

from ....planning.problem.plan import Plan
from ....types import Floats
from ....units import GRAVITY
from ..control.believed_tree import flat
from ..execution.course import grabs
from ..planning.task import SpatialTask
from ..sim.sensing import chance_of, drawn_biases
from ..sim.spatial_flaws import SpatialFlaws
from .noise import SpatialNoise


def drawn(noise: SpatialNoise, task: SpatialTask, plan: Plan, seed: int) -> dict[str, float]:
    """One number for each key that differs from seed to seed; play, delay, steps and misses are as wide in each run.

    Of the holds that the plan takes:

    - `hold_place`: root mean square [m]
    - `hold_tilt`: likewise [rad]
    - `friction`: the least [-]
    - `strength`: the least [-]

    Of the robot:

    - `mass`: of the whole [-]
    - `payload`: over its mass [-]
    - `gear_friction`: of all gears [-]
    - `gyro`: size of the bias [rad/s]
    - `accelerometer`: likewise [m/s^2]
    - `push`: root mean square,
      over its weight [-]

    All holds of the plan count, those of its start, too, whether a run came to them or not: runs that end early would else draw less.
    Of friction and strength the weakest hold decides.
    """
    robot, world = task.robot, task.world
    chains = robot.chains
    holds = sorted({hold for _, hold in grabs(task, plan)})
    made = noise.deviations(robot, world, seed)
    flaws = noise.flaws(SpatialFlaws(), seed)
    biases = drawn_biases(flaws, chance_of(flaws))

    places = made.places - world.places
    off = np.linalg.norm(places[holds], axis=1)
    turns = np.sum(made.normals * world.normals, axis=1)
    tilts = np.arccos(np.clip(turns, -1.0, 1.0))
    friction = made.frictions[holds].min()
    strength = made.strengths[holds].min()

    links = flat(robot, chains.mass)
    mass = chains.base_mass * made.masses[0]
    mass += links @ made.masses[1:]
    weight = GRAVITY * chains.total_mass
    forces = [push.force for push in made.pushes]
    pushes = np.array(forces).reshape(-1, 3)
    pushed = np.linalg.norm(pushes, axis=1)

    found = {
        "hold_place": _mean(off),
        "hold_tilt": _mean(tilts[holds]),
        "friction": friction - 1.0,
        "strength": strength - 1.0,
        "mass": mass / chains.total_mass - 1.0,
        "payload": made.payload / chains.total_mass,
        "gear_friction": flaws.friction - 1.0,
        "gyro": np.linalg.norm(biases[:3]),
        "accelerometer": np.linalg.norm(biases[3:]),
        "push": _mean(pushed) / weight,
    }
    widths = noise.widths
    return {key: float(value) if widths[key] else 0.0 for key, value in found.items()}


def _mean(sizes: Floats) -> float:
    """Root mean square; 0 of none."""
    if not len(sizes):
        return 0.0
    return float(np.sqrt(np.mean(sizes**2)))
