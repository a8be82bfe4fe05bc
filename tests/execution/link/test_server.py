"""The server of a plant, with a robot that needs no simulator and a clock that the test turns: what it obeys, refuses, and holds."""

import socket
from collections.abc import Iterator
from contextlib import suppress

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from toy_robot import PERIOD, Driver, play

from clamber.execution.link.channel import ConnectionEndedError
from clamber.execution.link.messages import Kind, Stop, frame, pack_numbers, unpack_refusal

Address = tuple[str, int]
START = (0.3, -0.2)
MANY = 200 * PERIOD


def placed(address: Address) -> Iterator[Driver]:
    driver = Driver(address)
    driver.say(Kind.HELLO)
    driver.say(Kind.START, START)
    yield driver


def test_a_command_in_lock_step_is_one_period() -> None:
    seen: list[Driver] = []

    def script(address: Address) -> Iterator[float]:
        driver = Driver(address)
        seen.append(driver)
        driver.say(Kind.HELLO)
        driver.say(Kind.START, START)
        for k in range(3):
            driver.say(Kind.COMMAND, (0.1 * k, 0.0))
            yield MANY  # however long: time stands still without a command
        driver.look()

    _, robot, told = play(script, real_time=False)
    (driver,) = seen
    assert driver.welcomed().robot == "toy"
    assert [sample.tick for sample in driver.samples] == [0, 1, 2, 3]
    assert [sample.answers for sample in driver.samples] == [2, 3, 4, 5]
    assert np.array_equal(robot.commands[:3], [(0.0, 0.0), (0.1, 0.0), (0.2, 0.0)])
    assert np.array_equal(driver.samples[-1].truth, robot.q)
    assert not told


def test_in_real_time_the_latest_command_is_taken_and_held_for_a_tick() -> None:
    def script(address: Address) -> Iterator[float]:
        driver = next(placed(address))
        yield 0.5 * PERIOD
        driver.say(Kind.COMMAND, (1.0, 0.0))
        driver.say(Kind.COMMAND, (2.0, 0.0))
        yield PERIOD
        driver.say(Kind.COMMAND, (3.0, 0.0))
        yield PERIOD
        yield PERIOD

    server, robot, _ = play(script, real_time=True)
    assert [command[0] for command in robot.commands] == [2.0, 3.0, 3.0], "the last one again, for one tick"
    assert not server.stops


@pytest.mark.parametrize("load", [0.0, 3.0])
def test_two_ticks_without_a_command_are_a_safe_stop_and_the_joints_stay(load: float) -> None:
    seen: list[Driver] = []

    def script(address: Address) -> Iterator[float]:
        driver = next(placed(address))
        seen.append(driver)
        yield 0.5 * PERIOD
        for _ in range(20):
            driver.say(Kind.COMMAND, (load, load))
            yield PERIOD
        yield 3.0
        driver.say(Kind.COMMAND, (9.0, 9.0))
        yield PERIOD
        driver.look()

    server, robot, told = play(script, real_time=True, load=load)
    assert server.stops == [Stop.SILENT]
    assert "safe stop at tick 21: no command came for two ticks" in told[0]
    assert "no joint has moved by more than 0.0" in told[1]
    np.testing.assert_allclose(robot.q, START, atol=2e-4)
    stops = [sample.stop for sample in seen[0].samples]
    assert stops[:22] == [Stop.NONE] * 22 and set(stops[22:]) == {Stop.SILENT}, "what comes too late changes nothing"
    assert not np.any(np.abs(robot.commands) > 8.0)


MESSAGES = st.one_of(
    st.just((Kind.START, pack_numbers(np.array(START)))),
    st.builds(lambda a, b: (Kind.COMMAND, pack_numbers(np.array((a, b)))), st.floats(-20, 20), st.floats(-20, 20)),
    st.sampled_from(((Kind.PAUSE, b""), (Kind.BYE, b""), (Kind.HELLO, b""))),
    st.tuples(st.sampled_from(Kind), st.binary(max_size=40)),
)


@given(st.lists(st.tuples(MESSAGES, st.floats(0.0, 0.03)), max_size=12), st.booleans())
def test_whatever_a_client_says_the_server_lives_and_welcomes_the_next(
    said: list[tuple[tuple[Kind, bytes], float]], real_time: bool
) -> None:
    seen: list[Driver] = []

    def script(address: Address) -> Iterator[float]:
        driver = Driver(address)
        driver.say(Kind.HELLO)
        for (kind, payload), pause in said:
            with suppress(ConnectionEndedError):
                driver.channel.send(kind, payload)
            yield pause
        driver.channel.hang_up()
        yield 0.1
        driver = next(placed(address))
        yield 0.1
        driver.look()
        seen.append(driver)

    play(script, real_time=real_time)
    assert seen[0].welcomed().robot == "toy"
    assert seen[0].samples[0].stop is Stop.NONE


