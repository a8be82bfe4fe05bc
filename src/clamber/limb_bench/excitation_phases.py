"""The phases in which one joint is excited: each says, tick by tick, the torque to give and when it is over."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any, Final, Protocol

RAMP_TIME: Final = 30.0
"""In which the starting torque grows from 0 to the joint's limit [s]."""
STARTED: Final = 0.002
"""A joint that moved so far from rest has started [rad]."""
MARGIN: Final = 0.25
"""Kept from the joint's limits in motion [rad]."""
RETURN_STIFFNESS: Final = 40.0
"""Of the servo, per inertia [1/s^2]."""
RETURN_SPEED: Final = 0.8
"""Of the servo's aim [rad/s]."""
SPEEDS: Final = (0.15, 0.3, 0.8)
"""That constant torques may end at [rad/s]: two slow ones get there within the joint's range, the last leaves it in motion."""
STALL_STEPS: Final = 12
STALL_PART: Final = 0.6
"""Of the torque limit, at the last step of a stall."""


@dataclass(slots=True, eq=False)
class Drive:
    """What the one who excites a joint knows of it, and learns on the way."""

    joint: Any
    """Record of `control.records.JOINT`: only to choose torques and times by."""
    period: float
    starting: float = field(default=0.0)
    """Torque at which the joint starts and keeps moving [N m], found by the first phases."""

    @property
    def low(self) -> float:
        """Lower end of free motion [rad]."""
        return float(self.joint["lower"]) + MARGIN

    @property
    def high(self) -> float:
        """Upper end of free motion [rad]."""
        return float(self.joint["upper"]) - MARGIN

    @property
    def middle(self) -> float:
        """Of the joint's range [rad]."""
        return (self.low + self.high) / 2

    @property
    def settling(self) -> float:
        """Four time constants of the speed under a constant torque, I / d; at most 15 s."""
        damping = float(self.joint["damping"])
        return min(15.0, 4.0 * float(self.joint["rotor"]) / damping) if damping > 0.0 else 15.0

    def moving(self, speed: float) -> float:
        """Torque that ends near a speed [N m]."""
        return self.starting + float(self.joint["damping"]) * speed


class Phase(Protocol):
    """A part of an excitation."""

    name: str

    def torque(self, drive: Drive, tick: int, angle: float, speed: float) -> tuple[float, bool]:
        """Torque to give [N m], and whether the phase is over."""


@dataclass(slots=True)
class Go:
    """A servo brings the joint to an angle, slowly, and rests there."""

    to: float
    name: str = "going"
    since: float = 0.0
    start: float = 0.0

    def torque(self, drive: Drive, tick: int, angle: float, speed: float) -> tuple[float, bool]:
        """See `Phase`."""
        if tick == 0:
            self.start = angle
        way = self.to - self.start
        part = min(1.0, tick * drive.period * RETURN_SPEED / max(abs(way), 1e-9))
        aim, rate = self.start + part * way, math.copysign(RETURN_SPEED, way) if part < 1.0 else 0.0
        inertia = float(drive.joint["rotor"])
        pull = RETURN_STIFFNESS * (aim - angle) + 2 * RETURN_STIFFNESS**0.5 * (rate - speed)
        self.since = self.since + drive.period if part == 1.0 and abs(speed) < 0.02 else 0.0
        return inertia * pull + math.copysign(drive.starting, rate) * (rate != 0.0), self.since > 0.3


@dataclass(slots=True)
class Start:
    """The torque grows until the joint starts; it is kept as the drive's starting torque."""

    name: str = "starting"
    rest: float = 0.0

    def torque(self, drive: Drive, tick: int, angle: float, speed: float) -> tuple[float, bool]:
        """See `Phase`."""
        if tick == 0:
            self.rest = angle
        torque = float(drive.joint["limit"]) * tick * drive.period / RAMP_TIME
        if abs(angle - self.rest) > STARTED:
            drive.starting = torque
            return 0.0, True
        return torque, False


