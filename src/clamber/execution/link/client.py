"""The way to a plant in another process: the same `Hardware` as if it were here."""

import contextlib
import time
from types import TracebackType
from typing import Final, Self

import numpy as np

from ...types import Floats
from ..hardware import Reading
from ..plant import PlantStoppedError
from .channel import Address, Channel, ConnectionEndedError, LinkError, connect
from .messages import (
    STOPS,
    About,
    Kind,
    Message,
    MessageError,
    Sample,
    Stop,
    cut,
    pack_numbers,
    pack_stop,
    unpack_about,
    unpack_refusal,
    unpack_sample,
)
from .token import read_token

ANSWER: Final = 10.0
"""Longest wait for a server's answer [s]."""
STILL_TICKS: Final = 200
"""Periods of the clock in which a plant that keeps its own time must tell of a new tick; a busy machine loses a few."""


class RemoteHardware:
    """A plant that a server in another process owns, as `Hardware`; a context manager that hangs up at its end.

    Args:
        address: Where it is served.

    Raises:
        LinkError: If nobody serves a plant there, the server refuses, or it is no server of this version.
    """

    def __init__(self, address: Address) -> None:
        self._address = address
        self._channel: Channel = connect(address, ANSWER)
        try:
            self._channel.send(Kind.HELLO)
            self.about: About = unpack_about(self._expect(Kind.WELCOME).payload)
        except (ConnectionEndedError, MessageError) as error:
            self._channel.hang_up()
            raise self._no_link(f"no plant's server answers there: {error}") from None
        except PlantStoppedError as error:
            self._channel.hang_up()
            raise self._no_link(str(error)) from None
        self.period = self.about.period
        self._commands = np.zeros(self.about.commands)
        none = np.zeros(self.about.truths)
        self.sample = Sample(0, 0, Stop.NONE, np.zeros(self.about.readings, np.int32), none)
        """The latest."""
        self._moved = time.monotonic()
        """When its tick was new."""

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Hang up; the server holds the robot's posture from now on."""
        with contextlib.suppress(ConnectionEndedError):
            self._channel.send(Kind.BYE, timeout=0.1)
        self._channel.hang_up()

    def check(self, robot: str, place: str) -> None:
        """Make sure that the plant is that robot at that place.

        Raises:
            LinkError: If it is another.
        """
        for word, served, wanted in (("robot", self.about.robot, robot), ("place", self.about.place, place)):
            if served != cut(wanted, 32).decode():
                raise LinkError(str(self._address), f"its {word} is '{served}'", f"must be '{wanted}'")

    def reset(self, start: Floats) -> None:
        """See `Hardware`.

        Raises:
            LinkError: If the server does not take it.
        """
        try:
            number = self._send(Kind.START, start)
            self.sample = self._sample(ANSWER)
            while self.sample.answers != number:  # of a plant that keeps its own time, samples may be on the way
                self.sample = self._sample(ANSWER)
            self._moved = time.monotonic()
        except PlantStoppedError as stop:
            raise self._no_link(str(stop)) from None

    def sense(self) -> Reading:
        """See `Hardware`: the latest sample that has come."""
        if self.about.real_time:
            self._catch_up()
        return Reading(self.sample.counts, self.sample.tick)

    def actuate(self, commands: Floats) -> None:
        """See `Hardware`; sent with the next step."""
        self._commands = commands

    def pause(self) -> None:
        """See `Hardware`: the server's guard holds until the next step."""
        self._send(Kind.PAUSE)

    def step(self) -> None:
        """See `Hardware`. Of a plant that keeps its own time: until its next sample, or the latest of those that have come meanwhile.

        Raises:
            PlantStoppedError: If the server is gone, refuses, or has made a safe stop.
        """
        number = self._send(Kind.COMMAND, self._commands)
        sample = self._sample(self._longest_still or ANSWER)
        if (
            not self.about.real_time and sample.answers != number and not sample.stop
        ):  # a stop may come before the answer
            raise PlantStoppedError("the plant's server answers another command")
        self._take(sample)
        if self.about.real_time:
            self._catch_up()

    def _catch_up(self) -> None:
        for message in self._read():
            self._take(self._unpack(message))

    def _take(self, sample: Sample) -> None:
        now = time.monotonic()
        if sample.tick > self.sample.tick:
            self._moved = now
        elif not sample.stop and now - self._moved >= self._longest_still:
            raise PlantStoppedError(f"the plant's server is lost: its tick stands still at {sample.tick}")
        self.sample = sample
        if sample.stop:
            raise PlantStoppedError(f"the plant has made a safe stop: {STOPS[sample.stop]}")

    @property
    def _longest_still(self) -> float:
        """For which a tick may stay the same [s]: none at all where every command is one."""
        return STILL_TICKS * self.period / self.about.pace if self.about.real_time else 0.0

    def truth(self) -> Floats:
        """See `Hardware`: that of the latest sample, also once the plant has stopped."""
        return self.sample.truth

    def _sample(self, patience: float) -> Sample:
        try:
            return self._unpack(self._channel.wait(patience))
        except (ConnectionEndedError, MessageError) as error:
            raise PlantStoppedError(f"the plant's server is lost: {error}") from None

    def _unpack(self, message: Message) -> Sample:
        try:
            return unpack_sample(self._checked(message, Kind.SAMPLE).payload, self.about)
        except MessageError as error:
            raise PlantStoppedError(f"the plant's server is lost: {error}") from None

    def _read(self) -> list[Message]:
        try:
            return self._channel.read()
        except (ConnectionEndedError, MessageError) as error:
            raise PlantStoppedError(f"the plant's server is lost: {error}") from None

    def _send(self, kind: Kind, numbers: Floats | None = None) -> int:
        try:
            self._channel.send(kind, b"" if numbers is None else pack_numbers(np.asarray(numbers, np.float64)))
        except ConnectionEndedError as end:
            # a server that refuses hangs up after it has said why
            with contextlib.suppress(ConnectionEndedError, MessageError):
                while True:
                    self._expect(Kind.SAMPLE)
            raise PlantStoppedError(f"the plant's server is lost: {end}") from None
        return self._channel.sent

    def _expect(self, kind: Kind) -> Message:
        return self._checked(self._channel.wait(ANSWER), kind)

    def _checked(self, message: Message, kind: Kind) -> Message:
        if message.kind is Kind.REFUSAL:
            raise PlantStoppedError(f"the plant's server refuses: {unpack_refusal(message.payload)}")
        if message.kind is not kind:
            raise MessageError("a server's message", f"a {message.kind.name}", f"must be a {kind.name}")
        return message

    def _no_link(self, problem: str) -> LinkError:
        return LinkError(str(self._address), problem, "see docs/hardware.md")


def stop_plant(address: Address, *, release: bool = False) -> str:
    """Stop a plant safely, whoever drives it, or give it back after such a stop; what its server says of it.

    Raises:
        LinkError: If nobody serves a plant there, or the server refuses.
    """
    token, channel = read_token(address), connect(address, ANSWER)
    try:
        channel.send(Kind.STOP, pack_stop(token, release=release))
        answer = channel.wait(ANSWER)
        said = unpack_refusal(answer.payload)
    except (ConnectionEndedError, MessageError) as error:
        raise LinkError(str(address), f"no plant's server answers there: {error}", "see docs/hardware.md") from None
    finally:
        channel.hang_up()
    if answer.kind is not Kind.DONE:
        raise LinkError(str(address), f"its server refuses: {said}", "see docs/hardware.md")
    return said
