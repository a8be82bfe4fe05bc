"""What is left to chance about a plant: where its joints rest in their play, its encoders within a count, noise. Drawn from a seed."""

import numpy as np

from ..types import Floats
from .limb_flaws import LimbFlaws


class Chances:
    """What a seed makes of a batch of limbs; the same for any plant.

    Args:
        flaws: Their seed, play and noise.
        batch, n: Limbs, and joints of each.
        counts: Encoder counts per radian of each joint, shape (n,); 0 for a perfect one.
    """

    def __init__(self, flaws: LimbFlaws, batch: int, n: int, counts: Floats) -> None:
        self._flaws, self._shape = flaws, (batch, n)
        self._counts = counts
        self.play: Floats = np.zeros(self._shape)
        """Where each joint starts in its play, output over motor side [rad], shape (batch, n)."""
        self.phase: Floats = np.zeros(self._shape)
        """What each encoder has turned since its last count when its angle is told as 0 [rad], shape (batch, n)."""
        self._noise = np.random.default_rng(flaws.seed)
        self.restart()

    def restart(self) -> None:
        """Draw again what the seed says, as at the start of a run."""
        if self._flaws.seed is None:
            return
        sides, phases, noise = np.random.SeedSequence(self._flaws.seed).spawn(3)
        self.play[:] = self._flaws.backlash / 2 * np.random.default_rng(sides).choice((-1.0, 1.0), self._shape)
        parts = np.random.default_rng(phases).uniform(-0.5, 0.5, self._shape)
        np.divide(parts, self._counts, out=self.phase, where=np.broadcast_to(self._counts > 0.0, self._shape))
        self._noise = np.random.default_rng(noise)

    def disturb(self, states: Floats, wrenches: Floats) -> None:
        """Add the noise of one tick to what was sensed, shapes (batch, 2, n) and (batch, 6)."""
        if self._flaws.speed_noise > 0.0:
            states[:, 1] += self._flaws.speed_noise * self._noise.standard_normal(self._shape)
        if self._flaws.wrench_noise > 0.0:
            wrenches[:, :3] += self._flaws.wrench_noise * self._noise.standard_normal((self._shape[0], 3))
