"""What a plant's server does by itself: who gets its one place, an operator's stop, a clock that is not kept, a robot beyond its limits."""

import re
import socket
from collections.abc import Iterator

import numpy as np
import pytest
from toy_robot import LIMITS, PERIOD, WIRING, Driver, envelope, play

from clamber.execution.hardware import Reading
from clamber.execution.link.channel import Address as Place
from clamber.execution.link.messages import Kind, Stop, pack_stop, unpack_refusal
from clamber.execution.link.token import read_token

Address = tuple[str, int]
START = (0.3, -0.2)


def placed(address: Address) -> Driver:
    driver = Driver(address)
    driver.say(Kind.HELLO)
    driver.say(Kind.START, START)
    return driver


def said_to(driver: Driver) -> str:
    driver.look()
    return unpack_refusal(driver.others[-1].payload)


@pytest.mark.parametrize("real_time", [False, True])
def test_silent_connections_do_not_keep_the_place(real_time: bool) -> None:
    welcomed = []

    def script(address: Address) -> Iterator[float]:
        silent = [socket.create_connection(address) for _ in range(160)]
        yield 0.0
        driver = placed(address)
        yield 0.001
        driver.look()
        welcomed.append(driver.welcomed().robot)
        for one in silent:
            one.close()
        yield 0.001

    play(script, real_time=real_time)
    assert welcomed == ["toy"]


@pytest.mark.parametrize(("says", "longest"), [((Kind.HELLO,), 30.0), ((Kind.HELLO, Kind.START, Kind.COMMAND), 120.0)])
def test_a_client_that_falls_silent_loses_its_place_to_the_next_that_asks(
    says: tuple[Kind, ...], longest: float
) -> None:
    told_first, welcomed = [], []

    def script(address: Address) -> Iterator[float]:
        first = Driver(address)
        for kind in says:
            first.say(kind, () if kind is Kind.HELLO else START)
        yield longest - 1.0
        early = Driver(address)
        early.say(Kind.HELLO)
        yield 2.0
        assert f"last heard {longest - 1.0:.1f} s ago" in said_to(early)
        late = placed(address)
        yield 0.001
        told_first.append(said_to(first))
        late.look()
        welcomed.append(late.welcomed().robot)

    server, _, told = play(script, real_time=False)
    assert told_first == ["another client has asked for the plant"] and welcomed == ["toy"]
    assert server.stops == ([Stop.LOST] if Kind.COMMAND in says else [])
    assert f"it has said nothing for {longest + 1.0:.0f} s, and another asks" in told[0]


def test_a_client_that_floods_the_server_is_sent_away_before_ticks_are_lost() -> None:
    said = []

    def script(address: Address) -> Iterator[float]:
        driver = placed(address)
        yield 0.5 * PERIOD
        for _ in range(500):
            driver.say(Kind.COMMAND, (1.0, 1.0))
        yield 0.1
        said.append(said_to(driver))

    server, robot, _ = play(script, real_time=True)
    assert server.stops == [Stop.GARBLED]
    assert "a client's messages between two ticks is 65; must be at most 64" in said[0]
    assert len(robot.commands) >= 20, "the guard keeps the clock"


@pytest.mark.parametrize(("lost", "stops"), [(0.5 * PERIOD, []), (2.5 * PERIOD, [Stop.OVERRUN])])
def test_a_plant_that_does_not_keep_up_with_its_clock_is_stopped(lost: float, stops: list[Stop]) -> None:
    def script(address: Address) -> Iterator[float]:
        driver = placed(address)
        yield 0.5 * PERIOD
        for _ in range(150):
            driver.say(Kind.COMMAND, (0.0, 0.0))
            yield PERIOD

    server, _, told = play(script, real_time=True, lost=lost)
    assert server.stops == stops
    if stops:
        assert "does not keep up with the clock (21 of the last 2" in told[0]