def test_who_knocks_a_thousand_times_uses_nothing_up() -> None:
    def script(address: Address) -> Iterator[float]:
        driver = next(placed(address))
        yield 0.0
        for _ in range(1100):
            Driver(address).say(Kind.HELLO)
            yield 0.0
        driver.say(Kind.COMMAND, (1.0, 1.0))
        yield 0.0

    server, robot, _ = play(script, real_time=False)
    assert len(robot.commands) == 1 and not server.stops


def test_before_the_first_command_and_after_the_last_the_guard_holds() -> None:
    def script(address: Address) -> Iterator[float]:
        driver = next(placed(address))
        yield 1.0
        for _ in range(5):
            driver.say(Kind.COMMAND, (3.0, 3.0))
            yield PERIOD
        driver.channel.send(Kind.BYE)
        driver.channel.hang_up()
        yield 2.0

    server, robot, told = play(script, real_time=True, load=3.0)
    assert not server.stops
    assert told[0] == "the client has ended; the posture is held"
    assert "205 ticks began 0.00 ms late in the median" in told[1]
    np.testing.assert_allclose(robot.q, START, atol=0.02)  # sagged a little at first: nobody knew the load


@pytest.mark.parametrize("real_time", [False, True])
@pytest.mark.parametrize("middle", [False, True])
def test_a_client_that_is_gone_is_a_safe_stop_and_the_next_may_start(real_time: bool, middle: bool) -> None:
    seen: list[Driver] = []

    def script(address: Address) -> Iterator[float]:
        driver = next(placed(address))
        for _ in range(10):
            driver.say(Kind.COMMAND, (3.0, 3.0))
            yield PERIOD
        if middle:
            driver.channel.socket.send(frame(Kind.COMMAND, driver.channel.sent + 1, pack_numbers(np.ones(2)))[:33])
        driver.look()  # what is left unread would make of the end a reset
        driver.channel.hang_up()
        yield 3.0
        driver = next(placed(address))
        seen.append(driver)
        yield PERIOD
        driver.say(Kind.COMMAND, (3.0, 3.0))
        yield PERIOD
        driver.look()

    server, robot, told = play(script, real_time=real_time, load=3.0)
    assert server.stops == [Stop.LOST]
    assert ("in the middle of a message" if middle else "hung up") in told[0]
    assert any(line.startswith("held for 2 s: no joint has moved by more than 0.0") for line in told)
    assert seen[0].samples[0].tick == 0 and seen[0].samples[-1].stop is Stop.NONE
    np.testing.assert_allclose(robot.q, START, atol=1e-3)


GARBAGE = [
    (b"GET / HTTP/1.1\r\n\r\n" * 3, "first word"),
    (frame(Kind.COMMAND, 99, pack_numbers(np.zeros(2))), "the number is 99"),
    (frame(Kind.COMMAND, 4, pack_numbers(np.zeros(3))), "the length of a COMMAND is 24; must be 16 bytes here"),
    (frame(Kind.COMMAND, 4, pack_numbers(np.array((np.nan, 0.0)))), "number 1 of a COMMAND is nan"),
    (
        frame(Kind.COMMAND, 4, pack_numbers(np.array((1.0, 1e308)))),
        "number 2 of a COMMAND is 1e+308; must be -10 to 10 V (second joint)",
    ),
    (
        frame(Kind.COMMAND, 4, pack_numbers(np.array((-10.1, 0.0)))),
        "number 1 of a COMMAND is -10.1; must be -10 to 10 V",
    ),
    (frame(Kind.SAMPLE, 4, b""), "a client's message is a SAMPLE"),
    (frame(Kind.START, 4, pack_numbers(np.array((1e9, 0.0)))), "a number of a START"),
    (frame(Kind.COMMAND, 4, pack_numbers(np.zeros(2)))[:30], "the rest of a message is missing"),
]


@pytest.mark.parametrize("real_time", [False, True])
@pytest.mark.parametrize(("raw", "said"), GARBAGE)
def test_what_is_no_message_is_refused_by_name_and_the_robot_held(raw: bytes, said: str, real_time: bool) -> None:
    seen: list[Driver] = []

    def script(address: Address) -> Iterator[float]:
        driver = next(placed(address))
        seen.append(driver)
        driver.say(Kind.COMMAND, (3.0, 3.0))
        yield 0.0
        driver.channel.socket.send(raw)
        yield 0.001 if len(raw) != 30 else 3.0
        driver.look()

    server, robot, told = play(script, real_time=real_time, load=3.0)
    if real_time and len(raw) == 30:
        assert server.stops == [Stop.SILENT], "a client that stalls is silent first"
    else:
        assert server.stops == [Stop.GARBLED]
        assert said in told[0]
        assert said in unpack_refusal(seen[0].others[-1].payload)
    np.testing.assert_allclose(robot.q, START, atol=1e-3)


