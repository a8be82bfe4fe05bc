"""A limb that is simulated by itself: its chain, its gears, where it starts, and what its robot's file says of the motors."""

from collections.abc import Callable
from dataclasses import dataclass
from operator import attrgetter
from typing import Annotated, Protocol

from ..control.chain import Chain
from ..json_form import HIDDEN, Jsonable, Key, in_json
from ..types import Floats


class GearMotor(Protocol):
    """The motors of a robot's joints, all alike."""

    @property
    def torque_constant(self) -> float:
        """[N m/A]."""

    @property
    def resistance(self) -> float:
        """Of the windings [ohm]."""

    @property
    def amplifier_gain(self) -> float | None:
        """Current over command voltage [A/V]."""

    @property
    def backlash(self) -> float:
        """At the joint [rad]."""

    @property
    def encoder_counts(self) -> int:
        """A turn of the joint."""

    @property
    def control_rate(self) -> float | None:
        """[Hz]."""


class GearedRobot(Protocol):
    """A robot with geared limbs, of any family."""

    @property
    def name(self) -> str:
        """Unique among robots."""

    @property
    def motor(self) -> GearMotor:
        """Of its joints."""


@dataclass(frozen=True, slots=True, eq=False)
class BenchLimb(Jsonable):
    """One limb of two links in a plane, at rest somewhere."""

    robot: Annotated[GearedRobot, Key(get=attrgetter("name"), kind=str)]
    name: str
    chain: Annotated[Chain, HIDDEN]
    """As its file states it; what is unknown to the controller is the plant's."""
    gears: Annotated[Floats, HIDDEN]
    """Motor turns per joint turn, shape (n,)."""
    links: Annotated[tuple[float, float], HIDDEN]
    """From the port to the elbow, and from there to the tip [m]."""
    branches: Annotated[Callable[[float, float], tuple[tuple[float, float], ...]], HIDDEN]
    """Joint angles [rad] with the tip at a place of the port frame [m], the positive elbow first; none out of reach."""
    q0: Annotated[Floats, Key("angles", kind=tuple[float, float])]
    """Joint angles at the start [rad]."""

    @property
    @in_json(after="name")
    def start(self) -> tuple[float, float]:
        """Tip at the start, port frame [m]."""
        place = self.chain.place(self.q0)
        return float(place[0]), float(place[1])

    @property
    def reach(self) -> tuple[float, float]:
        """Least and largest distance of the tip from the port [m]."""
        return abs(self.links[0] - self.links[1]), self.links[0] + self.links[1]
