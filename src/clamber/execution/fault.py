"""A fault of a robot: which, where, from when on, how much; drawn from a seed, and what it makes of readings and commands."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final, Literal, TypeAlias

import numpy as np

from ..errors import ClamberError, describe_choices
from ..json_form import Count, Jsonable
from ..types import Floats

Target: TypeAlias = Literal["sensor", "motor", "link", "hold"]


@dataclass(frozen=True, slots=True)
class FaultKind:
    """What a kind of fault does."""

    target: Target
    words: str
    sizes: tuple[float, float]
    """Least and largest size that is drawn, evenly over its logarithm."""
    unit: str
    """Of the size; a span is what the sensor's range covers."""


FAULTS: Final[dict[str, FaultKind]] = {
    "nan": FaultKind("sensor", "a sensor says no number for so long", (0.005, 2.0), "s"),
    "stuck": FaultKind("sensor", "a sensor stays at what it says", (1.0, 1.0), ""),
    "spikes": FaultKind("sensor", "a sensor is off by so much in one reading of a hundred", (0.03, 0.3), "spans"),
    "drift": FaultKind("sensor", "a sensor goes off at this rate", (0.005, 0.05), "spans/s"),
    "dead": FaultKind("motor", "a motor gives nothing", (1.0, 1.0), ""),
    "weak": FaultKind("motor", "a motor gives this part of what it is told", (0.2, 0.8), ""),
    "lost": FaultKind("link", "this part of all packets is lost, either way", (0.02, 1.0), ""),
    "late": FaultKind("link", "packets come so many periods late, either way", (1.0, 20.0), "periods"),
    "repeated": FaultKind("link", "this part of the readings is an older one once more", (0.02, 0.5), ""),
    "jitter": FaultKind("link", "this part of the periods is two or three long", (0.02, 0.5), ""),
    "hold": FaultKind("hold", "a hold takes no more than this part of the robot's weight", (0.2, 1.0), "weights"),
}
"""Name -> kind."""
ANY: Final = "any"
"""One of them at random."""
SPIKED: Final = 0.01
"""Part of the readings that are spikes [-]."""
OLDER: Final = 5
"""A repeated reading is at most so many ticks old."""
SOON: Final = (1.0, 20.0)
"""First and last time at which a fault of a trial begins [s]: early, so that what comes of it is soon known."""
FIRST_HOLDS: Final = 6
"""A hold that is too weak is one of so many that are held at the start or grabbed first."""
SILENCE: Final = 0.05
"""A robot that has had no command for so long holds its posture by itself, as the plant server's guard has it do [s]."""


class FaultChoiceError(ClamberError):
    """A fault that there is none of, or not on this robot."""

    def __init__(self, text: str, kinds: Sequence[str]) -> None:
        super().__init__(text, tuple(kinds))
        self.text, self.kinds = text, tuple(kinds)

    def __str__(self) -> str:
        return f"fault '{self.text}': there is no such fault of this robot; there are {describe_choices(self.text, (*self.kinds, ANY))}"


@dataclass(frozen=True, slots=True, kw_only=True)
class Fault(Jsonable):
    """One fault."""

    kind: str
    """A key of `FAULTS`."""
    start: float
    """From when on, since the reset [s]."""
    size: float
    """How much, in the SI unit of its kind: of spikes and drift what the sensor is off, of packets the part or number of them; of a hold
    [N], and spans counted [rad], [m], [N]."""
    channel: Count = 0
    """Index of the sensor or motor; number of the hold."""
    where: str = ""
    """Its name; empty for the link."""
    seed: Count = 0
    """Of what it leaves to chance."""

    @property
    def target(self) -> Target:
        """What fails."""
        return FAULTS[self.kind].target


@dataclass(frozen=True, slots=True, kw_only=True)
class Failing:
    """What of a robot may fail."""

    sensors: Mapping[str, float]
    """Name -> what its range covers [rad], [m], [N], in the order of the readings."""
    motors: Sequence[str]
    """Names in the order of the commands."""
    holds: Sequence[int] = ()
    """Numbers of holds that it comes to while faults begin."""
    weight: float = 0.0
    """Of the robot [N]."""

    @property
    def kinds(self) -> tuple[str, ...]:
        """Of faults that it may have."""
        there = {"sensor": self.sensors, "motor": self.motors, "link": (1,), "hold": self.holds}
        return tuple(name for name, kind in FAULTS.items() if len(there[kind.target]) > 0)


def check_faults(texts: Sequence[str], kinds: Sequence[str]) -> None:
    """Make sure that there are such faults.

    Raises:
        FaultChoiceError: If there is not.
    """
    for text in texts:
        if text != ANY and text not in kinds:
            raise FaultChoiceError(text, kinds)