@dataclass(slots=True)
class Creep:
    """A servo draws the joint along slowly; the mean torque, less that of damping, replaces the starting torque."""

    name: str = "creeping"
    speed: float = 0.1
    seconds: float = 4.0
    start: float = 0.0
    total: float = 0.0
    count: int = 0

    def torque(self, drive: Drive, tick: int, angle: float, speed: float) -> tuple[float, bool]:
        """See `Phase`."""
        if tick == 0:
            self.start = angle
        time = tick * drive.period
        off = self.start + self.speed * time - angle
        pull = RETURN_STIFFNESS * off + 2 * RETURN_STIFFNESS**0.5 * (self.speed - speed)
        torque = drive.starting + float(drive.joint["rotor"]) * pull
        if time > self.seconds / 2:
            self.total, self.count = self.total + torque, self.count + 1
        if time < self.seconds:
            return torque, False
        drive.starting = max(0.0, self.total / self.count - float(drive.joint["damping"]) * self.speed)
        return torque, True


@dataclass(slots=True)
class Constant:
    """A constant torque from rest, for four time constants or until the range ends (Bevly 1997, 3.4.2)."""

    speed: float
    """That it may end at, with its sign [rad/s]."""
    name: str = "constant torque"

    def torque(self, drive: Drive, tick: int, angle: float, speed: float) -> tuple[float, bool]:
        """See `Phase`."""
        sign = math.copysign(1.0, self.speed)
        over = angle > drive.high if sign > 0.0 else angle < drive.low
        return sign * drive.moving(abs(self.speed)), over or tick * drive.period > drive.settling


@dataclass(slots=True)
class Sines:
    """Several sines about an offset that keeps the joint moving one way (Bevly 1997, figure 3.9)."""

    sign: float
    name: str = "sines"
    sines: tuple[float, ...] = (0.7, 1.3, 2.3, 3.7)
    """Frequencies [Hz], with equal amplitudes of speed as far as inertia rules."""

    def torque(self, drive: Drive, tick: int, angle: float, speed: float) -> tuple[float, bool]:
        """See `Phase`."""
        time, inertia = tick * drive.period, float(drive.joint["rotor"])
        wave = sum(math.tau * f * math.sin(math.tau * f * time + k) for k, f in enumerate(self.sines))
        torque = drive.moving(0.55) + 0.09 * inertia * wave
        over = angle > drive.high if self.sign > 0.0 else angle < drive.low
        return self.sign * torque, over or time > 8.0


@dataclass(slots=True)
class Reversals:
    """A slow sine about no torque, so that the play is crossed both ways."""

    name: str = "reversals"
    frequency: float = 0.5
    cycles: int = 4
    speed: float = 0.5
    """About the largest that it brings [rad/s]."""

    def torque(self, drive: Drive, tick: int, angle: float, speed: float) -> tuple[float, bool]:
        """See `Phase`."""
        time = tick * drive.period
        size = 1.4 * drive.starting + self.speed * math.hypot(
            float(drive.joint["damping"]), math.tau * self.frequency * float(drive.joint["rotor"])
        )
        return size * math.cos(math.tau * self.frequency * time), time > self.cycles / self.frequency


@dataclass(slots=True)
class Stall:
    """The joint is driven softly into its upper stop and pushed against it harder and harder (Bevly 1997, 4.3.4)."""

    name: str = "stall"
    arrived: int = -1

    def torque(self, drive: Drive, tick: int, angle: float, speed: float) -> tuple[float, bool]:
        """See `Phase`."""
        upper = float(drive.joint["upper"])
        if self.arrived < 0:
            if angle > upper - 0.03 and abs(speed) < 0.005:
                self.arrived = tick
            pull = float(drive.joint["rotor"]) * 10.0 * (0.3 - speed)
            return drive.starting + float(drive.joint["damping"]) * 0.3 + pull, False
        step = int((tick - self.arrived) * drive.period / 0.3)
        size = STALL_PART * float(drive.joint["limit"]) * (1 + min(step, STALL_STEPS - 1)) / STALL_STEPS
        return size, step >= STALL_STEPS


def phases_of(drive: Drive) -> Iterator[Phase]:
    """The whole excitation of one joint, ending at rest in the middle of its range."""
    yield Go(drive.middle)
    yield Start()
    yield Creep()
    for speed in SPEEDS:
        yield Go(drive.low + 0.05)
        yield Constant(speed)
        yield Go(drive.high - 0.05)
        yield Constant(-speed)
    yield Go(drive.low + 0.05)
    yield Sines(1.0)
    yield Go(drive.high - 0.05)
    yield Sines(-1.0)
    yield Go(drive.middle)
    yield Reversals()
    yield Go(drive.high - 0.05)
    yield Stall()
    yield Go(drive.middle)
