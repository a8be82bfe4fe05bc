"""The plants of a limb by name, ours and those of other packages."""

from typing import Any, Final, Protocol

from ..control.chain import Chain
from ..errors import UnknownNameError
from ..execution.plant import LimbPlant, Sensed, Truth
from ..extensions import blamed, load_outside, outside
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
"""Name -> constructor, ours; `plant_maker` knows those of other packages too."""


def plant_maker(name: str) -> MakePlant:
    """The constructor of a plant, ours or another package's.

    Raises:
        UnknownNameError: If there is no such plant.
        ExtensionError: If another package's cannot be loaded; what it makes raises that too where it fails.
    """
    if name in PLANTS:
        return PLANTS[name]
    theirs = outside("plants")
    if name not in theirs:
        raise UnknownNameError("plant", name, (*PLANTS, *theirs))
    make = load_outside("plants", name)

    def make_blamed(
        chain: Chain, flaws: LimbFlaws, *, gears: Floats | None = None, batch: int = 1, threads: int = 0
    ) -> LimbPlant:
        with blamed("plants", name):
            return BlamedPlant(name, make(chain, flaws, gears=gears, batch=batch, threads=threads))

    return make_blamed


class BlamedPlant:
    """A plant of another package: what goes wrong in it is its own. See `LimbPlant`."""

    def __init__(self, name: str, plant: Any) -> None:
        self._name, self._plant = name, plant
        self.period: float = plant.period
        self.batch: int = plant.batch

    def reset(self, q: Floats) -> None:
        """See `LimbPlant`."""
        with blamed("plants", self._name):
            self._plant.reset(q)

    def sense(self) -> Sensed:
        """See `Plant`."""
        with blamed("plants", self._name):
            sensed: Sensed = self._plant.sense()
            return sensed

    def actuate(self, torques: Floats) -> None:
        """See `LimbPlant`."""
        with blamed("plants", self._name):
            self._plant.actuate(torques)

    def step(self) -> None:
        """See `Plant`."""
        with blamed("plants", self._name):
            self._plant.step()

    def truth(self) -> Truth:
        """See `Plant`."""
        with blamed("plants", self._name):
            truth: Truth = self._plant.truth()
            return truth
