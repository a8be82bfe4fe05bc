import io
import json
import string
import tracemalloc
from pathlib import Path

import lz4.frame
import numpy as np
import pytest
import zstandard
from hypothesis import given, settings
from hypothesis import strategies as st
from mcap.data_stream import RecordBuilder
from mcap.reader import make_reader
from mcap.records import Chunk, Footer, Header
from mcap.writer import CompressionType, Writer

from clamber.errors import ClamberError, FileError
from clamber.execution.log import Log, LogError
from clamber.execution.log_files import csv_text, parse_csv, read_log, write_log
from clamber.execution.log_mcap import MAGIC, MOST_INFLATED, mcap_bytes, parse_mcap
from clamber.execution.log_roles import read_mapping, role_of, samples_of
from clamber.units import DEGREE

NAMES = st.text(string.ascii_letters + " _.-", min_size=1, max_size=12).map(str.strip).filter(bool)
NUMBERS = st.floats(-1e12, 1e12)


@st.composite
def logs(draw: st.DrawFn) -> Log:
    names = draw(st.lists(NAMES, min_size=1, max_size=4, unique=True))
    rows = draw(st.integers(1, 6))
    columns = {name: np.array(draw(st.lists(NUMBERS, min_size=rows, max_size=rows))) for name in names}
    if "time" not in columns:
        columns["time"] = np.arange(float(rows))
    units = {name: draw(st.sampled_from(("rad", "N m", "deg/s"))) for name in names if draw(st.booleans())}
    return Log(columns, units, {"robot": "libra"}, "log")


def assert_equal(a: Log, b: Log) -> None:
    assert list(a.columns) == list(b.columns)
    assert dict(a.units) == dict(b.units)
    assert dict(a.notes) == dict(b.notes)
    for name in a.columns:
        np.testing.assert_array_equal(a.columns[name], b.columns[name])


def ramp(rows: int = 30) -> Log:
    time = np.arange(rows) * 0.005
    return Log({"time": time, "elbow angle": 30.0 * time}, {"time": "s", "elbow angle": "deg"})


@given(logs())
@settings(max_examples=60)
def test_a_log_comes_back_from_csv_and_mcap_to_the_last_bit(log: Log) -> None:
    assert_equal(parse_csv(csv_text(log), "log"), log)
    assert_equal(parse_mcap(mcap_bytes(log), "log"), log)


def test_an_mcap_log_is_json_under_a_json_schema_with_times_that_foxglove_reads() -> None:
    reader = make_reader(io.BytesIO(mcap_bytes(ramp())), validate_crcs=True)
    found = list(reader.iter_messages())
    schema, channel, message = found[7]
    assert schema is not None
    assert (schema.encoding, channel.message_encoding, channel.topic) == ("jsonschema", "json", "limb")
    assert json.loads(schema.data)["properties"]["elbow angle [deg]"] == {"type": "number"}
    assert json.loads(message.data) == {"time [s]": 7 * 0.005, "elbow angle [deg]": 30.0 * 7 * 0.005}
    assert message.log_time == 35_000_000
    assert [m.log_time for _, _, m in found] == sorted(m.log_time for _, _, m in found)


def test_a_foreign_mcap_file_is_read_by_dotted_names_and_its_messages_times() -> None:
    out = io.BytesIO()
    writer = Writer(out)
    writer.start()
    schema = writer.register_schema("State", "jsonschema", b"{}")
    wanted, other = (writer.register_channel(topic, "json", schema) for topic in ("/joints", "/tf"))
    for k in range(25):
        data = {"header": {"frame": "base"}, "position": [0.1 * k, -0.1 * k], "ok": True}
        writer.add_message(wanted, 10**18 + k * 5_000_000, json.dumps(data).encode(), 0)
        writer.add_message(other, 10**18 + k * 5_000_000, b"{}", 0)
    writer.finish()
    with pytest.raises(LogError, match=r"no such channel; name one: /joints, /tf"):
        parse_mcap(out.getvalue(), "foreign")
    log = parse_mcap(out.getvalue(), "foreign", "/joints")
    assert list(log.columns) == ["time", "position.0", "position.1"]
    samples = samples_of(log).joints
    assert [joint.name for joint in samples] == ["0", "1"]
    np.testing.assert_allclose(samples[1].time, 0.005 * np.arange(25), atol=1e-12)


@pytest.mark.parametrize("compression", ["zstd", "lz4", ""])
def test_a_log_comes_back_however_its_chunks_are_compressed_in_the_order_of_its_times(compression: str) -> None:
    out = io.BytesIO()
    kind = {"zstd": CompressionType.ZSTD, "lz4": CompressionType.LZ4, "": CompressionType.NONE}[compression]
    writer = Writer(out, chunk_size=500, compression=kind)
    writer.start()
    channel = writer.register_channel("limb", "json", writer.register_schema("State", "jsonschema", b"{}"))
    for k in (3, 1, 2, 0, *range(4, 60)):
        writer.add_message(channel, k, json.dumps({"time": k, "q1": 0.1 * k}).encode(), k)
    writer.finish()
    for content in (out.getvalue(), out.getvalue()[:-20]):
        assert parse_mcap(content, "log").column("time").tolist() == list(range(60))


