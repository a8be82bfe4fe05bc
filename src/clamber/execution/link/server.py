"""The server of a plant: it owns the hardware, carries a client's commands out, and holds the robot up when there is none."""

import contextlib
import hmac
import socket
from collections.abc import Callable
from typing import Final

from ..hardware import Hardware
from ..posture_guard import PostureGuard
from .channel import Channel, ConnectionEndedError, LinkError, address_of
from .clock import Clock, Lateness, WallClock
from .envelope import Envelope
from .messages import (
    About,
    Kind,
    Message,
    MessageError,
    Stop,
    pack_about,
    pack_refusal,
    pack_sample,
    unpack_nothing,
    unpack_numbers,
    unpack_stop,
)
from .reception import PATIENCE, Reception, peer_of
from .served_plant import ServedPlant
from .token import read_token, remove_token, write_token

SILENT_TICKS: Final = 2
"""So many ticks without a command, and the robot stops."""
MOST_MESSAGES: Final = 64
"""Of a client between two ticks of the clock; it is to send one, and reading more than this costs a good part of a tick."""
IDLE: Final = 30.0
"""For which a client that drives nothing may be silent while another asks for the plant [s]."""
LONGEST_PAUSE: Final = 120.0
"""That a client may ask for; a robot that hangs on warm motors is no place to think for longer [s]. One that drives a plant that waits for
its commands may be silent for as long while another asks for it."""
LATCHED: Final = "an operator has stopped this plant; `clamber plant release` gives it back"
Say = Callable[[str], None]


