"""The server of a plant: it owns the hardware, carries a client's commands out, and holds the robot up when there is none."""

import contextlib
import select
import socket
import time
from collections import deque
from collections.abc import Callable
from typing import Final, Protocol

import numpy as np

from ..hardware import Hardware, Reading
from ..posture_guard import PostureGuard
from .channel import PIECE, Channel, ConnectionEndedError
from .messages import (
    STOPS,
    About,
    Kind,
    Message,
    MessageError,
    Sample,
    Stop,
    pack_about,
    pack_refusal,
    pack_sample,
    unpack_nothing,
    unpack_numbers,
)

MOST_TICKS: Final = 20_000
"""Whose lateness is kept."""
SILENT_TICKS: Final = 2
"""So many ticks without a command, and the robot stops."""
PATIENCE: Final = 2.0
"""For a client's first message, and for the rest of one that has begun [s]."""
MOST_LEAVING: Final = 8
"""Connections that may be hanging up at once; knocking often must not use up what the system lets a process open."""
LONGEST_PAUSE: Final = 120.0
"""That a client may ask for; a robot that hangs on warm motors is no place to think for longer [s]."""
HELD: Final = 2.0
"""For which a plant that waits for commands is held after a safe stop, to see whether the robot stays [s]."""
Say = Callable[[str], None]


class Clock(Protocol):
    """Time as a server has it."""

    def now(self) -> float:
        """[s], from anywhere."""

    def select(self, sockets: list[socket.socket], timeout: float | None) -> list[socket.socket]:
        """Those of `sockets` that can be read, after waiting for one for at most `timeout` [s]; None: for ever."""


class WallClock:
    """The machine's."""

    def now(self) -> float:
        """See `Clock`."""
        return time.monotonic()

    def select(self, sockets: list[socket.socket], timeout: float | None) -> list[socket.socket]:
        """See `Clock`."""
        return select.select(sockets, [], [], timeout)[0]


