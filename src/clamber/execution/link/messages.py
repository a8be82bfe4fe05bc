"""Messages between a plant's server and its client: fixed layouts, little-endian, everything checked before it is used."""

import struct
import zlib
from dataclasses import dataclass
from enum import IntEnum
from typing import Final

import numpy as np

from ...errors import StatedError
from ...types import Floats, Ints

MAGIC: Final = b"CLMB"
VERSION: Final = 1
MOST_JOINTS: Final = 64
"""Most commands, readings and numbers of a start that a plant may tell of."""
MOST_TRUTHS: Final = 1024
FARTHEST: Final = 1000.0
"""No number of a start is larger, either way [m], [rad]."""
_HEAD: Final = struct.Struct("<4sHHII")
_SUM: Final = struct.Struct("<I")
HEADER: Final = _HEAD.size + _SUM.size
"""Bytes before the payload."""
_WELCOME: Final = struct.Struct("<HHHHHHdd32s32s")
_SAMPLE: Final = struct.Struct("<QIHH")
_REFUSAL: Final = struct.Struct("<200s")
_STOP: Final = struct.Struct("<HH32s")
TOKEN: Final = 32
"""Bytes of an operator's token."""


class Kind(IntEnum):
    """What a message is."""

    HELLO = 1
    WELCOME = 2
    START = 3
    COMMAND = 4
    SAMPLE = 5
    BYE = 6
    REFUSAL = 7
    PAUSE = 8
    STOP = 9
    DONE = 10


class Stop(IntEnum):
    """Why a server no longer takes commands."""

    NONE = 0
    SILENT = 1
    LOST = 2
    GARBLED = 3
    ENDED = 4
    OPERATOR = 5
    OVERRUN = 6
    ENVELOPE = 7


STOPS: Final = {
    Stop.NONE: "it is driven",
    Stop.SILENT: "no command came for two ticks",
    Stop.LOST: "its client is gone",
    Stop.GARBLED: "its client sent what is no message",
    Stop.ENDED: "its server ends",
    Stop.OPERATOR: "an operator has stopped it",
    Stop.OVERRUN: "its server does not keep up with the clock",
    Stop.ENVELOPE: "the robot is beyond its limits",
}
"""In words."""


class MessageError(StatedError):
    """Bytes are no message that may stand where they stand."""

    says = "message: {problem} is {value}; {allowed}"
    problem: str
    value: object
    allowed: str


@dataclass(frozen=True, slots=True)
class About:
    """What a server tells of its plant before anything moves."""

    robot: str
    """Its name, cut to 32 bytes of UTF-8."""
    place: str
    """Name of its task or board, likewise."""
    commands: int
    """Numbers of a command: volts of joints, then switches of grippers."""
    readings: int
    """Whole numbers of a sample: counts of encoders, then switches of grippers."""
    starts: int
    """Numbers of a start."""
    truths: int
    """Numbers of the truth in a sample; 0: nobody knows it."""
    real_time: bool
    """Whether the plant keeps its own time; else it waits for each command."""
    period: float
    """Of the control [s]."""
    pace: float = 1.0
    """Seconds of the plant for each second of the clock, where it keeps its own time."""


@dataclass(frozen=True, slots=True, eq=False)
class Sample:
    """What a server tells of a tick."""

    tick: int
    """Since the start."""
    answers: int
    """Number of the client's last message that it knows of."""
    stop: Stop
    counts: Ints
    """Of the encoders, then the switches of the grippers, shape (readings,)."""
    truth: Floats
    """For logs, shape (truths,)."""


@dataclass(frozen=True, slots=True)
class Message:
    """A message whose frame is whole; its payload is still bytes."""

    kind: Kind
    number: int
    """From 1, one more with each message of a side."""
    payload: bytes


def frame(kind: Kind, number: int, payload: bytes = b"") -> bytes:
    """A message as bytes."""
    head = _HEAD.pack(MAGIC, VERSION, kind, number & 0xFFFFFFFF, len(payload))
    return head + _SUM.pack(zlib.crc32(payload, zlib.crc32(head))) + payload