@pytest.mark.parametrize("real_time", [False, True])
def test_an_operator_stops_the_robot_while_a_client_drives_and_gives_it_back(real_time: bool) -> None:
    said, samples = [], []

    def script(address: Address) -> Iterator[float]:
        token = read_token(Place("tcp", *address))
        driver = placed(address)
        yield 0.5 * PERIOD
        for _ in range(5):
            driver.say(Kind.COMMAND, (3.0, 3.0))
            yield PERIOD
        for secret in (bytes(32), token):
            operator = Driver(address)
            operator.channel.send(Kind.STOP, pack_stop(secret))
            driver.say(Kind.COMMAND, (3.0, 3.0))
            yield PERIOD
            said.append(said_to(operator))
        driver.say(Kind.COMMAND, (9.0, 9.0))
        yield 3.0
        driver.say(Kind.START, START)
        yield PERIOD
        said.append(said_to(driver))
        samples.extend(driver.samples)
        refused = placed(address)
        yield PERIOD
        said.append(said_to(refused))
        operator = Driver(address)
        operator.channel.send(Kind.STOP, pack_stop(token, release=True))
        yield PERIOD
        said.append(said_to(operator))
        again = placed(address)
        yield PERIOD
        again.look()
        assert again.samples[0].stop is Stop.NONE

    server, robot, _ = play(script, real_time=real_time, load=3.0)
    assert server.stops == [Stop.OPERATOR]
    assert "the token of a STOP is another" in said[0]
    assert said[1].startswith("stopped at tick ")
    assert all("`clamber plant release` gives it back" in line for line in said[1:4])
    assert said[4] == "clients may start again"
    assert samples[-1].stop is Stop.OPERATOR
    assert np.abs(robot.commands).max() < 9.0
    np.testing.assert_allclose(robot.q, START, atol=0.02)


@pytest.mark.parametrize(
    ("volts", "said"),
    [
        ((2.0, 0.0), r"first joint is at 12\d(\.\d+)? deg; its file says -114.6 to 114.6 deg"),
        ((0.0, -10.0), r"second joint turns at -3[45]\d(\.\d+)? deg/s; its file says at most 229.2 deg/s"),
        ((6.0, 0.0), r"first joint turns at 3[45]\d(\.\d+)? deg/s"),
    ],
)
def test_a_robot_beyond_its_envelope_is_stopped_whatever_its_client_wants(
    volts: tuple[float, float], said: str
) -> None:
    def script(address: Address) -> Iterator[float]:
        driver = placed(address)
        for _ in range(600):
            driver.say(Kind.COMMAND, volts)
            yield 0.0

    server, _, told = play(script, real_time=False)
    assert server.stops == [Stop.ENVELOPE]
    assert re.fullmatch(
        rf"safe stop at tick \d+: the robot is beyond its limits \({said}.*\); the posture is held", told[0]
    )
    assert told[1].startswith("held for 2 s")


def test_a_motor_that_has_been_asked_for_much_for_long_is_stopped_after_the_time_that_its_heat_takes() -> None:
    held = envelope()
    still, ticks = Reading(WIRING.counts(np.zeros(3)), 0), 0
    while held.fault(still) is None:
        held.warm(np.array((8.0, 8.0)))
        ticks += 1
    assert ticks * PERIOD == pytest.approx(LIMITS.thermal_time * np.log(4.0 / 3.0), abs=2 * PERIOD), "twice the torque"
    assert "the motor of first joint" in str(held.fault(still))
    for _ in range(round(20.0 / PERIOD)):
        held.warm(np.array((3.9, 7.9)))
    assert held.fault(still) is None and held.heat.max() == pytest.approx((7.9 / 8.0) ** 2, rel=1e-3)


def test_a_reading_that_is_wrong_for_a_tick_stops_nothing() -> None:
    watch = envelope()
    for tick in range(50):
        angle = 0.5 if tick % 10 else 2.5
        assert watch.fault(Reading(WIRING.counts(np.array((angle, 0.0, 0.0))), tick)) is None


def test_who_is_told_may_be_gone_and_the_robot_is_held_all_the_same() -> None:
    def script(address: Address) -> Iterator[float]:
        driver = placed(address)
        yield PERIOD
        driver.say(Kind.COMMAND, (0.0, 0.0))
        yield 3.0

    def gone(_: str) -> None:
        raise OSError("Input/output error")

    server, robot, _ = play(script, real_time=True, say=gone)
    assert server.stops == [Stop.SILENT] and len(robot.commands) > 500
