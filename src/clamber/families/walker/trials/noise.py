"""What a walk meets that nobody told its controller: sizes by name, and what a seed draws from them."""

from typing import Final

from ....trials.noise import NoiseKind, NoiseWidths
from ....units import DEGREE
from ..sim.walker_flaws import Inclinometers, WalkerFlaws

WALK_NOISE: Final[dict[str, NoiseKind]] = {
    "inclinometer_noise": NoiseKind(
        dimension="angle", width=0.05 * DEGREE, words="standard deviation of each reading", many=True
    ),
    "inclinometer_offset": NoiseKind(
        dimension="angle", width=0.2 * DEGREE, words="zero of each inclinometer", many=True
    ),
    "force_noise": NoiseKind(
        dimension="force", width=2.0, words="standard deviation of each leg's load cell", many=True
    ),
    "friction": NoiseKind(dimension="ratio", width=0.2, words="friction of the ground", below_one=True),
    "mass": NoiseKind(dimension="ratio", width=0.05, words="mass of each part by itself", below_one=True, many=True),
}
"""Key -> what deviates: noise by its standard deviation, the rest evenly spread over its width to either side. The inclinometers' noise is
that of the task; the other sizes are assumed."""


class WalkNoise(NoiseWidths):
    """A size for every key, in SI."""

    __slots__ = ()
    kinds = WALK_NOISE

    def flaws(self, base: WalkerFlaws, seed: int) -> WalkerFlaws:
        """What a seed makes of `base`."""
        along, across = self.share("inclinometer_offset", seed, 2)
        return base.with_changes(
            seed=seed,
            inclinometers=Inclinometers(
                noise=self.widths["inclinometer_noise"],
                offsets=(float(along), float(across)),
                time_constant=base.inclinometers.time_constant,
            ),
            force_noise=self.widths["force_noise"],
            friction=base.friction * (1.0 + float(self.share("friction", seed))),
            mass_error=self.widths["mass"],
        )
