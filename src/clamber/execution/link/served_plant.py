"""A plant in its server's hands: moved by a client's commands, held where it is when there are none, and stopped beyond its limits."""

from collections.abc import Callable
from typing import Final

import numpy as np

from ...types import Floats
from ..hardware import Hardware, Reading
from ..posture_guard import PostureGuard
from .envelope import Envelope
from .messages import STOPS, About, Sample, Stop

HELD: Final = 2.0
"""For which a plant that waits for commands is held after a safe stop, to see whether the robot stays [s]."""


class ServedPlant:
    """Moves a plant period by period, whoever asks for it, and makes safe stops.

    Args:
        hardware: The plant.
        about: What clients are told of it.
        guard: Of the same robot.
        envelope: Of the same robot.
        say: Told what happens.
        held: Called once the posture has been held for `HELD` after a safe stop.
    """

    def __init__(
        self,
        hardware: Hardware,
        about: About,
        guard: PostureGuard,
        envelope: Envelope,
        say: Callable[[str], None],
        held: Callable[[], None],
    ) -> None:
        self._hardware, self._about, self._guard, self._envelope = hardware, about, guard, envelope
        self._say, self._held = say, held
        self.stop = Stop.NONE
        """Since the last start."""
        self.stops: list[Stop] = []
        """All safe stops so far."""
        self.placed = self.driven = self.paused = False
        """Whether there has been a start; a command of the client since; a pause since that."""
        self.reading = Reading(np.zeros(about.readings, np.int32), 0)
        """The latest."""
        self.held_until = 0
        """Tick at which the robot has been held for long enough after a safe stop; 0: that is no question."""
        self._commands = guard.at_rest.copy()

    @property
    def under_way(self) -> bool:
        """Whether a client drives it."""
        return self.driven and not self.stop

    def start(self, start: Floats) -> None:
        """Put the robot somewhere and hold it there, whatever was before."""
        self._hardware.reset(start)
        self.reading = self._hardware.sense()
        self._envelope.reset()
        self._commands = self._guard.at_rest.copy()
        self.hold_here()
        self.stop, self.placed, self.driven, self.paused, self.held_until = Stop.NONE, True, False, False, 0

    def check(self, commands: Floats) -> None:
        """Make sure that commands are within its limits.

        Raises:
            MessageError: If they are not.
        """
        self._envelope.check(commands)

    def drive(self, commands: Floats) -> None:
        """Go by these commands from now on."""
        self._commands, self.driven, self.paused = commands, True, False

    def pause(self) -> None:
        """Hold the posture until the next command."""
        self.paused = True
        self.hold_here()

    def hold_here(self) -> None:
        """Have the guard hold the present posture, with the latest commands fed forward, where there are no commands."""
        self._guard.hold(self.reading, self._commands)

    def step(self) -> None:
        """Let a period pass: by the commands, with a safe stop beyond its limits, or held."""
        if not self.under_way or self.paused:
            self._hold()
            return
        self._advance(self._commands)
        fault = self._envelope.fault(self.reading)
        if fault is not None:
            self.make_stop(Stop.ENVELOPE, fault)

    def make_stop(self, stop: Stop, why: str = "") -> None:
        """From now on the guard holds the posture."""
        self.stop = stop
        self.stops.append(stop)
        self.hold_here()
        self._say(
            f"safe stop at tick {self.reading.tick}: {STOPS[stop]}{f' ({why})' if why else ''}; the posture is held"
        )
        self.held_until = self.reading.tick + round(HELD / self._about.period)
        while not self._about.real_time and self.held_until:
            self._hold()

    def sample(self, answers: int, stop: Stop | None = None) -> Sample:
        """What a client is told: the latest reading, the number of the message that it answers, and a stop, its own unless given."""
        reading = self.reading
        return Sample(
            reading.tick, answers, self.stop if stop is None else stop, reading.counts, self._hardware.truth()
        )

    def _hold(self) -> None:
        """One period with the guard; told, some time after a safe stop, how still the robot stays."""
        self._advance(self._guard.commands(self.reading))
        if self.held_until and self.reading.tick >= self.held_until:
            self.held_until = 0
            moved = np.degrees(self._guard.moved(self.reading))
            self._say(f"held for {HELD:g} s: no joint has moved by more than {moved:.2f} deg")
            self._held()

    def _advance(self, commands: Floats) -> None:
        self._hardware.actuate(commands)
        self._hardware.step()
        self.reading = self._hardware.sense()
        self._envelope.warm(commands)
