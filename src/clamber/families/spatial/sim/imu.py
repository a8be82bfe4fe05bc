"""An inertial measurement unit in the base: angular velocity and specific force, with noise, bias and delay."""

from typing import Any, Final

import numpy as np

from ....types import Floats
from ..robot.bodies import rotation
from .spatial_flaws import SpatialFlaws


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
        self._flaws, self._qpos, self._qvel, self._gravity = flaws, data.qpos, data.qvel, gravity
        self._spread: Final = np.repeat((flaws.gyro_noise, flaws.accelerometer_noise), 3)
        self._biases: Final = np.repeat((flaws.gyro_bias, flaws.accelerometer_bias), 3)
        self._ring = np.zeros((flaws.late + 1, 6))
        self._mean = np.zeros(6)
        self.reset()

    def reset(self) -> None:
        """Forget all readings, and draw the biases anew; the robot is at rest."""
        self._chance = np.random.default_rng([self._flaws.seed or 0, 2])
        self._bias = self._biases * self._chance.standard_normal(6)
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
        turn, velocity = rotation(self._qpos[3:7]), self._qvel[:3].copy()
        turned = self._turn.T @ turn
        self._mean[0] = (turned[2, 1] - turned[1, 2]) / (2.0 * seconds)
        self._mean[1] = (turned[0, 2] - turned[2, 0]) / (2.0 * seconds)
        self._mean[2] = (turned[1, 0] - turned[0, 1]) / (2.0 * seconds)
        self._mean[3:] = ((velocity - self._velocity) / seconds - self._gravity) @ (0.5 * (self._turn + turn))
        self._tick, self._turn, self._velocity = tick, turn, velocity
