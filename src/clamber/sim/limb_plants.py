"""The plants that a limb can be simulated by, by name."""

from collections.abc import Callable
from typing import Final

from ..execution.plant import Plant
from .mujoco_limb import MujocoLimb

PLANTS: Final[dict[str, Callable[..., Plant]]] = {"mujoco": MujocoLimb}
"""Name -> what builds it from a chain, `LimbFlaws` and `gears=`; the command line and the tests read it."""