def draw_fault(texts: Sequence[str], seed: int, failing: Failing, begins: tuple[float, float] = SOON) -> Fault:
    """One fault of those that are asked for.

    Args:
        texts: Kinds, or `ANY`; one of them is drawn.
        seed: The same seed draws the same fault.
        failing: What may fail.
        begins: First and last time at which it may begin [s].

    Raises:
        FaultChoiceError: If there is no such fault of this robot.
    """
    check_faults(texts, failing.kinds)
    random = np.random.default_rng(np.random.SeedSequence(seed).spawn(7)[6])
    text = texts[int(random.integers(len(texts)))]
    kind = failing.kinds[int(random.integers(len(failing.kinds)))] if text == ANY else text
    least, most = FAULTS[kind].sizes
    size = least * (most / least) ** float(random.random())
    start = begins[0] + (begins[1] - begins[0]) * float(random.random())
    target, pick, own = FAULTS[kind].target, float(random.random()), int(random.integers(2**31))
    channel, where = 0, ""
    if target == "sensor":
        channel = int(pick * len(failing.sensors))
        where = list(failing.sensors)[channel]
        size *= failing.sensors[where] if FAULTS[kind].unit.startswith("span") else 1.0
    elif target == "motor":
        channel = int(pick * len(failing.motors))
        where = failing.motors[channel]
    elif target == "hold":
        channel = failing.holds[int(pick * len(failing.holds))]
        where, size, start = f"hold {channel}", size * failing.weight, begins[0]
    elif kind == "late":
        size = float(round(size))
    return Fault(kind=kind, start=start, size=size, channel=channel, where=where, seed=own)


class Injector:
    """What a fault makes of readings and commands as flat arrays, tick by tick: for every plant the same.

    Args:
        fault: Which.
        period: Of the control [s].
    """

    def __init__(self, fault: Fault, period: float) -> None:
        self.fault, self.period = fault, period
        self.reset()

    def reset(self) -> None:
        """Begin anew, with the same chances."""
        self._random = np.random.default_rng(self.fault.seed)
        self.tick = 0
        self._stuck = self._before = math.nan
        self._last: tuple[Floats, int] | None = None
        self._packets: list[tuple[Floats, int]] = []
        self._orders: list[Floats] = []
        self._order: Floats | None = None
        self._silent = 0

    @property
    def time(self) -> float:
        """Since the reset [s]."""
        return self.tick * self.period

    @property
    def on(self) -> bool:
        """Whether the fault has begun."""
        return self.time >= self.fault.start

    @property
    def silent(self) -> bool:
        """Whether the robot has had no command for longer than `SILENCE`."""
        return self._silent * self.period > SILENCE

    def read(self, values: Floats, number: int) -> tuple[Floats, int]:
        """What arrives of a tick's readings: readings, shape (n,), and the number of that packet."""
        fault, kind = self.fault, self.fault.kind
        out = values.copy()
        if self.on and fault.target == "sensor":
            out[fault.channel] = self._misread(float(values[fault.channel]))
        self._packets = [*self._packets[-32:], (out, number)]
        packet = out, number
        if self.on and self._last is not None:
            if kind == "lost" and self._random.random() < fault.size:
                packet = self._last
            elif kind == "late":
                packet = self._packets[max(0, len(self._packets) - 1 - int(fault.size))]
            elif kind == "repeated" and self._random.random() < fault.size:
                packet = self._packets[max(0, len(self._packets) - 2 - int(self._random.integers(OLDER)))]
        self._last = packet
        return packet

    def speed(self, value: float, speed: float) -> float:
        """Of the failing sensor, by difference as its reading goes, once a tick; `speed` before it has begun to fail."""
        before, self._before = self._before, value
        return (value - before) / self.period if self.on and math.isfinite(before) else speed

    def command(self, values: Floats) -> Floats | None:
        """What arrives of a tick's commands, shape (n,); None where nothing does."""
        fault, kind = self.fault, self.fault.kind
        self._orders = [*self._orders[-32:], values.copy()]
        if self.on and kind == "lost" and self._random.random() < fault.size:
            return None
        self._silent = -1  # counted on by `passed`
        if self.on and kind == "late":
            return self._orders[max(0, len(self._orders) - 1 - int(fault.size))].copy()
        return values.copy()

    def weaken(self, values: Floats, rest: Floats) -> Floats:
        """What the motors do of commands, shape (n,): a weak one goes from `rest` part of the way to its command."""
        if self.on and self.fault.target == "motor":
            at, part = self.fault.channel, 0.0 if self.fault.kind == "dead" else self.fault.size
            values[at] = rest[at] + part * (values[at] - rest[at])
        return values

    def passed(self) -> int:
        """A tick is over: how many periods it lasts."""
        self.tick += 1
        self._silent += 1
        if self.on and self.fault.kind == "jitter" and self._random.random() < self.fault.size:
            return int(self._random.integers(2, 4))
        return 1

    def _misread(self, value: float) -> float:
        kind, size = self.fault.kind, self.fault.size
        since = self.time - self.fault.start
        if kind == "nan":
            return math.nan if since < size else value
        if kind == "stuck":
            self._stuck = value if math.isnan(self._stuck) else self._stuck
            return self._stuck
        if kind == "spikes":
            sign = -1.0 if self._random.random() < 0.5 else 1.0
            return value + sign * size if self._random.random() < SPIKED else value
        return value + (size if self.fault.seed % 2 else -size) * since
