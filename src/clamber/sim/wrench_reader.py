"""What a force sensor says of a true wrench: noise, offset, low-pass filter, delay."""

import numpy as np

from ..control.records import AXES
from ..types import Floats
from .limb_flaws import ForceSensor


class WrenchReader:
    """One kind of force sensor on a batch of limbs, read once a control period, in the sensor's own frame.

    Args:
        sensor: What is wrong about it.
        period: Of the control [s].
        delay: Control periods between a reading and its use.
        batch: Number of limbs.
    """

    def __init__(self, sensor: ForceSensor, *, period: float, delay: int, batch: int) -> None:
        self._sensor = sensor
        self._spread = np.repeat((sensor.noise, sensor.moment_noise), 3)
        self._offset = np.repeat((sensor.bias, 0.0), 3)
        # Of a first-order lag over one period, exact for a reading that holds still
        self._blend = 1.0 if sensor.time_constant == 0.0 else -np.expm1(-period / sensor.time_constant)
        self._ring = np.zeros((delay + 1, batch, AXES))
        self._filtered = np.zeros((batch, AXES))
        self.reset()

    def reset(self) -> None:
        """Forget all readings, and start the noise anew."""
        self._random = np.random.default_rng(self._sensor.seed)
        self._filtered[:] = 0.0
        self._ring[:] = 0.0

    def read(self, true: Floats, tick: int) -> Floats:
        """The reading that a controller gets at a tick, of the true wrench then, shape (batch, 6) [N], [N m]."""
        raw = true + self._offset
        if self._spread.any():
            raw = raw + self._spread * self._random.standard_normal(raw.shape)
        self._filtered += self._blend * (raw - self._filtered)
        depth = len(self._ring)
        self._ring[tick % depth] = self._filtered
        reading: Floats = self._ring[max(0, tick - depth + 1) % depth]
        return reading
