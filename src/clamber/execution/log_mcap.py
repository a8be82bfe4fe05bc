"""Logs as MCAP: JSON messages under a JSON schema, one a sample, as Foxglove and PlotJuggler open them."""

import io
import json
import struct
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Final

import numpy as np

from ..types import Floats
from .log import Log, LogError, build_log
from .log_scene import FOXGLOVE, LoggedScene, SceneWriter

TOPIC: Final = "limb"
"""Channel of a log that Clamber writes."""
SCHEMA: Final = "clamber.Log"
TIME: Final = "time"
"""Column that gives the messages their time [s]; a file without it gets the messages' own time."""

NOTES: Final = "clamber"
"""Metadata record with the notes that are known only at the end of a log."""
LATEST: Final = 2**64 - 1
"""Largest time that a message can have [ns]."""
MOST_INFLATED: Final = 512 * 1024 * 1024
"""What the chunks of a file may hold in all [bytes]: numbers as JSON shrink to a quarter, so that a log of the largest size that is read
still passes; a file of some kB may well hold a thousand times its size, and all of it is in memory at once."""
MAGIC: Final = bytes((137, 77, 67, 65, 80, 48, 13, 10))
"""First and last bytes of a whole file."""
_HEAD: Final = struct.Struct("<BQ")


def mcap_bytes(log: Log, topic: str = TOPIC, scene: LoggedScene | None = None) -> bytes:
    """The bytes of an MCAP file of a log: one channel, whose messages hold one number a column under its title.

    Args:
        log: The samples.
        topic: Name of the channel.
        scene: The same in three dimensions, on channels of its own; None: there is none.
    """
    return mcap_of({topic: log}, scene)


def mcap_of(logs: Mapping[str, Log], scene: LoggedScene | None = None) -> bytes:
    """The bytes of an MCAP file of several logs, each on the channel that it is named by; notes are the channel's metadata."""
    from mcap.writer import Writer

    out = io.BytesIO()
    writer = Writer(out)
    writer.start(profile="", library="clamber")
    told = None if scene is None else SceneWriter(writer, scene)
    for topic, log in logs.items():
        titles = log.titles()
        channel = open_channel(writer, topic, titles, log.notes)
        times = log.columns[TIME] if TIME in log.columns else np.arange(log.rows, dtype=np.float64)
        for k, row in enumerate(np.column_stack([np.asarray(v) for v in log.columns.values()])):
            stamp = stamp_of(float(times[k]))
            data = json.dumps(dict(zip(titles, row.tolist(), strict=True))).encode()
            writer.add_message(channel, stamp, data, stamp, k)
            if told is not None:
                told.add(row, stamp)
    writer.finish()  # type: ignore[no-untyped-call]
    return out.getvalue()


def open_channel(writer: Any, topic: str, titles: Iterable[str], notes: Mapping[str, str]) -> int:
    """Register a channel whose messages hold one number under each title; its number."""
    properties = {title: {"type": "number"} for title in titles}
    schema = {"title": SCHEMA, "type": "object", "properties": properties}
    number = writer.register_schema(SCHEMA, "jsonschema", json.dumps(schema).encode())
    channel: int = writer.register_channel(topic, "json", number, dict(notes))
    return channel


def stamp_of(time: float) -> int:
    """A message's time [ns] for a time [s]."""
    return min(max(0, round(time * 1e9)), LATEST)


def parse_mcap(content: bytes, label: str, topic: str | None = None) -> Log:
    """The log of an MCAP file's bytes: the numbers of one channel's JSON messages, nested ones by dotted names.

    A file that ends in the middle, as a killed process leaves it, is read as far as its records are whole; the log says that it is cut.

    Args:
        content: The file.
        label: What errors call it.
        topic: Channel to read; None: the only one, or the one called `TOPIC`.

    Raises:
        LogError: If it is no MCAP file, holds more than `MOST_INFLATED`, has no such channel, or its messages are not JSON with the same
            numbers each.
    """
    cut = not content.endswith(MAGIC)
    try:
        channels = _read(content, label, cut=cut)
    except LogError:
        raise
    except Exception as error:  # the reader raises whatever a broken record makes of its struct, codec or index
        what = f"is not a readable MCAP file ({type(error).__name__}: {error})"
        raise LogError(label, None, None, None, what[:300]) from None
    name = _choose(channels, topic, label)
    chosen = channels[name]
    rows: list[Floats] = []
    first: dict[str, float] = {}
    for k, (_, data) in enumerate(chosen.messages, start=1):
        flat: dict[str, float] = {}
        try:
            _flatten(json.loads(data), "", flat)
        except (ValueError, RecursionError, OverflowError) as error:
            raise LogError(label, name, k, None, f"is not valid JSON: {str(error)[:200]}") from None
        first = first or flat
        if not first:
            raise LogError(label, name, k, None, "must be an object that holds numbers")
        if flat.keys() != first.keys():
            odd = sorted(flat.keys() ^ first.keys())[0]
            how = "there" if odd in flat else "missing"
            raise LogError(label, odd, k, how, "every message must hold the same numbers")
        rows.append(np.array([flat[title] for title in first]))
    titles, columns = list(first), list(np.stack(rows, axis=1))
    if not any(title.split("[")[0].strip().lower() in ("time", "timestamp", "t") for title in titles):
        titles.insert(0, "time [s]")
        stamps = np.array([stamp - chosen.messages[0][0] for stamp, _ in chosen.messages], dtype=np.float64)
        columns.insert(0, stamps * 1e-9)
    return replace(build_log(titles, columns, chosen.notes, label), cut=cut)