def test_nothing_moves_for_who_has_not_said_hello_or_placed_the_robot() -> None:
    seen: list[Driver] = []

    def script(address: Address) -> Iterator[float]:
        for kind, numbers in ((Kind.START, START), (Kind.COMMAND, (1.0, 1.0))):
            driver = Driver(address)
            seen.append(driver)
            driver.say(kind, numbers)
            yield 0.1
            driver.look()
        driver = Driver(address)
        seen.append(driver)
        driver.say(Kind.HELLO)
        driver.say(Kind.COMMAND, (1.0, 1.0))
        yield 0.1
        driver.look()

    server, robot, told = play(script, real_time=False)
    assert not robot.commands and not server.stops
    said = [unpack_refusal(driver.others[-1].payload) for driver in seen]
    assert "must be a HELLO" in said[0] and "must be a HELLO" in said[1] and "must follow a START" in said[2]
    assert len(told) == 3


def test_a_second_client_is_told_that_the_plant_is_taken_and_the_first_goes_on() -> None:
    seen: list[Driver] = []

    def script(address: Address) -> Iterator[float]:
        first = next(placed(address))
        yield 0.1
        second = Driver(address)
        second.say(Kind.HELLO)
        yield 0.1
        second.look()
        first.say(Kind.COMMAND, (1.0, 1.0))
        yield 0.1
        first.look()
        seen.extend((first, second))

    server, _, _ = play(script, real_time=False)
    first, second = seen
    host, port = first.channel.socket.getsockname()
    assert unpack_refusal(second.others[0].payload).startswith(
        f"another client drives this plant: {host}:{port}, for 0 s"
    )
    assert first.samples[-1].tick == 1
    assert not server.stops


def test_after_a_safe_stop_only_a_new_start_moves_the_robot() -> None:
    seen: list[Driver] = []

    def script(address: Address) -> Iterator[float]:
        driver = next(placed(address))
        seen.append(driver)
        driver.say(Kind.COMMAND, (0.0, 0.0))
        yield 3.0
        driver.say(Kind.START, (0.1, 0.1))
        yield 0.5 * PERIOD
        driver.look()
        driver.say(Kind.COMMAND, (5.0, 0.0))
        yield PERIOD
        driver.look()

    server, robot, _ = play(script, real_time=True)
    assert server.stops == [Stop.SILENT]
    assert robot.commands[-1][0] == 5.0
    assert seen[0].samples[-1].tick == 1


@pytest.mark.parametrize("load", [0.0, 3.0])
def test_a_pause_is_held_by_the_guard_and_ends_with_the_next_command(load: float) -> None:
    def script(address: Address) -> Iterator[float]:
        driver = next(placed(address))
        yield 0.5 * PERIOD
        for pause in (1.0, 0.1, 30.0):
            driver.say(Kind.COMMAND, (load, load))
            yield PERIOD
            driver.channel.send(Kind.PAUSE)
            driver.channel.send(Kind.PAUSE)
            yield pause
        driver.say(Kind.COMMAND, (load + 2.0, load))
        yield PERIOD

    server, robot, told = play(script, real_time=True, load=load)
    assert not server.stops and not told
    assert robot.commands[-1][0] == load + 2.0
    np.testing.assert_allclose(robot.q, START, atol=1e-3)


@pytest.mark.slow
def test_no_pause_is_for_ever() -> None:
    def script(address: Address) -> Iterator[float]:
        driver = next(placed(address))
        driver.say(Kind.COMMAND, (0.0, 0.0))
        yield PERIOD
        driver.channel.send(Kind.PAUSE)
        yield 119.0
        driver.channel.send(Kind.PAUSE)
        yield 60.0

    server, robot, _ = play(script, real_time=True)
    assert server.stops == [Stop.SILENT]
    np.testing.assert_allclose(robot.q, START, atol=1e-3)


@pytest.mark.parametrize(("abrupt", "stops"), [(False, []), (True, [Stop.LOST])])
@pytest.mark.parametrize("real_time", [False, True])
def test_once_it_ends_with_its_first_client_after_having_held(abrupt: bool, stops: list[Stop], real_time: bool) -> None:
    def script(address: Address) -> Iterator[float]:
        probe = socket.create_connection(address)  # one that never says anything is not the first client
        probe.close()
        yield 0.1
        driver = next(placed(address))
        driver.say(Kind.COMMAND, (0.0, 0.0))
        yield PERIOD
        if not abrupt:
            driver.channel.send(Kind.BYE)
        driver.channel.hang_up()
        yield 100.0
        raise AssertionError("it goes on")

    server, robot, _ = play(script, real_time=real_time, once=True)
    assert server.stops == stops
    assert len(robot.commands) == 1 + (400 if abrupt else 0)
