"""What a run of a robot in space meets that nobody told its controller: widths by name, and what a seed draws from them."""

from dataclasses import replace
from typing import Final

import numpy as np

from ....planning.problem.plan import Plan
from ....trials.noise import NoiseKind, NoiseWidths, stream_of
from ....types import Floats
from ....units import DEGREE, GRAVITY
from ..execution.course import grabs
from ..planning.task import SpatialTask
from ..robot.robot import SpatialRobot
from ..sim.sensing import chance_of, drawn_biases
from ..sim.spatial_flaws import Deviations, Push, SpatialFlaws
from ..world.world import World

SPATIAL_NOISE: Final[dict[str, NoiseKind]] = {
    "hold_place": NoiseKind(dimension="length", width=5e-3, words="place of each hold, in any direction", many=True),
    "hold_tilt": NoiseKind(dimension="angle", width=5.0 * DEGREE, words="normal of each hold", many=True),
    "friction": NoiseKind(dimension="ratio", width=0.2, words="friction at each hold", below_one=True, many=True),
    "strength": NoiseKind(dimension="ratio", width=0.2, words="strength at each hold", below_one=True, many=True),
    "mass": NoiseKind(dimension="ratio", width=0.1, words="mass of each part", below_one=True, many=True),
    "payload": NoiseKind(dimension="ratio", width=0.0, words="mass that the base carries, of the robot's"),
    "gear_friction": NoiseKind(dimension="ratio", width=0.2, words="friction of the gears", below_one=True),
    "backlash": NoiseKind(dimension="angle", width=0.5 * DEGREE, words="whole play of each joint"),
    "delay": NoiseKind(dimension="time", unit="ms", scale=1e-3, width=5e-3, words="of all sensors"),
    "encoder": NoiseKind(dimension="angle", width=0.022 * DEGREE, words="step of the encoders"),
    "gyro": NoiseKind(
        dimension="angular speed",
        unit="rad/s",
        scale=1.0,
        width=5e-3,
        words="standard deviation of readings and biases",
    ),
    "accelerometer": NoiseKind(
        dimension="acceleration", unit="m/s^2", scale=1.0, width=0.05, words="standard deviation of readings and biases"
    ),
    "force": NoiseKind(dimension="ratio", width=0.005, words="standard deviation of tips' sensors, of the weight"),
    "miss": NoiseKind(dimension="ratio", width=0.0, words="share of attempts to attach that fail"),
    "push": NoiseKind(dimension="ratio", width=0.0, words="largest push on the body, of its weight"),
}
"""Key -> what deviates: noise of sensors by its standard deviation, play, delay, steps and misses as they are, the rest evenly spread over
its width to either side. The widths of holds, friction, strength, mass, play and delay are those that this family's rates are stated for;
the sensors' are assumed: an encoder of 14 bits, an IMU of a phone's class, force sensors of half a per cent."""
PUSHES: Final = 8.0
"""Mean time between two pushes [s]."""
LASTS: Final = (0.1, 0.3)
"""Shortest and longest push [s]."""
PUSHED_FOR: Final = 600.0
"""Pushes are drawn for runs of so long [s]."""


class SpatialNoise(NoiseWidths):
    """A width for every key, in SI."""

    __slots__ = ()
    kinds = SPATIAL_NOISE

    def flaws(self, base: SpatialFlaws, seed: int) -> SpatialFlaws:
        """What a seed makes of a plant; what it states itself stays."""
        if not self.any:
            return base
        widths = self.widths
        own = {
            "backlash": widths["backlash"],
            "delay": widths["delay"],
            "encoder_step": widths["encoder"],
            "gyro_noise": widths["gyro"],
            "gyro_bias": widths["gyro"],
            "accelerometer_noise": widths["accelerometer"],
            "accelerometer_bias": widths["accelerometer"],
            "force_noise": widths["force"],
            "miss": widths["miss"],
        }
        usual = SpatialFlaws()
        stated = {key: value for key in own if (value := getattr(base, key)) != getattr(usual, key)}
        friction = base.friction * (1.0 + float(self.share("gear_friction", seed)))
        return replace(base, **(own | stated), friction=friction, seed=seed)

    def deviations(self, robot: SpatialRobot, world: World, seed: int) -> Deviations:
        """What a seed makes of robot and world."""
        holds, parts = len(world.holds), 1 + int(robot.chains.n_joints.sum())
        weight = GRAVITY * robot.chains.total_mass
        return Deviations(
            places=world.places + self._within("hold_place", seed, holds),
            normals=tilted(world.normals, self._within("hold_tilt", seed, holds)),
            strengths=1.0 + self.share("strength", seed, holds),
            frictions=1.0 + self.share("friction", seed, holds),
            masses=1.0 + self.share("mass", seed, parts),
            payload=robot.chains.total_mass * abs(float(self.share("payload", seed))),
            pushes=self._pushes(weight, seed),
        )

    def _within(self, key: str, seed: int, n: int) -> Floats:
        """Evenly spread within a ball of the width, shape (n, 3)."""
        chance = stream_of(key, seed)
        ways = chance.standard_normal((n, 3))
        ways /= np.linalg.norm(ways, axis=1, keepdims=True)
        found: Floats = self.widths[key] * ways * np.cbrt(chance.random((n, 1)))
        return found

    def _pushes(self, weight: float, seed: int) -> tuple[Push, ...]:
        if not self.widths["push"]:
            return ()
        chance = stream_of("push", seed)
        found, time = [], float(chance.exponential(PUSHES))
        while time < PUSHED_FOR:
            way = chance.standard_normal(3)
            force = self.widths["push"] * weight * chance.random() * way / np.linalg.norm(way)
            found.append(Push(time, time + float(chance.uniform(*LASTS)), tuple(force.tolist())))
            time = found[-1].end + float(chance.exponential(PUSHES))
        return tuple(found)


def tilted(normals: Floats, turns: Floats) -> Floats:
    """Unit vectors turned by what of rotation vectors lies across them [rad], shape (n, 3)."""
    across = turns - np.sum(turns * normals, axis=1, keepdims=True) * normals
    angles = np.linalg.norm(across, axis=1, keepdims=True)
    axes = across / np.maximum(angles, 1e-12)
    made: Floats = np.cos(angles) * normals + np.sin(angles) * np.cross(axes, normals)
    return made


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
    robot = task.robot
    world = task.world
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

    links = chains.mass[chains.used]
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