class PlantServer:
    """Serves a plant to one client at a time, for ever or until the first has gone.

    In lock-step a command is one period. In real time the plant moves on by the server's own clock, takes the latest command, and
    after two ticks without one makes a safe stop: see `PostureGuard`. A client that is lost or talks nonsense is a safe stop in both.
    After a safe stop commands change nothing until there is a new start.

    Args:
        hardware: The plant.
        about: What clients are told of it.
        guard: Of the same robot.
        listener: Where clients connect.
        say: Told what happens.
        once: Whether to end when the first client has gone.
        clock: The machine's unless given.
    """

    def __init__(
        self,
        hardware: Hardware,
        about: About,
        guard: PostureGuard,
        listener: socket.socket,
        *,
        say: Say,
        once: bool = False,
        clock: Clock | None = None,
    ) -> None:
        self.hardware, self.about, self.guard = hardware, about, guard
        self.stop = Stop.NONE
        """Of the last client."""
        self.stops: list[Stop] = []
        """All safe stops so far."""
        self._lateness: deque[float] = deque(maxlen=MOST_TICKS)
        listener.setblocking(False)
        self._listener, self._say, self._once = listener, say, once
        self._clock = WallClock() if clock is None else clock
        self._wall_period = about.period / about.pace
        self._channel: Channel | None = None
        self._leaving: list[tuple[Channel, float]] = []
        """Those that have been let go, and until when."""
        self._welcomed, self._since = False, 0.0
        self._placed = self._driven = self._paused = False
        self._reading = Reading(np.zeros(about.readings, np.int32), 0)
        self._commands = guard.at_rest.copy()
        self._fresh, self._silent, self._answers = False, 0, 0
        self._next, self._held_until = 0.0, 0
        self._over = False

    def serve(self) -> None:
        """Until the first client has gone, if `once`; for ever else."""
        try:
            while not self._over:
                self._turn()
        finally:
            self._listener.close()
            if self._channel is not None:
                self._tell_end()
            for channel, _ in self._leaving:
                channel.hang_up()

    def _turn(self) -> None:
        sockets = [self._listener, *(channel.socket for channel, _ in self._leaving)]
        if self._channel is not None:
            sockets.append(self._channel.socket)
        ready = self._clock.select(sockets, self._patience())
        self._sweep(ready)
        if self._listener in ready:
            self._welcome()
        if self._channel is not None:
            self._attend(self._channel, self._channel.socket in ready)
        if self.about.real_time and self._placed:
            late = self._clock.now() - self._next
            if late >= 0.0:
                self._tick(late)

    def _patience(self) -> float | None:
        """How long there is nothing to do but wait for bytes."""
        if self.about.real_time and self._placed:
            return max(0.0, self._next - self._clock.now())
        if self._leaving or (self._channel is not None and (not self._welcomed or self._channel.partial)):
            return PATIENCE / 4
        return None

    def _welcome(self) -> None:
        try:
            made, _ = self._listener.accept()
            channel = Channel(made)
        except OSError:  # whoever knocked is gone
            return
        if self._channel is None:
            self._channel, self._welcomed, self._since = channel, False, self._clock.now()
            return
        self._refuse(channel, "another client drives this plant")
        self._dismiss(channel)

    def _attend(self, channel: Channel, ready: bool) -> None:
        """Take in what the client says; it is let go if that is no message, or none comes."""
        try:
            if ready:
                for message in channel.read():
                    self._obey(channel, message)
                    if self._channel is None:
                        return
            if self._welcomed and not channel.partial:
                self._since = self._clock.now()
            elif self._clock.now() - self._since > PATIENCE:
                what = "the rest of a message" if channel.partial else "a HELLO"
                raise MessageError(what, "missing", f"must come within {PATIENCE:g} s")
        except ConnectionEndedError as end:
            self._let_go(Stop.LOST, str(end))
        except MessageError as error:
            self._refuse(channel, str(error))
            self._let_go(Stop.GARBLED, str(error))

    def _obey(self, channel: Channel, message: Message) -> None:
        kind, payload = message.kind, message.payload
        if not self._welcomed:
            if kind is not Kind.HELLO:
                raise MessageError("the first message", f"a {kind.name}", "must be a HELLO")
            unpack_nothing(kind, payload)
            self._welcomed = True
            channel.send(Kind.WELCOME, pack_about(self.about))
        elif kind is Kind.START:
            self._start(channel, message)
        elif kind is Kind.COMMAND:
            self._command(channel, message)
        elif kind is Kind.PAUSE:
            unpack_nothing(kind, payload)
            self._pause(message)
        elif kind is Kind.BYE:
            unpack_nothing(kind, payload)
            self._let_go(Stop.NONE, "")
        else:
            raise MessageError("a client's message", f"a {kind.name}", "must be a START, COMMAND, PAUSE or BYE")

    def _start(self, channel: Channel, message: Message) -> None:
        start = unpack_numbers(message.kind, message.payload, self.about.starts)
        self.hardware.reset(start)
        self._reading, self._answers = self.hardware.sense(), message.number
        self._commands = self.guard.at_rest.copy()
        self.guard.hold(self._reading, self._commands)
        self.stop, self._placed, self._driven = Stop.NONE, True, False
        self._fresh, self._silent, self._held_until, self._paused = False, 0, 0, False
        self._next = self._clock.now() + self._wall_period
        self._send_sample(channel)

    def _command(self, channel: Channel, message: Message) -> None:
        commands = unpack_numbers(message.kind, message.payload, self.about.commands)
        if not self._placed:
            raise MessageError("a COMMAND", "the first", "must follow a START")
        self._answers = message.number
        if self.stop:  # until a new start
            if not self.about.real_time:
                self._send_sample(channel)
            return
        self._commands, self._fresh, self._driven, self._silent = commands, True, True, 0
        self._paused = False
        if not self.about.real_time:
            self._advance(commands)
            self._send_sample(channel)

    def _pause(self, message: Message) -> None:
        """The guard holds, and silence is no stop, until the next command."""
        self._answers = message.number
        if self._driven and not self.stop and not self._paused:
            self._paused, self._silent = True, 0
            self.guard.hold(self._reading, self._commands)

    def _tick(self, late: float) -> None:
        """One period by the clock."""
        self._lateness.append(late)
        self._next += self._wall_period
        if late > self._wall_period:
            self._next = self._clock.now() + self._wall_period  # lost time is not caught up with
        if self._driven and not self.stop and not self._fresh:
            self._silent += 1
            if self._silent >= (LONGEST_PAUSE / self.about.period if self._paused else SILENT_TICKS):
                self._make_stop(Stop.SILENT, "")
        self._fresh = False
        if self._driven and not self.stop and not self._paused:
            self._advance(self._commands)
        else:
            self._hold()
        if self._channel is not None and self._welcomed:
            try:
                self._send_sample(self._channel)
            except ConnectionEndedError as end:
                self._let_go(Stop.LOST, str(end))

    def _advance(self, commands: np.ndarray) -> None:
        self.hardware.actuate(commands)
        self.hardware.step()
        self._reading = self.hardware.sense()

    def _send_sample(self, channel: Channel, stop: Stop | None = None) -> None:
        reading = self._reading
        sample = Sample(
            reading.tick, self._answers, self.stop if stop is None else stop, reading.counts, self.hardware.truth()
        )
        channel.send(Kind.SAMPLE, pack_sample(sample), timeout=0.0 if self.about.real_time else PATIENCE)

    def _make_stop(self, stop: Stop, why: str) -> None:
        """From now on the guard holds the posture."""
        self.stop = stop
        self.stops.append(stop)
        self.guard.hold(self._reading, self._commands)
        self._say(
            f"safe stop at tick {self._reading.tick}: {STOPS[stop]}{f' ({why})' if why else ''}; the posture is held"
        )
        self._held_until = self._reading.tick + round(HELD / self.about.period)
        while not self.about.real_time and self._held_until:
            self._hold()

    def _hold(self) -> None:
        """One period with the guard; told, some time after a safe stop, how still the robot stays."""
        self._advance(self.guard.commands(self._reading))
        if self._held_until and self._reading.tick >= self._held_until:
            self._held_until = 0
            moved = np.degrees(self.guard.moved(self._reading))
            self._say(f"held for {HELD:g} s: no joint has moved by more than {moved:.2f} deg")
            self._over = self._over or (self._once and self._channel is None)

    def _refuse(self, channel: Channel, why: str) -> None:
        with contextlib.suppress(ConnectionEndedError):
            channel.send(Kind.REFUSAL, pack_refusal(why), timeout=0.0)

    def _dismiss(self, channel: Channel) -> None:
        """Hang up, but not before the client has: else the system throws away what it has not read yet, such as why."""
        with contextlib.suppress(OSError):
            channel.socket.shutdown(socket.SHUT_WR)
        self._leaving.append((channel, self._clock.now() + PATIENCE))
        if len(self._leaving) > MOST_LEAVING:
            self._leaving.pop(0)[0].hang_up()

    def _sweep(self, ready: list[socket.socket]) -> None:
        """Let those go that have hung up, or do not."""
        for entry in list(self._leaving):
            channel, until = entry
            gone = self._clock.now() > until
            try:
                gone = gone or (channel.socket in ready and not channel.socket.recv(PIECE))
            except OSError:
                gone = True
            if gone:
                self._leaving.remove(entry)
                channel.hang_up()

    def _let_go(self, stop: Stop, why: str) -> None:
        """The client goes, or is sent; a robot that it drove stays as it is."""
        channel, self._channel = self._channel, None
        assert channel is not None
        self._dismiss(channel)
        if self._driven and not self.stop:
            if stop:
                self._make_stop(stop, why)
            else:
                self.guard.hold(self._reading, self._commands)
                self._say("the client has ended; the posture is held")
        elif stop:
            self._say(f"the client is let go: {why}")
        self._tell_times()
        self._driven = False
        self._over = self._once and self._welcomed and not self._held_until

    def _tell_times(self) -> None:
        """How well the clock was kept for the client that goes."""
        if not self._lateness:
            return
        late = np.array(self._lateness)
        self._lateness.clear()
        middle, most = 1e3 * np.quantile(late, (0.5, 0.99))
        lost = int(np.count_nonzero(late > self._wall_period))
        self._say(
            f"the last {len(late)} ticks began {middle:.2f} ms late in the median, 99 % within {most:.2f} ms; "
            f"{lost} were a period late or more"
        )

    def _tell_end(self) -> None:
        """The server itself ends."""
        channel = self._channel
        assert channel is not None
        with contextlib.suppress(ConnectionEndedError):
            if self._placed:
                self._send_sample(channel, Stop.ENDED)
        channel.hang_up()
