"""What a walk meets that nobody told its controller: sizes by name, and what a seed draws from them."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np

from ....trials.noise import SETS, NoiseKind, read_widths
from ....types import Json
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


@dataclass(frozen=True, slots=True)
class WalkNoise:
    """A size for every key, in SI."""

    widths: Mapping[str, float]

    def to_json(self) -> Json:
        """Plain data."""
        return {key: self.widths[key] for key in WALK_NOISE}

    def flaws(self, base: WalkerFlaws, seed: int) -> WalkerFlaws:
        """What a seed makes of `base`; each key draws from a stream of its own."""

        def share(key: str, *shape: int) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
            return self.widths[key] * np.random.default_rng([seed, *key.encode()]).uniform(-1.0, 1.0, shape)

        along, across = share("inclinometer_offset", 2)
        return base.with_changes(
            seed=seed,
            inclinometers=Inclinometers(
                noise=self.widths["inclinometer_noise"],
                offsets=(float(along), float(across)),
                time_constant=base.inclinometers.time_constant,
            ),
            force_noise=self.widths["force_noise"],
            friction=base.friction * (1.0 + float(share("friction"))),
            mass_error=self.widths["mass"],
        )


def named_walk_noise(name: str) -> WalkNoise:
    """All sizes: "usual", or "none" of all."""
    assert name in SETS
    return WalkNoise({key: kind.width if name == "usual" else 0.0 for key, kind in WALK_NOISE.items()})


def read_walk_noise(base: WalkNoise, texts: Iterable[str]) -> WalkNoise:
    """`base` changed by texts such as "friction=30%", the last one winning; "none" and "usual" change all of it.

    Raises:
        NoiseError: If there is no such key, or its size cannot be.
    """
    return WalkNoise(read_widths(WALK_NOISE, base.widths, texts))
