"""Messages: they come back as they went, in any pieces; whatever else comes is refused by name, never by a stray exception."""

import struct
import zlib
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from clamber.execution.link.messages import (
    HEADER,
    MAGIC,
    MOST_JOINTS,
    VERSION,
    About,
    Inbox,
    Kind,
    Message,
    MessageError,
    Sample,
    Stop,
    frame,
    most_payload,
    pack_about,
    pack_numbers,
    pack_refusal,
    pack_sample,
    unpack_about,
    unpack_nothing,
    unpack_numbers,
    unpack_refusal,
    unpack_sample,
)

ABOUT = About("libra", "ladder", 6, 7, 9, 21, False, 0.005)
FLOATS = st.floats(allow_nan=False, allow_infinity=False)


def stream() -> bytes:
    """One message of each kind, as two sides might say them."""
    sample = Sample(7, 3, Stop.NONE, np.arange(7, dtype=np.int32), np.linspace(-1.0, 1.0, 21))
    payloads = {
        Kind.WELCOME: pack_about(ABOUT), Kind.START: pack_numbers(np.zeros(9)), Kind.COMMAND: pack_numbers(np.ones(6)),
        Kind.SAMPLE: pack_sample(sample), Kind.REFUSAL: pack_refusal("no"),
    }  # fmt: skip
    return b"".join(frame(kind, number, payloads.get(kind, b"")) for number, kind in enumerate(Kind, 1))


def use(message: Message) -> None:
    """All that either side does with a message."""
    for read in (
        lambda: unpack_nothing(message.kind, message.payload),
        lambda: unpack_about(message.payload),
        lambda: unpack_numbers(message.kind, message.payload, 9),
        lambda: unpack_numbers(message.kind, message.payload, 6),
        lambda: unpack_sample(message.payload, ABOUT),
        lambda: unpack_refusal(message.payload),
    ):
        try:
            read()
        except MessageError as error:
            assert str(error).startswith("message: ")


@given(st.lists(st.integers(0, len(stream())), max_size=20))
def test_messages_come_whole_out_of_any_pieces(cuts: list[int]) -> None:
    raw, inbox, found = stream(), Inbox(), []
    for a, b in pairwise(sorted({0, len(raw), *cuts})):
        found += inbox.feed(raw[a:b])
    assert [message.kind for message in found] == list(Kind)
    assert [message.number for message in found] == list(range(1, len(Kind) + 1))
    assert not inbox.partial


@given(
    st.integers(0, 2**64 - 1), st.integers(0, 2**32 - 1), st.sampled_from(Stop),
    st.lists(st.integers(-(2**31), 2**31 - 1), min_size=7, max_size=7), st.lists(FLOATS, min_size=21, max_size=21),
)  # fmt: skip
def test_a_sample_comes_back_as_it_went(
    tick: int, answers: int, stop: Stop, counts: list[int], truth: list[float]
) -> None:
    sent = Sample(tick, answers, stop, np.array(counts, np.int32), np.array(truth))
    got = unpack_sample(pack_sample(sent), ABOUT)
    assert (got.tick, got.answers, got.stop) == (tick, answers, stop)
    assert np.array_equal(got.counts, sent.counts)
    assert got.truth.tobytes() == sent.truth.tobytes(), "to the last bit"


@given(st.lists(FLOATS, min_size=1, max_size=MOST_JOINTS))
def test_commands_come_back_to_the_last_bit(volts: list[float]) -> None:
    sent = np.array(volts)
    assert unpack_numbers(Kind.COMMAND, pack_numbers(sent), len(volts)).tobytes() == sent.tobytes()


@pytest.mark.slow
@given(st.text(max_size=60), st.booleans(), st.floats(1e-6, 1e6))
def test_a_welcome_comes_back_with_its_names_cut(name: str, real_time: bool, period: float) -> None:
    about = replace(ABOUT, robot=name, real_time=real_time, period=period)
    try:
        got = unpack_about(pack_about(about))
    except MessageError:
        assert not name.isprintable() or not name.isascii()
        return
    assert replace(got, robot="") == replace(about, robot="")
    assert name.startswith(got.robot)


