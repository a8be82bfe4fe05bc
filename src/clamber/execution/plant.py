"""What carries a controller's torques out: a simulated limb or robot, or a real one. One protocol for all."""

from dataclasses import dataclass
from typing import Protocol

from ..types import Floats


@dataclass(frozen=True, slots=True, eq=False)
class Sensed:
    """What the sensors say; the arrays are the plant's own, the same for its whole life, and change with the next tick."""

    states: Floats
    """Joint angles and speeds by the encoders, shape (batch, 2, n) [rad], [rad/s]."""
    wrenches: Floats
    """Wrench of each limb on what it touches, base frame, shape (batch, 6) [N], [N m]; zero without a sensor."""
    mounts: Floats
    """Wrench of each limb on its mount, about the origin of the base frame, shape (batch, 6) [N], [N m]; zero without a sensor."""


@dataclass(frozen=True, slots=True, eq=False)
class Truth:
    """What is really so: for logs and tests, never for a controller. The arrays are the plant's own as in `Sensed`."""

    states: Floats
    """True joint angles and speeds at the output of the gears, shape (batch, 2, n)."""
    torques: Floats
    """Mean torques that the motors gave over the last tick, shape (batch, n) [N m]."""
    wrenches: Floats
    """True wrench of each limb on what it touches or is pushed by, base frame, shape (batch, 6)."""


class Plant(Protocol):
    """A batch of equal limbs that move for one control period at a time."""

    period: float
    """Between two ticks [s]."""
    batch: int

    def reset(self, q: Floats) -> None:
        """Put every limb at rest at the joint angles `q`, shape (n,) or (batch, n) [rad], at time 0."""

    def sense(self) -> Sensed:
        """Read the sensors, once a tick."""

    def actuate(self, torques: Floats) -> None:
        """Set the motors' torques, held until the next call, shape (batch, n) [N m]."""

    def step(self) -> None:
        """Let one control period pass."""

    def truth(self) -> Truth:
        """How things really are."""