def most_payload(kind: Kind) -> int:
    """Largest payload of a kind, whatever the plant [bytes]."""
    return {
        Kind.WELCOME: _WELCOME.size,
        Kind.START: 8 * MOST_JOINTS,
        Kind.COMMAND: 8 * MOST_JOINTS,
        Kind.SAMPLE: _SAMPLE.size + 4 * MOST_JOINTS + 8 * MOST_TRUTHS,
        Kind.REFUSAL: _REFUSAL.size,
        Kind.STOP: _STOP.size,
        Kind.DONE: _REFUSAL.size,
    }.get(kind, 0)


class Inbox:
    """Messages out of a stream of bytes that come in any pieces."""

    def __init__(self) -> None:
        self._bytes = bytearray()
        self._number = 0

    @property
    def partial(self) -> bool:
        """Whether a message has begun and not ended."""
        return bool(self._bytes)

    def feed(self, piece: bytes) -> list[Message]:
        """The messages that are whole now.

        Raises:
            MessageError: If the stream goes on with what is no message; it cannot be read on after that.
        """
        self._bytes += piece
        found = []
        while len(self._bytes) >= HEADER:
            kind, number, size, summed = self._head()
            if len(self._bytes) < HEADER + size:
                break
            payload = bytes(self._bytes[HEADER : HEADER + size])
            if zlib.crc32(payload, zlib.crc32(self._bytes[: _HEAD.size])) != summed:
                raise MessageError("the check sum", f"{summed:#010x}", "must be the CRC-32 of header and payload")
            expected = (self._number + 1) & 0xFFFFFFFF
            if number != expected:
                raise MessageError("the number", number, f"must be {expected}: one more than the last")
            del self._bytes[: HEADER + size]
            self._number = number
            found.append(Message(kind, number, payload))
        if self._bytes and not MAGIC.startswith(self._bytes[: len(MAGIC)]):
            raise _foreign(self._bytes)
        return found

    def _head(self) -> tuple[Kind, int, int, int]:
        magic, version, kind, number, size = _HEAD.unpack_from(self._bytes)
        (summed,) = _SUM.unpack_from(self._bytes, _HEAD.size)
        if magic != MAGIC:
            raise _foreign(self._bytes)
        if version != VERSION:
            raise MessageError("the version", version, f"must be {VERSION}")
        try:
            known = Kind(kind)
        except ValueError:
            raise MessageError("the kind", kind, f"must be 1 to {max(Kind)}") from None
        if size > most_payload(known):
            raise MessageError(f"the length of a {known.name}", size, f"must be {most_payload(known)} bytes or less")
        return known, number, size, summed


def _foreign(start: bytearray) -> MessageError:
    return MessageError("the first word", bytes(start[:4]), f"must be {MAGIC!r}: this is no plant's server or client")


def pack_about(about: About) -> bytes:
    """Payload of a WELCOME."""
    return _WELCOME.pack(
        about.commands,
        about.readings,
        about.starts,
        about.truths,
        about.real_time,
        0,
        about.period,
        about.pace,
        cut(about.robot, 32),
        cut(about.place, 32),
    )


def unpack_about(payload: bytes) -> About:
    """What a WELCOME says.

    Raises:
        MessageError: If it says what cannot be.
    """
    _check_size(Kind.WELCOME, payload, _WELCOME.size)
    commands, readings, starts, truths, mode, spare, period, pace, robot, place = _WELCOME.unpack(payload)
    for word, value, low, high in (
        ("commands", commands, 1, MOST_JOINTS), ("readings", readings, commands, MOST_JOINTS), ("starts", starts, 1, MOST_JOINTS),
        ("truths", truths, 0, MOST_TRUTHS), ("mode", mode, 0, 1), ("spare", spare, 0, 0),
    ):  # fmt: skip
        if not low <= value <= high:
            raise MessageError(f"'{word}' of a WELCOME", value, f"must be {low} to {high}")
    for word, seconds in (("period", period), ("pace", pace)):
        if not 1e-6 <= seconds <= 1e6:
            raise MessageError(f"'{word}' of a WELCOME", seconds, "must be 1e-6 to 1e6")
    return About(
        _text(robot, "robot"), _text(place, "place"), commands, readings, starts, truths, bool(mode), period, pace
    )


def pack_sample(sample: Sample) -> bytes:
    """Payload of a SAMPLE."""
    head = _SAMPLE.pack(sample.tick, sample.answers & 0xFFFFFFFF, sample.stop, 0)
    return head + sample.counts.astype("<i4").tobytes() + sample.truth.astype("<f8").tobytes()


