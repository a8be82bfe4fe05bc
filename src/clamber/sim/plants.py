"""The plants of a limb by name."""

from typing import Final, Protocol

from ..control.chain import Chain
from ..errors import UnknownNameError
from ..execution.plant import LimbPlant
from ..types import Floats
from .limb_flaws import LimbFlaws
from .mujoco_limb import MujocoLimb
from .ode_limb import OdeLimb


class MakePlant(Protocol):
    """Makes a batch of equal limbs; see `MujocoLimb` for the arguments."""

    def __call__(
        self, chain: Chain, flaws: LimbFlaws, *, gears: Floats | None = None, batch: int = 1, threads: int = 0
    ) -> LimbPlant:
        """A plant that still needs a reset."""


PLANTS: Final[dict[str, MakePlant]] = {"mujoco": MujocoLimb, "ode": OdeLimb}
"""Name -> constructor; the command line's choices and the tests read it."""


def plant_maker(name: str) -> MakePlant:
    """The constructor of a plant.

    Raises:
        UnknownNameError: If there is no such plant.
    """
    if name not in PLANTS:
        raise UnknownNameError("plant", name, tuple(PLANTS))
    return PLANTS[name]