def bomb(compression: str, says: int, holds: int) -> bytes:
    """A file of one chunk of blanks that says how much it holds, which may be a lie."""
    out = RecordBuilder()
    out.write(MAGIC)
    Header("", "").write(out)
    data = {"zstd": zstandard.compress, "lz4": lz4.frame.compress, "": bytes}[compression](bytes(holds))
    Chunk(compression, data, 0, 0, 0, says).write(out)
    Footer(0, 0, 0).write(out)
    out.write(MAGIC)
    return bytes(out.end())


@pytest.mark.parametrize("compression", ["zstd", "lz4"])
@pytest.mark.parametrize(
    ("says", "holds", "told"),
    [
        (2**35, 1000, f"chunks of {2**35} bytes: at most {MOST_INFLATED} are read"),
        (2**63, 2**25, f"chunks of {2**63} bytes: at most {MOST_INFLATED} are read"),
        (1000, 2**25, "says that it holds 1000 bytes holds more"),
        (1000, 999, "says that it holds 1000 bytes holds 999"),
    ],
)
@pytest.mark.parametrize("end", [None, -5])
def test_a_chunk_that_inflates_without_bounds_is_refused_by_name_and_not_taken_in(
    compression: str, says: int, holds: int, told: str, end: int | None
) -> None:
    content = bomb(compression, says, holds)[:end]
    assert len(content) < 2**20
    tracemalloc.start()
    try:
        with pytest.raises(LogError, match=f"^bomb.mcap.*{told}"):
            parse_mcap(content, "bomb.mcap")
        assert tracemalloc.get_traced_memory()[1] < 2**23
    finally:
        tracemalloc.stop()


def test_chunks_that_are_small_by_themselves_are_counted_together(monkeypatch: pytest.MonkeyPatch) -> None:
    content = mcap_bytes(ramp())
    monkeypatch.setattr("clamber.execution.log_mcap.MOST_INFLATED", 20_000)
    assert_equal(parse_mcap(content, "log"), ramp())
    long = mcap_bytes(ramp(3000))
    with pytest.raises(LogError, match=r"chunks of \d+ bytes: at most 20000 are read"):
        parse_mcap(long, "log")


def test_numbers_leave_in_si_units_and_a_missing_unit_is_told() -> None:
    time = np.arange(40.0)
    log = Log({"t": time, "q1": time, "tau1": time}, {"t": "ms", "q1": "deg"})
    found = samples_of(log)
    np.testing.assert_allclose(found.joints[0].time, time * 1e-3)
    np.testing.assert_allclose(found.joints[0].angle, time * DEGREE)
    assert found.notes == ("column 'tau1' states no unit: read as N m",)


@pytest.mark.parametrize(
    ("name", "role"),
    [
        ("time", ("", "time")),
        ("__time", ("", "time")),
        ("right shoulder angle", ("right shoulder", "angle")),
        ("right shoulder output angle", ("right shoulder", "output angle")),
        ("right shoulder torque", ("right shoulder", "torque")),
        ("right shoulder torque sensed", ("right shoulder", "torque sensed")),
        ("right shoulder torque commanded", None),
        ("q1", ("1", "angle")),
        ("tau_2", ("2", "torque")),
        ("/joint_states/elbow/position", ("joint states elbow", "angle")),
        ("angle", ("joint", "angle")),
        ("temperature", None),
    ],
)
def test_a_columns_name_says_its_joint_and_role(name: str, role: tuple[str, str] | None) -> None:
    assert role_of(name) == role


def test_a_stated_role_goes_before_what_the_names_say() -> None:
    time = np.arange(30.0)
    log = Log({"stamp": time, "angle": time, "x": 2 * time})
    mapping = read_mapping(["x=elbow angle [deg]"], {"time": "stamp", "angle": None})
    joints = {joint.name: joint for joint in samples_of(log, mapping).joints}
    np.testing.assert_allclose(joints["elbow"].angle, 2 * time * DEGREE)
    np.testing.assert_allclose(joints["joint"].angle, time)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "is empty"),
        ("time [s],q1\n", "0 rows"),
        ("1,2\n3,4\n", "has no names"),
        ("time [s],q1\n0,1\n1\n", r"row 2 = 1 cells: must have 2"),
        ("time [s],q1\n0,1\n1,x\n", r"column 'q1', row 2 = 'x': must be a finite number"),
        ("time [s],q1\n0,1\n1,nan\n", r"column 'q1', row 2 = nan: must be a finite number"),
        ("time [s],q1\n0,1\n1,\n", r"column 'q1', row 2 = ''"),
        ("time [s],q1,q1\n0,1,2\n", "column 'q1': is there twice"),
        ("time [s],[rad]\n0,1\n", "must have a name"),
        pytest.param(
            f"time [s],q1\n0,1\n1,{'1' * 131_073}\n",
            r"is not valid CSV: field larger than field limit \(131072\)",
            id="a cell that is too long",
        ),
    ],
)
def test_a_malformed_csv_names_file_column_row_and_value(text: str, message: str) -> None:
    with pytest.raises(LogError, match=message) as found:
        parse_csv(text, "bad.csv")
    assert str(found.value).startswith("bad.csv")