@dataclass(slots=True)
class _Channel:
    """What a file holds of one topic."""

    encoding: str
    notes: dict[str, str]
    messages: list[tuple[int, bytes]] = field(default_factory=list)
    """Times [ns] and data."""


def _read(content: bytes, label: str, *, cut: bool) -> dict[str, _Channel]:
    """The channels of a file by topic, their messages by time; of one that ends in the middle, those up to its last whole record."""
    from mcap.exceptions import EndOfFile
    from mcap.records import Channel, Chunk, Message, Metadata, Schema
    from mcap.stream_reader import StreamReader, breakup_chunk

    channels: dict[str, _Channel] = {}
    schemas: dict[int, Any] = {}
    known: dict[int, Any] = {}
    notes: dict[str, str] = {}
    whole = content[: _whole_records(content)] if cut else content
    left = MOST_INFLATED
    try:
        for outer in StreamReader(io.BytesIO(whole), emit_chunks=True, validate_crcs=True).records:
            records = [outer]
            if isinstance(outer, Chunk):
                left -= outer.uncompressed_size
                if left < 0:
                    held = f"chunks of {MOST_INFLATED - left} bytes"
                    raise LogError(label, None, None, held, f"at most {MOST_INFLATED} are read, uncompressed")
                records = breakup_chunk(_inflated(outer), validate_crc=True)
            for record in records:
                if isinstance(record, Schema):
                    schemas[record.id] = record
                elif isinstance(record, Channel):
                    known[record.id] = record
                elif isinstance(record, Message):
                    channel = known[record.channel_id]
                    _keep(channels, schemas.get(channel.schema_id), channel, record)
                elif isinstance(record, Metadata) and record.name == NOTES:
                    notes |= record.metadata
    except EndOfFile:
        if not cut:
            raise
    for found in channels.values():
        found.messages.sort(key=lambda message: message[0])
        found.notes |= notes
    return channels


def _inflated(chunk: Any) -> Any:
    """A chunk without compression, whose bytes are as many as it says; what it truly holds may be far more, and is not taken in.

    Raises:
        ValueError: If it holds more or less.
    """
    import lz4.frame  # both come with mcap
    import zstandard

    size = chunk.uncompressed_size
    if chunk.compression == "zstd":
        data = zstandard.ZstdDecompressor().stream_reader(chunk.data).read(size + 1)
    elif chunk.compression == "lz4":
        data = lz4.frame.LZ4FrameDecompressor().decompress(chunk.data, max_length=size + 1)
    elif chunk.compression == "":
        data = chunk.data
    else:
        raise ValueError(f"a chunk is compressed by '{chunk.compression[:40]}'")
    if len(data) != size:
        raise ValueError(
            f"a chunk that says that it holds {size} bytes holds {'more' if len(data) > size else len(data)}"
        )
    return replace(chunk, compression="", data=data)


def _whole_records(content: bytes) -> int:
    """Where the last whole record ends: each is an opcode, its length, and that many bytes."""
    end = len(MAGIC)
    while (start := end + _HEAD.size) <= len(content):
        _, length = _HEAD.unpack_from(content, end)
        if start + length > len(content):
            break
        end = start + length
    return end


def _keep(channels: dict[str, _Channel], schema: Any, channel: Any, message: Any) -> None:
    if schema is not None and schema.name.startswith(FOXGLOVE):  # frames and shapes, no table of numbers
        return
    ours = schema is not None and schema.name == SCHEMA  # the metadata of others are no notes of a limb
    found = channels.setdefault(
        channel.topic, _Channel(channel.message_encoding, dict(channel.metadata) if ours else {})
    )
    found.messages.append((message.log_time, message.data))


def _choose(channels: dict[str, _Channel], topic: str | None, label: str) -> str:
    if not channels:
        raise LogError(label, None, None, None, "holds no messages")
    if topic is None:
        topic = next(iter(channels)) if len(channels) == 1 else TOPIC
    if topic not in channels:
        raise LogError(
            label, None, None, f"channel '{topic}'", f"no such channel; name one: {', '.join(channels)[:400]}"
        )
    encoding = channels[topic].encoding
    if encoding != "json":
        raise LogError(label, None, None, f"channel '{topic}' is encoded as '{encoding}'", "must be 'json'")
    return topic


def _flatten(value: Any, name: str, out: dict[str, float]) -> None:
    """Collect the numbers of a message under dotted names; texts and truth values are left out."""
    if isinstance(value, dict):
        for key, inner in value.items():
            _flatten(inner, f"{name}.{key}" if name else key, out)
    elif isinstance(value, list):
        for k, inner in enumerate(value):
            _flatten(inner, f"{name}.{k}" if name else str(k), out)
    elif isinstance(value, int | float) and not isinstance(value, bool):
        out[name] = float(value)
