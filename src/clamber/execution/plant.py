"""What carries a controller's commands out, simulated or real, here or in another process: one protocol, and what a kind adds."""

from dataclasses import dataclass, field
from typing import Any, Generic, NamedTuple, Protocol, TypeVar

import numpy as np

from ..json_form import Jsonable
from ..types import Floats, Ints
from .run_report import RunEndedError

SensedT_co = TypeVar("SensedT_co", covariant=True)
TruthT_co = TypeVar("TruthT_co", covariant=True)
TruthT = TypeVar("TruthT")
PlantT = TypeVar("PlantT", bound="PausingPlant[Any, Any]")


class PlantStoppedError(RunEndedError):
    """The plant takes no more commands: lost, or stopped by its own side."""

    word = "stopped"


class Plant(Protocol[SensedT_co, TruthT_co]):
    """What moves for one control period at a time. Each kind has its own `reset` and `actuate`: starts and motors differ."""

    period: float
    """Between two ticks [s]."""

    def sense(self) -> SensedT_co:
        """Read the sensors, once a tick."""

    def step(self) -> None:
        """Let one control period pass."""

    def truth(self) -> TruthT_co:
        """How things really are: for logs and tests, never for a controller."""


class PausingPlant(Plant[SensedT_co, TruthT_co], Protocol):
    """A plant that can keep still by itself."""

    def pause(self) -> None:
        """Hold the posture without commands until the next: the controller has to think for longer than a period."""


class PlantLayer(Generic[PlantT, TruthT]):
    """Base of what stands before a plant, and is one of its kind itself.

    Args:
        plant: Behind it.
    """

    def __init__(self, plant: PlantT) -> None:
        self.plant, self.period = plant, plant.period

    def pause(self) -> None:
        """See `PausingPlant`."""
        self.plant.pause()

    def truth(self) -> TruthT:
        """See `Plant`."""
        truth: TruthT = self.plant.truth()
        return truth


@dataclass(frozen=True, slots=True, eq=False)
class Sensed:
    """What the sensors of limbs say; the arrays are the plant's own, the same for its whole life, and change with the next tick."""

    states: Floats
    """Joint angles and speeds by the encoders, shape (batch, 2, n) [rad], [rad/s]."""
    wrenches: Floats
    """Wrench of each limb on what it touches, base frame, shape (batch, 6) [N], [N m]; zero without a sensor."""
    mounts: Floats
    """Wrench of each limb on its mount, about the origin of the base frame, shape (batch, 6) [N], [N m]; zero without a sensor."""
    number: Ints = field(default_factory=lambda: np.full(1, -1, np.int32))
    """Of the reading: one more for each period since the reset; -1: nobody tells. Shape (1,)."""


@dataclass(frozen=True, slots=True, eq=False)
class Truth:
    """What is really so of limbs. The arrays are the plant's own as in `Sensed`."""

    states: Floats
    """True joint angles and speeds at the output of the gears, shape (batch, 2, n)."""
    torques: Floats
    """Mean torques that the motors gave over the last tick, shape (batch, n) [N m]."""
    wrenches: Floats
    """True wrench of each limb on what it touches or is pushed by, base frame, shape (batch, 6)."""


class LimbPlant(Plant[Sensed, Truth], Protocol):
    """A batch of equal limbs."""

    batch: int

    def actuate(self, torques: Floats) -> None:
        """Set the motors' torques, held until the next call, shape (batch, n) [N m]."""

    def reset(self, q: Floats) -> None:
        """Put every limb at rest at the joint angles `q`, shape (n,) or (batch, n) [rad], at time 0."""


class BodySensed(NamedTuple):
    """What the sensors of a climber say at a tick; the arrays are the plant's own."""

    q: Floats
    """Joint angles by the motors' encoders, shape (limbs, 2) [rad]."""
    qd: Floats
    """Their speeds, shape (limbs, 2) [rad/s]."""
    angle: float
    """Body angle by its own encoder [rad]."""
    angle_speed: float
    """[rad/s]."""
    gripped: Ints
    """1 for grippers that are closed about something, by the gap of their jaws, shape (limbs,); 0 for other ends."""
    number: int = -1
    """Of the reading: one more for each period since the reset; -1: nobody tells."""


@dataclass(frozen=True, slots=True)
class HoldBreak(Jsonable):
    """A hold that has given way, for good."""

    time: float
    """When [s]."""
    hold: int
    """Its number."""
    force: float
    """On it then [N]."""
    why: str
    """Above its strength, or pulled outside its direction."""

    def __str__(self) -> str:
        return f"hold {self.hold} broke at {self.time:.2f} s: {self.why}"


class BodyTruth(NamedTuple):
    """How the climber really is."""

    pose: Floats
    """Body x, y [m], theta [rad], world frame."""
    q: Floats
    """Joint angles at the gears' outputs, shape (limbs, 2) [rad]."""
    tips: Floats
    """World frame, shape (limbs, 2) [m]."""
    torques: Floats
    """Of the motors over the last tick, shape (limbs, 2) [N m]."""
    broken: tuple[HoldBreak, ...] = ()
    """Holds that have given way since the start."""


class BodyPlant(PausingPlant[BodySensed, BodyTruth | None], Protocol):
    """A climber. A real one knows no truth."""

    def actuate(self, torques: Floats, grips: Ints) -> None:
        """Set the motors' torques, shape (limbs, 2) [N m], and which grippers are shut, 1 or 0, shape (limbs,), until the next call."""

    def reset(self, pose: Floats, q: Floats) -> None:
        """Put the body at a pose x, y [m], theta [rad] with joint angles q, shape (limbs, 2) [rad], at rest, at time 0."""