def test_a_csv_of_lines_that_end_in_carriage_returns_alone_is_read(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_bytes(csv_text(ramp()).encode().replace(b"\n", b"\r"))
    assert_equal(read_log(tmp_path / "a.csv"), ramp())


def with_columns(**columns: object) -> Log:
    base = {"time": np.arange(30) * 0.005, "q1": np.zeros(30)}
    return Log({key: np.asarray(value) for key, value in (base | columns).items()})


def test_logs_that_cannot_be_used_name_what_is_wrong() -> None:
    back = np.arange(30) * 0.005
    back[10] = back[9]
    for log, message in (
        (with_columns(time=back), r"column 'time', row 11 = 0.045 s: must be later than the row before"),
        (Log({"q1": np.zeros(30)}), "no column is the time"),
        (Log({"time": np.arange(30.0), "x": np.zeros(30)}), "no column is a joint's angle"),
        (Log({"time": np.arange(5.0), "q1": np.zeros(5)}), "5 rows: must have 20 samples or more"),
        (with_columns(theta1=np.zeros(30)), "reads as the same thing as column 'q1'"),
        (Log({"time": np.arange(30.0), "q1": np.zeros(30)}, {"q1": "N m"}), r"\[N m\]: is no unit of angle"),
        (Log({"time": np.arange(30.0), "q1": np.zeros(30)}, {"time": "fortnight"}), "is no unit of time"),
    ):
        with pytest.raises(LogError, match=message):
            samples_of(log)
    with pytest.raises(LogError, match="must have as many rows as 'time', 30"):
        with_columns(q1=np.zeros(29))
    with pytest.raises(LogError, match="column 'q1', row 3 = inf"):
        with_columns(q1=np.array([0.0, 1.0, np.inf] + [0.0] * 27))
    with pytest.raises(LogError, match="no such column"):
        samples_of(ramp(), {"nothing": "time"})
    with pytest.raises(LogError, match="must be one of: time"):
        samples_of(ramp(), {"time": "flavour"})
    with pytest.raises(LogError, match="must be COLUMN=ROLE"):
        read_mapping(["q1"], {})


@given(st.binary(max_size=300))
@settings(max_examples=150)
def test_any_bytes_give_a_log_or_a_named_error(content: bytes) -> None:
    for parse in (parse_mcap, lambda b, label: parse_csv(b.decode("latin-1"), label)):
        try:
            samples_of(parse(content, "any"))
        except ClamberError as error:
            assert str(error).startswith("any")


@given(st.data())
@settings(max_examples=150)
def test_a_broken_file_gives_the_same_log_or_a_named_error(data: st.DataObject) -> None:
    for whole, parse in (
        (mcap_bytes(ramp()), parse_mcap),
        (csv_text(ramp()).encode(), lambda b, label: parse_csv(b.decode("latin-1"), label)),
    ):
        content = bytearray(whole[: data.draw(st.integers(0, len(whole)))])
        for _ in range(data.draw(st.integers(0, 3))):
            if content:
                content[data.draw(st.integers(0, len(content) - 1))] = data.draw(st.integers(0, 255))
        try:
            samples_of(parse(bytes(content), "broken"))
        except ClamberError as error:
            assert str(error).startswith("broken")


def test_files_are_told_by_their_suffix_and_written_whole(tmp_path: Path) -> None:
    for name in ("a.csv", "a.mcap"):
        write_log(ramp(), tmp_path / name)
        assert_equal(read_log(tmp_path / name), ramp())
    for name, message in (("a.bag", "no log has the suffix '.bag'"), ("b.csv", "does not exist"), (".", "suffix")):
        with pytest.raises(FileError, match=message):
            read_log(tmp_path / name)
    (tmp_path / "c.csv").write_bytes(b"time,\xff\xfe")
    with pytest.raises(FileError, match="is not UTF-8"):
        read_log(tmp_path / "c.csv")
    with pytest.raises(FileError, match="cannot be written"):
        write_log(ramp(), tmp_path / "nowhere" / "a.csv")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.csv", "a.mcap", "c.csv"]


def test_an_error_survives_another_process() -> None:
    import pickle

    error = LogError("a.csv", "q1", 3, 0.5, "must be more")
    assert str(pickle.loads(pickle.dumps(error))) == str(error) == "a.csv, column 'q1', row 3 = 0.5: must be more"
