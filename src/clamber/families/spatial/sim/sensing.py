"""The sensors of a simulated robot in space: encoders, an inertial measurement unit in the base, wrenches at the tips, switches."""

from typing import Any, Final, NamedTuple

import numpy as np

from ....compiled import Handle, ready
from ....types import Floats, Ints
from ....units import GRAVITY
from ..execution.plant import SpatialSensed
from ..robot.bodies import rotation
from ..robot.chains import Chains
from .end_kernels import read_sensors
from .spatial_flaws import SpatialFlaws

DRAWN: Final = 256
"""Rows of noise that are drawn at once: the stream is the one that they would be drawn from one by one."""


def drawn_biases(flaws: SpatialFlaws, chance: np.random.Generator) -> Floats:
    """What each axis tells too much during a whole run: angular velocity [rad/s], then specific force [m/s^2], shape (6,)."""
    spread = np.empty(6)
    spread[:3] = flaws.gyro_bias
    spread[3:] = flaws.accelerometer_bias
    return spread * chance.standard_normal(6)


def chance_of(flaws: SpatialFlaws) -> np.random.Generator:
    """The stream of an inertial unit's biases and noise."""
    return np.random.default_rng([flaws.seed or 0, 2])


class Read(NamedTuple):
    """What is read, and what is kept of readings; a NamedTuple, as kernels take it."""

    qpos: Floats
    """MuJoCo's, of the base first."""
    qvel: Floats
    """Likewise."""
    at: Ints
    """Place of each joint in `qpos`, shape (n,)."""
    speed_at: Ints
    """The same in `qvel`."""
    counts: Floats
    """Of each encoder per radian; 0: it is perfect, and tells the speed too. Shape (n,)."""
    before: Floats
    """Angles of the reading before, shape (n,)."""
    gravity: Floats
    """World frame [m/s^2], shape (3,)."""
    turn: Floats
    """Axes of the base at the reading before, as columns, shape (3, 3)."""
    turned: Floats
    """Scratch: the same at this reading."""
    velocity: Floats
    """Of its origin then [m/s], shape (3,)."""
    mean: Floats
    """Angular velocity and specific force since, shape (6,)."""
    felt: Floats
    """True wrenches of the tips, each in its own frame, shape (limbs, 6)."""
    given: Floats
    """What the motors give [N m] or [N], shape (n,)."""
    closed: Ints
    """1 of end effectors that are attached, shape (limbs,)."""
    shutting: Ints
    """Ticks until jaws have shut, shape (limbs,)."""
    joints: Floats
    """Ring of past readings, shape (delay + 1, 2, n)."""
    motions: Floats
    """Likewise, shape (delay + 1, 6)."""
    wrenches: Floats
    """Likewise, shape (delay + 1, limbs, 6)."""
    noise: Floats
    """Of the inertial unit, with its biases, a row a reading, shape (DRAWN, 6)."""
    force_noise: Floats
    """Of the tips' wrenches, likewise, shape (DRAWN, limbs, 6)."""


class Sensing:
    """Reads all sensors of a robot once a tick.

    A reading of the inertial unit is the mean since the one before, as units give it that filter or integrate: knocks that gears strike
    when they cross their play last less than a control period, and one value of that period would be taken for all of it.

    Args:
        chains: Of the robot.
        flaws: Noise, biases, delay, control rate and seed.
        places: Of the joints in MuJoCo's `qpos` and `qvel`, and counts of their encoders per radian, shape (n,) each.
        data: MuJoCo's, whose first joint is the base's.
        gravity: World frame [m/s^2], shape (3,).
        reach: A moment's noise is that of a force at a tenth of this lever [m].
        given: What the motors give, shape (n,).
        tips: True wrenches of the tips, which end effectors are attached, and in how many ticks they have shut (`Ends`).
    """

    def __init__(
        self,
        chains: Chains,
        flaws: SpatialFlaws,
        places: tuple[Ints, Ints, Floats],
        data: Any,
        gravity: Floats,
        reach: float,
        given: Floats,
        tips: tuple[Floats, Ints, Ints],
    ) -> None:
        self._flaws, self._period = flaws, flaws.period
        self.sensed: Final = SpatialSensed.of(chains)
        """What they said last."""
        depth, n, limbs = flaws.late + 1, len(given), len(tips[1])
        self._read = Read(
            data.qpos, data.qvel, *places, np.zeros(n), gravity, np.eye(3), np.eye(3), np.zeros(3), np.zeros(6), tips[0], given, *tips[1:],
            np.zeros((depth, 2, n)), np.zeros((depth, 6)), np.zeros((depth, limbs, 6)), np.zeros((DRAWN, 6)), np.zeros((DRAWN, limbs, 6)),
        )  # fmt: skip
        spread = flaws.force_noise * chains.total_mass * GRAVITY
        self._spread = np.repeat((flaws.gyro_noise, flaws.accelerometer_noise), 3)
        self._force_spread = np.tile(np.repeat((spread, 0.1 * reach * spread), 3), (limbs, 1))
        self._read_sensors = ready(read_sensors, Handle(self._read, self.sensed), 0, 0, 0.0, self._period)
        self.reset()

    def reset(self) -> None:
        """Forget all readings, and draw biases and noise anew; the robot is at rest."""
        read, flaws = self._read, self._flaws
        for ring in (read.joints, read.motions, read.wrenches, read.before):
            ring[:] = 0.0
        read.turn[:], read.velocity[:] = rotation(read.qpos[3:7]), read.qvel[:3]
        read.mean[:3], read.mean[3:] = 0.0, -read.gravity @ read.turn
        self._chance, self._force_chance = chance_of(flaws), np.random.default_rng(flaws.seed or 0)
        self._bias = drawn_biases(flaws, self._chance)
        self._tick = self._readings = 0

    def read(self, tick: int) -> SpatialSensed:
        """What a controller gets at a tick."""
        passed, self._tick = (tick - self._tick) * self._period, tick
        row, self._readings = self._readings % DRAWN, self._readings + 1
        if row == 0:
            self._draw()
        self._read_sensors(row, tick, passed, self._period)
        return self.sensed

    def _draw(self) -> None:
        """Draw the noise of the next readings."""
        noise, force_noise = self._read.noise, self._read.force_noise
        if self._flaws.seed is not None:
            noise[:] = self._bias + self._spread * self._chance.standard_normal(noise.shape)
        if self._force_spread.any():
            force_noise[:] = self._force_spread * self._force_chance.standard_normal(force_noise.shape)
