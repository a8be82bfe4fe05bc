"""An inertial measurement unit in the base: angular velocity and specific force, with noise, bias and delay."""

from typing import Final

import numpy as np

from ....types import Floats
from .spatial_flaws import SpatialFlaws


class Imu:
    """Gyro and accelerometer of a simulated robot.

    Args:
        flaws: Noise, biases, delay and seed.
        readings: MuJoCo's sensor values: angular velocity and specific force, base frame, shape (6,).
    """

    def __init__(self, flaws: SpatialFlaws, readings: Floats) -> None:
        self._flaws, self._true = flaws, readings
        self._spread: Final = np.repeat((flaws.gyro_noise, flaws.accelerometer_noise), 3)
        self._biases: Final = np.repeat((flaws.gyro_bias, flaws.accelerometer_bias), 3)
        self._ring = np.zeros((flaws.late + 1, 6))
        self.reset()

    def reset(self) -> None:
        """Forget all readings, and draw the biases anew."""
        self._chance = np.random.default_rng([self._flaws.seed or 0, 2])
        self._bias = self._biases * self._chance.standard_normal(6)
        self._ring[:] = 0.0

    def read(self, tick: int, gyro: Floats, accelerometer: Floats) -> None:
        """Write what a controller gets at a tick."""
        depth = len(self._ring)
        now = self._ring[tick % depth]
        now[:] = self._true
        if self._flaws.seed is not None:
            now += self._bias + self._spread * self._chance.standard_normal(6)
        late = self._ring[max(0, tick - depth + 1) % depth]
        gyro[:], accelerometer[:] = late[:3], late[3:]
