"""An inertial measurement unit in the base: angular velocity and specific force, with noise, bias and delay."""

from typing import Any, Final

import numpy as np

from ....types import Floats
from ..robot.bodies import rotation
from .end_kernels import mean_motion
from .spatial_flaws import SpatialFlaws


def drawn_biases(flaws: SpatialFlaws, chance: np.random.Generator) -> Floats:
    """What each axis tells too much during a whole run: angular velocity [rad/s], then specific force [m/s^2], shape (6,)."""
    spread = np.empty(6)
    spread[:3] = flaws.gyro_bias
    spread[3:] = flaws.accelerometer_bias
    return spread * chance.standard_normal(6)


def chance_of(flaws: SpatialFlaws) -> np.random.Generator:
    """The stream of a unit's biases and noise."""
    return np.random.default_rng([flaws.seed or 0, 2])


class Imu:
    """Gyro and accelerometer of a simulated robot.

    A reading is the mean since the one before, as units give it that filter or integrate: knocks that gears strike when they cross their
    play last less than a control period, and one value of that period would be taken for all of it.

    Args:
        flaws: Noise, biases, delay, control rate and seed.
        data: MuJoCo's, whose first joint is the base's.
        gravity: World frame [m/s^2], shape (3,).
    """

    def __init__(self, flaws: SpatialFlaws, data: Any, gravity: Floats) -> None:
        import mujoco

        self._write_axes: Final = mujoco.mju_quat2Mat
        self._flaws, self._qpos, self._qvel, self._gravity = flaws, data.qpos, data.qvel, gravity
        self._spread: Final = np.repeat((flaws.gyro_noise, flaws.accelerometer_noise), 3)
        self._ring = np.zeros((flaws.late + 1, 6))
        self._mean, self._now = np.zeros(6), np.zeros(9)
        self._axes: Final = self._now.reshape(3, 3)
        self.reset()

    def reset(self) -> None:
        """Forget all readings, and draw the biases anew; the robot is at rest."""
        self._chance = chance_of(self._flaws)
        self._bias = drawn_biases(self._flaws, self._chance)
        self._ring[:] = 0.0
        self._tick = 0
        self._turn, self._velocity = rotation(self._qpos[3:7]), self._qvel[:3].copy()
        self._mean[:3], self._mean[3:] = 0.0, -self._gravity @ self._turn

    def read(self, tick: int, gyro: Floats, accelerometer: Floats) -> None:
        """Write what a controller gets at a tick."""
        if tick != self._tick:
            self._go_on(tick)
        depth = len(self._ring)
        now = self._ring[tick % depth]
        now[:] = self._mean
        if self._flaws.seed is not None:
            now += self._bias + self._spread * self._chance.standard_normal(6)
        late = self._ring[max(0, tick - depth + 1) % depth]
        gyro[:], accelerometer[:] = late[:3], late[3:]

    def _go_on(self, tick: int) -> None:
        """Means over the time since the last reading, base frame."""
        seconds = (tick - self._tick) / self._flaws.control_rate
        self._write_axes(self._now, self._qpos[3:7])
        mean_motion(self._axes, self._qvel, self._gravity, seconds, self._turn, self._velocity, self._mean)
        self._tick = tick