def unpack_sample(payload: bytes, about: About) -> Sample:
    """What a SAMPLE says.

    Raises:
        MessageError: If it is none of such a plant, or says what cannot be.
    """
    _check_size(Kind.SAMPLE, payload, _SAMPLE.size + 4 * about.readings + 8 * about.truths)
    tick, answers, code, spare = _SAMPLE.unpack_from(payload)
    try:
        stop = Stop(code)
    except ValueError:
        raise MessageError("'stop' of a SAMPLE", code, f"must be 0 to {max(Stop)}") from None
    if spare:
        raise MessageError("'spare' of a SAMPLE", spare, "must be 0")
    counts = np.frombuffer(payload, "<i4", about.readings, _SAMPLE.size).astype(np.int32)
    truth = np.frombuffer(payload, "<f8", about.truths, _SAMPLE.size + 4 * about.readings).astype(np.float64)
    if not np.isfinite(truth).all():
        raise MessageError("the truth of a SAMPLE", truth[~np.isfinite(truth)][0], "must be finite numbers")
    return Sample(tick, answers, stop, counts, truth)


def pack_numbers(numbers: Floats) -> bytes:
    """Payload of a START [m], [rad] or a COMMAND [V]."""
    return numbers.astype("<f8").tobytes()


def unpack_numbers(kind: Kind, payload: bytes, count: int) -> Floats:
    """What a START or a COMMAND says, shape (count,).

    Raises:
        MessageError: If they are not so many, or one is not finite, or no place that a robot could start from.
    """
    _check_size(kind, payload, 8 * count)
    numbers = np.frombuffer(payload, "<f8").astype(np.float64)
    if not np.isfinite(numbers).all():
        at = int(np.argmin(np.isfinite(numbers)))
        raise MessageError(f"number {at + 1} of a {kind.name}", numbers[at], "must be finite")
    if kind is Kind.START and np.abs(numbers).max() > FARTHEST:
        raise MessageError("a number of a START", np.abs(numbers).max(), f"must be at most {FARTHEST:g}")
    return numbers


def pack_refusal(why: str) -> bytes:
    """Payload of a REFUSAL."""
    return _REFUSAL.pack(cut(why, _REFUSAL.size))


def unpack_refusal(payload: bytes) -> str:
    """Why a server refuses, or, of a DONE, what it has done.

    Raises:
        MessageError: If it cannot be read.
    """
    _check_size(Kind.REFUSAL, payload, _REFUSAL.size)
    return _text(payload, "reason")


def pack_stop(token: bytes, *, release: bool = False) -> bytes:
    """Payload of a STOP: an operator's token, and whether the plant is to be given back after one before."""
    return _STOP.pack(release, 0, token)


def unpack_stop(payload: bytes) -> tuple[bytes, bool]:
    """Token of a STOP, and whether it gives the plant back.

    Raises:
        MessageError: If it says what cannot be.
    """
    _check_size(Kind.STOP, payload, _STOP.size)
    release, spare, token = _STOP.unpack(payload)
    for word, value, high in (("release", release, 1), ("spare", spare, 0)):
        if not 0 <= value <= high:
            raise MessageError(f"'{word}' of a STOP", value, f"must be 0 to {high}")
    return token, bool(release)


def unpack_nothing(kind: Kind, payload: bytes) -> None:
    """A HELLO, PAUSE or BYE says nothing.

    Raises:
        MessageError: If it does.
    """
    _check_size(kind, payload, 0)


def cut(text: str, size: int) -> bytes:
    """UTF-8 of at most `size` bytes, cut between characters."""
    return text.encode("utf-8", "replace")[:size].decode("utf-8", "ignore").encode()


def _check_size(kind: Kind, payload: bytes, size: int) -> None:
    if len(payload) != size:
        raise MessageError(f"the length of a {kind.name}", len(payload), f"must be {size} bytes here")


def _text(raw: bytes, word: str) -> str:
    """Printable UTF-8 up to the first zero byte, then zeros."""
    said, _, rest = raw.partition(b"\0")
    try:
        text = said.decode("utf-8")
    except UnicodeDecodeError:
        raise MessageError(f"'{word}'", said[:16], "must be UTF-8") from None
    if rest.strip(b"\0") or not text.isprintable():
        raise MessageError(f"'{word}'", raw[:16], "must be printable, with zeros behind it")
    return text
