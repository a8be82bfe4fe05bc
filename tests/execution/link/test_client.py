"""The client of a plant's server: the same hardware as if it were here, and named errors where the server is none, or is lost."""

import socket
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
from toy_robot import INERTIA, PERIOD, WIRING, ToyRobot, about, envelope

from clamber.execution.hardware import Hardware
from clamber.execution.link.channel import (
    Address,
    Channel,
    ConnectionEndedError,
    LinkError,
    listen,
    read_address,
    unlink,
)
from clamber.execution.link.client import RemoteHardware
from clamber.execution.link.messages import Kind, Sample, Stop, frame, pack_about, pack_refusal, pack_sample
from clamber.execution.link.server import PlantServer
from clamber.execution.plant import PlantStoppedError
from clamber.execution.posture_guard import PostureGuard
from clamber.types import Floats

ANY = Address("tcp", "127.0.0.1")


@contextmanager
def toy_server(
    address: Address = ANY, *, real_time: bool = False, told: Callable[[str], None] = str
) -> Iterator[tuple[Address, PlantServer]]:
    """A toy robot served from a thread, to one client; in real time so slowly that a busy machine keeps up."""
    listener, found = listen(address)
    guard = PostureGuard(WIRING, INERTIA, PERIOD)
    slowly = about(real_time=real_time, pace=0.05 if real_time else 1.0)
    server = PlantServer(ToyRobot(), slowly, guard, envelope(), listener, say=told, once=True)
    thread = threading.Thread(target=server.serve, daemon=True)
    thread.start()
    try:
        yield found, server
        thread.join(20.0)
        assert not thread.is_alive()
    finally:
        unlink(found)


def drive(hardware: Hardware, ticks: int = 50) -> list[tuple[list[int], list[float]]]:
    hardware.reset(np.array((0.3, -0.2)))
    seen = []
    for k in range(ticks):
        reading = hardware.sense()
        assert reading.tick == k
        seen.append((reading.counts.tolist(), hardware.truth().tolist()))
        hardware.actuate(np.array((np.sin(0.3 * k), 0.1 * k)))
        hardware.step()
    return seen


def test_a_plant_in_another_place_does_the_same_to_the_last_bit() -> None:
    with toy_server() as (address, _), RemoteHardware(address) as remote:
        there = drive(remote)
    assert there == drive(ToyRobot())


def test_a_unix_socket_is_for_its_user_alone_and_goes_with_the_server(tmp_path: Path) -> None:
    path = tmp_path / "robot"
    with toy_server(Address("unix", str(path))) as (address, _):
        assert path.stat().st_mode & 0o777 == 0o600
        with pytest.raises(LinkError, match=f"plant at unix:{path}: cannot listen there"):
            listen(address)
        with RemoteHardware(read_address(f"unix:{path}")) as remote:
            there = drive(remote)
    assert there == drive(ToyRobot())
    assert not path.exists()


@pytest.mark.slow
def test_in_real_time_the_plant_moves_on_by_itself() -> None:
    with toy_server(real_time=True) as (address, server), RemoteHardware(address) as remote:
        remote.reset(np.zeros(2))
        ticks = []
        for _ in range(10):
            remote.actuate(np.zeros(2))
            remote.step()
            ticks.append(remote.sense().tick)
        assert ticks == sorted(set(ticks)), "each step is a new sample"
    assert not server.stops


@pytest.mark.slow
def test_who_pauses_may_be_late() -> None:
    with toy_server(real_time=True) as (address, server), RemoteHardware(address) as remote:
        remote.reset(np.zeros(2))
        remote.step()
        for _ in range(3):
            remote.pause()
            before = remote.sense().tick
            while remote.sense().tick < before + 5:
                pass
            remote.step()
    assert not server.stops


@pytest.mark.slow
def test_who_is_late_finds_the_plant_stopped(monkeypatch: pytest.MonkeyPatch) -> None:
    stopped, looked = threading.Event(), threading.Event()
    monkeypatch.setattr("clamber.execution.link.served_plant.HELD", 0.1)

    def told(_: str) -> None:
        stopped.set()
        assert looked.wait(20.0)

    with toy_server(real_time=True, told=told) as (address, server), RemoteHardware(address) as remote:
        remote.reset(np.zeros(2))
        remote.step()
        assert stopped.wait(20.0)
        remote.step()  # takes what was sent before the stop; that one was made is on the way
        looked.set()
        with pytest.raises(PlantStoppedError, match="safe stop: no command came for two ticks"):
            remote.step()
    assert server.stops == [Stop.SILENT]


@pytest.mark.parametrize(
    "text",
    ["", "ladder", "tcp://", "tcp://127.0.0.1", "tcp://127.0.0.1:", "tcp://127.0.0.1:99999", "tcp://127.0.0.1:-1", "tcp://10.0.0.5:80",
     "tcp://0.0.0.0:80", "tcp://example.org:80", "tcp://127.0.0.999:80", "tcp://127.0.0.1:80/", "unix:", "unix:" + "x" * 200],
)  # fmt: skip
def test_what_is_no_address_of_this_machine_is_refused(text: str) -> None:
    with pytest.raises(LinkError, match=r"plant at .*; (state tcp://127|take at most)"):
        read_address(text)


def test_addresses_read_as_they_are_written() -> None:
    for text in ("tcp://127.0.0.1:4000", "unix:/run/robot"):
        assert str(read_address(text)) == text
    assert read_address("tcp://localhost:7") == read_address("tcp://127.0.0.1:7")


