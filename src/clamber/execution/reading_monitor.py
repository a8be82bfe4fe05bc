"""Faults told from the robot's own readings and commands, tick by tick: what is bridged, and what ends a run."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from ..compiled import Handle, ready
from ..control.check_readings import (
    AGAINST,
    AGE,
    ANSWER,
    BELIEVED,
    BOUNDS,
    DRIVEN,
    FASTEST,
    FULL,
    HIGH,
    JUMP,
    LOOSE,
    LOOSE_HIGH,
    LOOSE_LOW,
    LOW,
    MEAN,
    MEMORY,
    NO_NUMBER,
    SAME,
    SLOW,
    YIELDING,
    check_readings,
)
from ..types import Floats
from .run_report import FaultError, Finding

BRIDGED: Final = 0.05
"""Readings that fail for longer are no longer bridged [s]: a joint under load may have turned by a tenth of a radian."""
LEAST_BRIDGED: Final = 3
"""Ticks that are bridged at any rate."""
FAILING: Final = 0.25
"""A sensor of whose readings more than this part fails is not to be relied upon [-] ..."""
JUDGED: Final = 0.5
"""... over about so long [s]."""
UNMOVED: Final = 0.1
"""For so long a reading stays the same to the last count while its motor's command changes, before that is a fault [s]."""
FULLY_DRIVEN: Final = 1.0
"""For so long a joint does not follow a full command, before that is a fault [s]: arms that hold the body against the push of a third have
been seen to do so for 0.35 s in climbs without a fault."""
YIELDS: Final = 0.2
"""For so long a joint gives way to a full command, before that is a fault [s]."""
ANSWERING: Final = 0.3
"""A change of command by this part of a joint's torque limit moves it by a count [-]: twice what has been seen in climbs without a fault,
where friction of 1.3 times the file's keeps a joint still. A joint whose limb is held at both ends may stay still all the same, as only
the squeeze between its hold and others changes: there the tips must have moved against each other besides."""
STIRRED: Final = 1 / 3
"""A joint that has become free since its command began to change has to move once it changes by this part of that besides [-]: before, its
hold may have balanced all of it; friction, twice 1.3 times the file's, takes three quarters of this part from LIBRA's joints."""
FULL_COMMAND: Final = 0.9
"""Part of a torque limit that counts as a full command [-]."""
FOLLOWS: Final = 0.01
"""A joint that turns the way it is driven with less than this part of its speed without load does not follow [-]."""
GIVES_WAY: Final = 0.05
"""A joint that turns against its command with more than this part of its speed without load gives way [-]. Healthy joints under a little
more than their torque creep against it: with 2 % of that speed for 0.35 s in climbs without a fault, where a limb is let go."""
MEANT: Final = 0.15
"""Time constant of the command that a joint is taken to have been held with [s]."""
LATE: Final = 2
"""Ticks that readings may be late without an end: control is designed with one."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Channel:
    """A sensor and the motor that moves what it reads."""

    name: str
    fastest: float
    """Speed that what is read can have at most, from its file; infinite: any."""
    limit: float = math.inf
    """Largest command of its motor; infinite: none is known, or there is no motor."""


class ReadingMonitor:
    """Believes, bridges or gives up the readings of a robot's sensors. Without a fault what is believed is what is read, to the last bit.

    Args:
        channels: Sensors in the order of their readings.
        period: Of the control [s].
    """

    def __init__(self, channels: Sequence[Channel], period: float) -> None:
        self.channels, self.period = tuple(channels), period
        n = len(self.channels)
        self.values, self.speeds, self.commands = np.zeros(n), np.zeros(n), np.zeros(n)
        """Readings and speeds, to be filled in before `see` and believed afterwards; commands since the reading before, shape (n,)."""
        self.free = np.ones(n, np.bool_)
        """Whether what moves a reading was free to move meanwhile: joints of a limb that holds on are if it does alone, shape (n,)."""
        self.silent = np.zeros(n, np.bool_)
        """Whether a reading stays the same now whatever its motor does; of a joint that is not free, that alone is no fault, shape (n,)."""
        self._bounds, self._memory = np.zeros((BOUNDS, n)), np.zeros((MEMORY, n))
        for k, channel in enumerate(self.channels):
            self._bounds[FASTEST, k], self._bounds[SLOW, k] = channel.fastest, FOLLOWS * channel.fastest
            self._bounds[AGAINST, k] = GIVES_WAY * channel.fastest
            self._bounds[ANSWER, k], self._bounds[FULL, k] = ANSWERING * channel.limit, FULL_COMMAND * channel.limit
        self.driven: Final = self._memory[DRIVEN]
        """Ticks of a full command that each reading does not follow, shape (n,)."""
        self._verdicts = np.zeros(n, np.int64)
        self._patience = np.ceil(np.array((UNMOVED, FULLY_DRIVEN, YIELDS)) / period)
        held = Handle(
            self.values, self.speeds, self.commands, self.free, self._bounds, self._patience, self._memory, self._verdicts,
            period, min(1.0, period / MEANT),
        )  # fmt: skip
        self._check = ready(check_readings, held, 0)
        self._most = max(LEAST_BRIDGED, round(BRIDGED / period))
        self._judged = JUDGED / period
        self.findings: list[Finding] = []
        """Since the reset, each kind at each place once."""
        self._known: set[tuple[str, str]] = set()
        self.bad: set[int] = set()
        """Indices of channels that are not to be relied upon any more."""
        self.linked = True
        """Whether the link to the plant is to be relied upon."""
        self.closed = False
        """Whether what is noticed is no longer written down: the run has ended, and the robot holds still."""
        self.clear = 0
        """Ticks since a reading was bridged last, or came late, or since the reset."""
        self.reset()

    def reset(self) -> None:
        """Forget everything: the robot is put somewhere else."""
        self._memory[:] = 0.0
        self._failed, self._failed_at = np.zeros(len(self.channels)), np.zeros(len(self.channels))
        self._unanswered, self._looked = np.zeros(len(self.channels)), 0
        self.findings.clear()
        self._known.clear()
        self.bad.clear()
        self.silent[:] = False
        self.linked, self.closed = True, False
        self._ticks, self._newest, self._ahead, self._overdue, self._stale = 0, -1, 0, 0, 0
        self.clear = 0

    def after_pause(self) -> None:
        """Believe the next reading whatever it is: time has passed, and nobody has looked."""
        self._memory[:] = 0.0
        self._newest = -1

    @property
    def time(self) -> float:
        """Since the reset [s]."""
        return self._ticks * self.period

    @property
    def usual_commands(self) -> Floats:
        """With what the motors were driven lately, shape (n,)."""
        usual: Floats = self._memory[MEAN]
        return usual

    @property
    def unchanged(self) -> Floats:
        """Ticks for which each reading has not changed by a count, shape (n,)."""
        ticks: Floats = self._memory[SAME]
        return ticks

    def see(self, number: int = -1) -> None:
        """Take in a tick's `values`, `speeds` and `commands`.

        Args:
            number: Of the reading, one more for each period since the reset; -1: nobody tells.

        Raises:
            FaultError: If a sensor, a joint or the link has failed for good.
        """
        self._ticks += 1
        if number == self._newest + 1 and number - self._ticks == self._ahead:  # in time, as nearly all are
            elapsed, self._newest, self._overdue, self._stale = 1, number, 0, 0
        else:
            elapsed = 1 if number < 0 else self._elapsed(number)
        if self._check(elapsed):
            self.clear = 0 if self._verdicts.any() else self.clear + 1
            self._look()
        else:
            self.clear += 1
            if self._looked:
                self.silent[:], self._looked = False, 0
        if elapsed > 1:
            self.clear = 0
        if self._overdue > self._most:
            self.linked = False
            self.fail("late readings", "", f"readings have been more than {LATE} ticks late for {self._overdue} ticks")

    def _elapsed(self, number: int) -> int:
        """Ticks from the newest reading before to this one, 0 if it is no newer; tells what is wrong with the link."""
        newest, ahead = self._newest, number - self._ticks
        self._newest = max(newest, number)
        if newest < 0:
            self._ahead = ahead
            return 1
        late = self._ahead - ahead
        if late < 0:
            self._ahead = ahead
            self.note("uneven ticks", "", f"{number - newest} periods passed between two readings")
        elif late > 0:
            self.note("no reading", "", "a reading did not come in time, or an old one came in its place")
        self._overdue = self._overdue + 1 if late > LATE else 0
        if number <= newest:
            self._stale += 1
            return 0
        elapsed, self._stale = max(1, number - newest - self._stale), 0  # ticks without a reading have been counted
        return elapsed

    def note(self, kind: str, where: str, why: str) -> None:
        """Write down that a fault has been noticed, once for each kind and place."""
        if not self.closed and (kind, where) not in self._known:
            self._known.add((kind, where))
            self.findings.append(Finding(kind, where, self.time, why))

    def fail(self, kind: str, where: str, why: str) -> None:
        """End the run for a fault.

        Raises:
            FaultError: Always.
        """
        self.note(kind, where, why)
        raise FaultError(f"{where}: {kind}: {why}" if where else f"{kind}: {why}")

    def leave_out(self, c: int) -> None:
        """Ask no more of a channel than that it is a number."""
        self._bounds[:, c] = math.inf

    def tell_silent(self, c: int) -> None:
        """End the run, as a channel's reading stays the same whatever its motor does.

        Raises:
            FaultError: Always.
        """
        self.bad.add(c)
        change, time = self._memory[HIGH, c] - self._memory[LOW, c], self._memory[SAME, c] * self.period
        why = f"its reading has not changed by a count for {time:.2f} s, its command by {change:.3g}"
        self.fail("no answer", self.channels[c].name, f"sensor stuck or motor dead: {why}")

    def _look(self) -> None:
        memory = self._memory
        for c in np.flatnonzero((self._verdicts == NO_NUMBER) | (self._verdicts == JUMP)):
            name, no_number = self.channels[c].name, self._verdicts[c] == NO_NUMBER
            kind = "no number" if no_number else "jump"
            self.note(
                kind, name, "a reading was no number" if no_number else "a reading jumped farther than a joint can"
            )
            self._failed[c] = max(0.0, self._failed[c] - FAILING * (self._ticks - self._failed_at[c])) + 1.0
            self._failed_at[c] = self._ticks
            if memory[AGE, c] > self._most or self._failed[c] > FAILING * self._judged:
                self.bad.add(int(c))
                self.fail(kind, name, f"the sensor has failed {memory[AGE, c]:.0f} times on end, or too often")
        if memory[AGE].max() > self._most:
            self.linked = False
            self.fail("no reading", "", f"no new reading for {memory[AGE].max():.0f} ticks")
        believed = self._verdicts == BELIEVED
        same = (memory[SAME] >= self._patience[0]) & (memory[HIGH] - memory[LOW] > self._bounds[ANSWER])
        if self._looked != self._ticks - 1:
            self._unanswered[:] = 0.0
        self._unanswered, self._looked = np.where(believed & same, self._unanswered + 1.0, 0.0), self._ticks
        self.silent = self._unanswered > self._most  # a joint at rest answers a jump of its torque a moment later
        loose = memory[LOOSE] >= self._patience[0] + self._most
        stirred = memory[LOOSE_HIGH] - memory[LOOSE_LOW] > self._bounds[ANSWER] * STIRRED
        for c in np.flatnonzero(self.silent & loose & stirred):
            self.tell_silent(int(c))
        overcome = (memory[DRIVEN] >= self._patience[1]) | (memory[YIELDING] >= self._patience[2])
        for c in np.flatnonzero(believed & overcome):
            self.bad.add(int(c))
            ticks, does = memory[YIELDING, c], "turns against it"
            if memory[DRIVEN, c] >= self._patience[1]:
                ticks, does = memory[DRIVEN, c], "does not follow"
            why = f"it has been driven with {self.commands[c]:.3g} for {ticks * self.period:.2f} s and {does}"
            self.fail("overpowered", self.channels[c].name, f"motor dead, weak or overloaded: {why}")