class PlantServer:
    """Serves a plant to one client at a time, for ever or until the first has gone.

    In lock-step a command is one period. In real time the plant moves on by the server's own clock, takes the latest command, and
    after two ticks without one makes a safe stop: see `PostureGuard`. A client that is lost or talks nonsense is a safe stop in both,
    and so is a robot beyond its envelope. After a safe stop commands change nothing until there is a new start.

    Args:
        hardware: The plant.
        about: What clients are told of it.
        guard: Of the same robot.
        envelope: Of the same robot.
        listener: Where clients connect.
        say: Told what happens; one that fails stops nothing.
        once: Whether to end when the first client has gone.
        clock: The machine's unless given.

    Raises:
        LinkError: If its token cannot be written, by which operators may stop it.
    """

    def __init__(
        self,
        hardware: Hardware,
        about: About,
        guard: PostureGuard,
        envelope: Envelope,
        listener: socket.socket,
        *,
        say: Say,
        once: bool = False,
        clock: Clock | None = None,
    ) -> None:
        self.about, self._plant = about, ServedPlant(hardware, about, guard, envelope, self._say, self._note_held)
        self._clock = WallClock() if clock is None else clock
        self._reception, self._tell, self._once = Reception(listener, self._clock.now), say, once
        self._address = address_of(listener)
        self._wall_period = about.period / about.pace
        self._lateness = Lateness(self._wall_period)
        self._channel: Channel | None = None
        self._who, self._taken, self._heard = "", 0.0, 0.0
        """Of the client: who it is, since when it is there, and when it last said something."""
        self._since, self._said = 0.0, 0
        """When what a client says was last whole; its messages since the last tick."""
        self._fresh, self._silent, self._answers, self._next = False, 0, 0, 0.0
        self._latched, self._over, self._ending = False, False, ""
        self._bell, self._rope = socket.socketpair()
        self._rope.setblocking(False)
        write_token(self._address)

    @property
    def stops(self) -> list[Stop]:
        """All safe stops so far."""
        return self._plant.stops

    def serve(self) -> None:
        """Until the first client has gone, if `once`; until `ask_to_end` else."""
        try:
            while not self._over:
                self._turn()
        finally:
            if self._channel is not None:
                self._tell_end()
            self._reception.close()
            self._bell.close()
            self._rope.close()
            remove_token(self._address)

    def ask_to_end(self, why: str) -> None:
        """Have the server make a safe stop, hold for 2 s and end; may be called from signal handlers and other threads."""
        self._ending = self._ending or why
        with contextlib.suppress(OSError):
            self._rope.send(b"!")

    def _turn(self) -> None:
        sockets = [*self._reception.sockets(), self._bell]
        if self._channel is not None:
            sockets.append(self._channel.socket)
        ready = self._clock.select(sockets, self._patience())
        if self._channel is not None:
            self._attend(self._channel, self._channel.socket in ready)
        for channel, messages in self._reception.first_words(ready):
            self._welcome(channel, messages)
        if self._bell in ready:
            self._bell.recv(16)
            self._close_down()
        if self.about.real_time and self._plant.placed:
            late = self._clock.now() - self._next
            if late >= 0.0:
                self._tick(late)

    def _patience(self) -> float | None:
        """How long there is nothing to do but wait for bytes."""
        if self.about.real_time and self._plant.placed:
            return max(0.0, self._next - self._clock.now())
        if self._reception.busy or (self._channel is not None and self._channel.partial):
            return PATIENCE / 4
        return None

    def _welcome(self, channel: Channel, messages: list[Message]) -> None:
        """Take in the first that somebody says: it may become the client, or is an operator."""
        first, *rest = messages
        try:
            if first.kind is Kind.STOP:
                self._obey_operator(channel, first)
                return
            if first.kind is not Kind.HELLO:
                raise MessageError("the first message", f"a {first.kind.name}", "must be a HELLO or STOP")
            unpack_nothing(first.kind, first.payload)
        except (MessageError, ConnectionEndedError, LinkError) as error:
            self._say(f"a connection is let go: {error}")
            self._reception.refuse(channel, str(error))
            self._reception.dismiss(channel)
            return
        now = self._clock.now()
        silent = now - self._heard
        if self._channel is not None and silent > (LONGEST_PAUSE if self._plant.under_way else IDLE):
            self._reception.refuse(self._channel, "another client has asked for the plant")
            self._let_go(Stop.LOST, f"it has said nothing for {silent:.0f} s, and another asks")
        busy = self._closed
        if self._channel is not None:
            busy = f"another client drives this plant: {self._who}, for {now - self._taken:.0f} s, last heard {silent:.1f} s ago"
        if busy:
            self._reception.refuse(channel, busy)
            self._reception.dismiss(channel)
            return
        self._channel, self._who, self._taken, self._heard, self._since = channel, peer_of(channel), now, now, now
        try:
            channel.send(Kind.WELCOME, pack_about(self.about))
        except ConnectionEndedError as end:
            self._let_go(Stop.LOST, str(end))
            return
        self._take_in(channel, rest)

    @property
    def _closed(self) -> str:
        """Why nobody may start; nothing if one may."""
        return LATCHED if self._latched else "its server ends" if self._ending else ""

    def _obey_operator(self, channel: Channel, message: Message) -> None:
        """Stop safely, whoever drives, or give the plant back after such a stop.

        Raises:
            MessageError: If the message is none, or its token another.
            LinkError: If there is no token.
        """
        token, release = unpack_stop(message.payload)
        if not hmac.compare_digest(token, read_token(self._address)):
            raise MessageError("the token of a STOP", "another", "must be that of this server")
        self._latched = not release
        if self._plant.under_way and not release:
            self._plant.make_stop(Stop.OPERATOR)
        said = "clients may start again" if release else f"stopped at tick {self._plant.reading.tick}; {LATCHED}"
        self._say(f"an operator: {said}")
        channel.send(Kind.DONE, pack_refusal(said))
        self._reception.dismiss(channel)

    def _attend(self, channel: Channel, ready: bool) -> None:
        """Take in what the client says; it is let go if that is no message, or the rest of one does not come."""
        try:
            messages = channel.read() if ready else []
        except ConnectionEndedError as end:
            self._let_go(Stop.LOST, str(end))
        except MessageError as error:
            self._send_away(Stop.GARBLED, str(error))
        else:
            self._take_in(channel, messages)

    def _take_in(self, channel: Channel, messages: list[Message]) -> None:
        try:
            for message in messages:
                self._heard = self._clock.now()
                self._said += 1
                if self.about.real_time and self._plant.placed and self._said > MOST_MESSAGES:
                    raise MessageError(
                        "a client's messages between two ticks", self._said, f"must be at most {MOST_MESSAGES}"
                    )
                self._obey(channel, message)
                if self._channel is not channel:
                    return
            if not channel.partial:
                self._since = self._clock.now()
            elif self._clock.now() - self._since > PATIENCE:
                raise MessageError("the rest of a message", "missing", f"must come within {PATIENCE:g} s")
        except ConnectionEndedError as end:
            self._let_go(Stop.LOST, str(end))
        except MessageError as error:
            self._send_away(Stop.GARBLED, str(error))

    def _obey(self, channel: Channel, message: Message) -> None:
        kind, payload = message.kind, message.payload
        if kind is Kind.START and self._closed:
            self._send_away(Stop.NONE, self._closed)
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
        self._plant.start(unpack_numbers(message.kind, message.payload, self.about.starts))
        self._lateness.forget_overruns()
        self._fresh, self._silent, self._answers = False, 0, message.number
        self._next = self._clock.now() + self._wall_period
        self._send_sample(channel)

    def _command(self, channel: Channel, message: Message) -> None:
        commands = unpack_numbers(message.kind, message.payload, self.about.commands)
        self._plant.check(commands)
        if not self._plant.placed:
            raise MessageError("a COMMAND", "the first", "must follow a START")
        self._answers = message.number
        if not self._plant.stop:  # else until a new start
            self._plant.drive(commands)
            self._fresh, self._silent = True, 0
            if not self.about.real_time:
                self._plant.step()
        if not self.about.real_time:
            self._send_sample(channel)

    def _pause(self, message: Message) -> None:
        """The guard holds, and silence is no stop, until the next command."""
        self._answers = message.number
        if self._plant.under_way and not self._plant.paused:
            self._silent = 0
            self._plant.pause()

    def _tick(self, late: float) -> None:
        """One period by the clock."""
        self._lateness.note(late)
        self._next += self._wall_period
        self._said = 0
        if late > self._wall_period:
            self._next = self._clock.now() + self._wall_period  # lost time is not caught up with
        if self._plant.under_way and not self._fresh:
            self._silent += 1
            if self._silent >= (LONGEST_PAUSE / self.about.period if self._plant.paused else SILENT_TICKS):
                self._plant.make_stop(Stop.SILENT)
        if self._plant.under_way and (problem := self._lateness.problem()) is not None:
            self._plant.make_stop(Stop.OVERRUN, problem)
        self._fresh = False
        self._plant.step()
        if self._channel is not None:
            try:
                self._send_sample(self._channel)
            except ConnectionEndedError as end:
                self._let_go(Stop.LOST, str(end))

    def _send_sample(self, channel: Channel, stop: Stop | None = None) -> None:
        sample = self._plant.sample(self._answers, stop)
        channel.send(Kind.SAMPLE, pack_sample(sample), timeout=0.0 if self.about.real_time else PATIENCE)

    def _note_held(self) -> None:
        """The robot has been held for a while after a safe stop: a server that is to end has waited for that."""
        self._over = self._over or bool(self._ending) or (self._once and self._channel is None)

    def _send_away(self, stop: Stop, why: str) -> None:
        assert self._channel is not None
        self._reception.refuse(self._channel, why)
        self._let_go(stop, why)

    def _let_go(self, stop: Stop, why: str) -> None:
        """The client goes, or is sent; a robot that it drove stays as it is."""
        channel, self._channel = self._channel, None
        assert channel is not None
        self._reception.dismiss(channel)
        if self._plant.under_way:
            if stop:
                self._plant.make_stop(stop, why)
            else:
                self._plant.hold_here()
                self._say("the client has ended; the posture is held")
        elif stop:
            self._say(f"the client is let go: {why}")
        times = self._lateness.summary()
        if times is not None:
            self._say(times)
        self._plant.driven = False
        self._over = self._over or (self._once and not self._plant.held_until)

    def _close_down(self) -> None:
        """A safe stop, held until it is seen whether the robot stays; at once where nobody drives it."""
        if self._plant.under_way:
            self._plant.make_stop(Stop.ENDED, self._ending)
        self._over = not self._plant.held_until

    def _say(self, what: str) -> None:
        with contextlib.suppress(OSError):  # whoever listened is gone, such as a terminal
            self._tell(what)

    def _tell_end(self) -> None:
        """The server itself ends."""
        channel = self._channel
        assert channel is not None
        with contextlib.suppress(ConnectionEndedError):
            if self._plant.placed:
                self._send_sample(channel, Stop.ENDED)
        channel.hang_up()
