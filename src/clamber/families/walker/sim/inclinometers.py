"""Two inclinometers on a walker's plate, as they are: pendulums that also feel acceleration, a filter, noise, offsets."""

import math

import numpy as np

from ....types import Floats
from ....units import GRAVITY
from .walker_flaws import Inclinometers


class InclinometerPair:
    """Reads the incline of a plate's x and y axis.

    An inclinometer gives the angle whose sine is the specific force along its axis over that of gravity. The mean specific force over a
    period follows from how much the speed changed in it, exactly, however it changed.

    Args:
        flaws: Noise, offsets and filter.
        period: Between readings [s].
        seed: Of the noise; None: none.
    """

    def __init__(self, flaws: Inclinometers, period: float, seed: int | None) -> None:
        self._flaws, self._period = flaws, period
        self._offsets = np.array(flaws.offsets)
        self._keep = math.exp(-period / flaws.time_constant) if flaws.time_constant > 0.0 else 0.0
        # so that what comes out of the filter has the noise that is stated
        self._scale = 0.0 if seed is None else flaws.noise * math.sqrt((1.0 + self._keep) / (1.0 - self._keep))
        self._seed = seed
        self._before = (0.0, 0.0, 0.0)
        self.readings = np.zeros(2)
        """How far the plate's x axis and its y axis rise above the horizontal, shape (2,) [rad]."""
        self._filtered = np.zeros(2)
        self._chance = np.random.default_rng(seed)

    def reset(self, axes: Floats, velocity: Floats) -> None:
        """Begin at rest at a posture.

        Args:
            axes: The plate's axes in the world, as columns, shape (3, 3).
            velocity: Of the inclinometers, world frame [m/s], shape (3,).
        """
        self._before = tuple(velocity.tolist())
        self._chance = np.random.default_rng(self._seed)
        self._filtered[:] = np.arcsin(axes[2, :2])
        if self._scale > 0.0:
            self._filtered += self._flaws.noise * self._chance.standard_normal(2)
        np.add(self._filtered, self._offsets, out=self.readings)

    def see(self, axes: Floats, velocity: Floats) -> None:
        """Take in the period that has passed; arguments as in `reset`, at its end."""
        (vx, vy, vz), (bx, by, bz) = velocity.tolist(), self._before
        fx, fy, fz = (vx - bx) / self._period, (vy - by) / self._period, (vz - bz) / self._period + GRAVITY
        self._before = (vx, vy, vz)
        noise = self._chance.standard_normal(2).tolist() if self._scale > 0.0 else (0.0, 0.0)
        for k in range(2):
            along = (axes[0, k] * fx + axes[1, k] * fy + axes[2, k] * fz) / GRAVITY
            felt = math.asin(min(1.0, max(-1.0, along))) + self._scale * noise[k]
            self._filtered[k] += (1.0 - self._keep) * (felt - self._filtered[k])
            self.readings[k] = self._filtered[k] + self._offsets[k]