def test_the_layout_is_that_of_the_page() -> None:
    raw = frame(Kind.COMMAND, 5, pack_numbers(np.array((1.5, -2.0))))
    assert raw[:4] == b"CLMB"
    assert struct.unpack("<HHII", raw[4:16]) == (1, 4, 5, 16)
    assert struct.unpack("<I", raw[16:20])[0] == zlib.crc32(raw[:16] + raw[20:])
    assert struct.unpack("<dd", raw[20:]) == (1.5, -2.0)
    sample = pack_sample(Sample(9, 5, Stop.SILENT, np.array((-3,), np.int32), np.array((0.25,))))
    assert struct.unpack("<QIHHid", sample) == (9, 5, 1, 0, -3, 0.25)
    welcome = pack_about(ABOUT)
    assert struct.unpack("<HHHHHHdd32s32s", welcome)[:8] == (6, 7, 9, 21, 0, 0, 0.005, 1.0)


def header(**changes: object) -> bytes:
    parts = {"magic": MAGIC, "version": VERSION, "kind": int(Kind.BYE), "number": 1, "size": 0} | changes
    head = struct.pack("<4sHHII", *parts.values())
    return head + struct.pack("<I", zlib.crc32(head))


@pytest.mark.parametrize(
    ("raw", "said"),
    [
        (header(magic=b"HTTP"), "first word is b'HTTP'; must be b'CLMB'"),
        (b"GET / HTTP/1.1\r\n", "first word is b'GET '"),
        (b"G", "first word"),
        (header(version=2), "the version is 2; must be 1"),
        (header(kind=0), "the kind is 0; must be 1 to 10"),
        (header(kind=99), "the kind is 99"),
        (header(size=1), "the length of a BYE is 1; must be 0 bytes or less"),
        (header(kind=4, size=2**32 - 1), "the length of a COMMAND is 4294967295; must be 512 bytes or less"),
        (header(number=2), "the number is 2; must be 1: one more than the last"),
        (header()[:-1] + b"\x00", "the check sum"),
        (header() + header(), "the number is 1; must be 2"),
    ],
)
def test_what_is_no_message_is_refused_by_name(raw: bytes, said: str) -> None:
    with pytest.raises(MessageError) as refused:
        Inbox().feed(raw)
    assert said in str(refused.value)


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_volts_that_are_no_numbers_are_refused(value: float) -> None:
    with pytest.raises(MessageError, match=r"number 2 of a COMMAND is .*; must be finite"):
        unpack_numbers(Kind.COMMAND, pack_numbers(np.array((0.0, value))), 2)


def test_a_start_outside_any_wall_is_refused() -> None:
    with pytest.raises(MessageError, match="a number of a START is 1e\\+30; must be at most 1000"):
        unpack_numbers(Kind.START, pack_numbers(np.array((0.0, -1e30))), 2)


@settings(max_examples=500)
@given(st.lists(st.binary(max_size=80), max_size=8))
def test_junk_is_refused_or_waited_for(pieces: list[bytes]) -> None:
    inbox = Inbox()
    try:
        for piece in pieces:
            for message in inbox.feed(piece):
                use(message)
    except MessageError as error:
        assert error.problem and error.allowed


@pytest.mark.slow
@settings(max_examples=1000)
@given(st.lists(st.tuples(st.integers(0, len(stream()) - 1), st.integers(1, 255)), min_size=1, max_size=4))
def test_bits_that_turn_over_on_the_way_are_noticed(turned: list[tuple[int, int]]) -> None:
    raw = bytearray(stream())
    for at, bits in turned:
        raw[at] ^= bits
    inbox = Inbox()
    try:
        inbox.feed(bytes(raw))
    except MessageError:
        return
    # a length that grew waits for the rest; changes of the same byte may undo each other
    assert inbox.partial or bytes(raw) == stream()


@settings(max_examples=1000)
@given(st.sampled_from(Kind), st.binary(max_size=400))
def test_any_payload_in_a_sound_frame_is_read_or_refused(kind: Kind, payload: bytes) -> None:
    try:
        (message,) = Inbox().feed(frame(kind, 1, payload))
    except MessageError:
        assert len(payload) > most_payload(kind)
        return
    use(message)


@settings(max_examples=500)
@given(st.data())
def test_any_payload_of_the_right_size_is_read_or_refused(data: st.DataObject) -> None:
    kind = data.draw(st.sampled_from((Kind.WELCOME, Kind.START, Kind.COMMAND, Kind.SAMPLE, Kind.REFUSAL)))
    size = {Kind.START: 72, Kind.COMMAND: 48, Kind.SAMPLE: 16 + 28 + 168}.get(kind, most_payload(kind))
    use(Message(kind, 1, data.draw(st.binary(min_size=size, max_size=size))))


def test_no_message_is_longer_than_a_reader_is_willing_to_keep() -> None:
    assert max(map(most_payload, Kind)) + HEADER < 10_000