@pytest.mark.parametrize("kind", ["tcp", "unix"])
def test_where_nobody_serves_there_is_no_link(kind: str, tmp_path: Path) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
    address = Address("tcp", "127.0.0.1", port) if kind == "tcp" else Address("unix", str(tmp_path / "none"))
    with pytest.raises(LinkError, match=r"nothing answers there .*clamber plant serve"):
        RemoteHardware(address)


def test_another_robot_or_board_is_refused() -> None:
    with toy_server() as (address, _), RemoteHardware(address) as remote:
        remote.check("toy", "table")
        with pytest.raises(LinkError, match="its robot is 'toy'; must be 'libra'"):
            remote.check("libra", "table")
        with pytest.raises(LinkError, match="its place is 'table'; must be 'ladder'"):
            remote.check("toy", "ladder")


def sample(tick: int, answers: int, *, truth: Floats | None = None, stop: Stop = Stop.NONE) -> bytes:
    return pack_sample(Sample(tick, answers, stop, np.zeros(3, np.int32), np.zeros(2) if truth is None else truth))


@contextmanager
def fake_server(*answers: bytes | Callable[[Channel], None]) -> Iterator[Address]:
    """A server that answers each message with given bytes, then hangs up."""
    listener, address = listen(ANY)

    def serve() -> None:
        made, _ = listener.accept()
        channel = Channel(made)
        try:
            for answer in answers:
                channel.wait(10.0)
                if callable(answer):
                    answer(channel)
                else:
                    channel.socket.send(answer)
        except (ConnectionEndedError, OSError):
            pass
        finally:
            channel.hang_up()

    thread = threading.Thread(target=serve, daemon=True)
    thread.start()
    with listener:
        yield address
    thread.join(20.0)
    assert not thread.is_alive()


WELCOME = frame(Kind.WELCOME, 1, pack_about(about(real_time=False)))


@pytest.mark.parametrize(
    ("answer", "said"),
    [
        (b"HTTP/1.1 400 Bad Request\r\n\r\n", "first word is b'HTTP'"),
        (b"", "hung up"),
        (WELCOME[:30], "in the middle of a message"),
        (frame(Kind.REFUSAL, 1, pack_refusal("another client drives this plant")), "another client drives this plant"),
        (frame(Kind.SAMPLE, 1, sample(0, 0)), "is a SAMPLE; must be a WELCOME"),
        (frame(Kind.WELCOME, 1, b"\xff" * 96), "of a WELCOME is"),
    ],
)
def test_who_is_no_server_of_plants_makes_no_link(answer: bytes, said: str) -> None:
    with fake_server(answer) as address, pytest.raises(LinkError) as refused:
        RemoteHardware(address)
    assert said in str(refused.value) and "docs/hardware.md" in str(refused.value)


@pytest.mark.parametrize(
    ("answer", "said"),
    [
        (b"", "is lost: it has hung up"),
        (frame(Kind.SAMPLE, 3, sample(1, 3))[:40], "is lost: in the middle of a message"),
        (frame(Kind.SAMPLE, 3, sample(1, 3)[:-1]), "the length of a SAMPLE"),
        (frame(Kind.SAMPLE, 9, sample(1, 3)), "the number is 9"),
        (frame(Kind.SAMPLE, 3, sample(1, 2)), "answers another command"),
        (frame(Kind.SAMPLE, 3, sample(0, 3)), "is lost: its tick stands still at 0"),
        (frame(Kind.SAMPLE, 3, sample(1, 3, truth=np.array((np.nan, 0.0)))), "the truth of a SAMPLE is nan"),
        (frame(Kind.SAMPLE, 3, sample(1, 3, stop=Stop.ENDED)), "safe stop: its server ends"),
        (frame(Kind.REFUSAL, 3, pack_refusal("message: no")), "refuses: message: no"),
        (frame(Kind.WELCOME, 3, pack_about(about(real_time=False))), "is a WELCOME; must be a SAMPLE"),
        (b"\x00" * 64, "first word"),
    ],
)
def test_a_server_that_is_lost_on_the_way_ends_the_run_with_a_reason(answer: bytes, said: str) -> None:
    truth = np.array((0.5, 0.25))
    with fake_server(WELCOME, frame(Kind.SAMPLE, 2, sample(0, 2, truth=truth)), answer) as address:
        remote = RemoteHardware(address)
        remote.reset(np.zeros(2))
        with pytest.raises(PlantStoppedError) as stopped:
            remote.step()
        assert said in str(stopped.value)
        if "ends" not in said:
            assert np.array_equal(remote.truth(), truth), "the log keeps the last that was known"
        remote.close()


@pytest.mark.slow
def test_a_plant_whose_ticks_stand_still_is_lost_though_samples_come() -> None:
    def go_on(channel: Channel) -> None:
        number = 3
        while True:
            channel.socket.send(frame(Kind.SAMPLE, number, sample(7, 2)))
            number += 1
            time.sleep(0.05)

    quick = frame(Kind.WELCOME, 1, pack_about(about(real_time=True)))
    with fake_server(quick, frame(Kind.SAMPLE, 2, sample(7, 2)), go_on) as address:
        remote = RemoteHardware(address)
        remote.reset(np.zeros(2))
        began = time.monotonic()
        with pytest.raises(PlantStoppedError, match="its tick stands still at 7"):
            while time.monotonic() - began < 20.0:
                remote.step()
        assert time.monotonic() - began >= 200 * PERIOD
        remote.close()


def test_a_start_that_the_server_refuses_is_bad_input() -> None:
    with (
        toy_server() as (address, _),
        RemoteHardware(address) as remote,
        pytest.raises(LinkError, match="a number of a START is 1000000"),
    ):
        remote.reset(np.full(2, 1e6))
