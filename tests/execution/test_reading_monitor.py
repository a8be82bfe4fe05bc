"""What a robot believes of its readings: all of them to the last bit without a fault, and which fault it is with one."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from clamber.execution.reading_monitor import BRIDGED, FULLY_DRIVEN, UNMOVED, YIELDS, Channel, ReadingMonitor
from clamber.execution.run_report import FaultError
from clamber.types import Floats

PERIOD = 0.005
FASTEST, LIMIT = 3.0, 20.0
"""Of both joints [rad/s], [N m]."""


def monitor() -> ReadingMonitor:
    return ReadingMonitor([Channel(name=name, fastest=FASTEST, limit=LIMIT) for name in ("one", "two")], PERIOD)


def see(watch: ReadingMonitor, values: Floats, speeds: Floats, commands: Floats, number: int = -1) -> None:
    watch.values[:], watch.speeds[:], watch.commands[:] = values, speeds, commands
    watch.see(number)


def sway(k: int) -> tuple[Floats, Floats]:
    """Joints that sway by half a radian within two seconds, well within their speed."""
    phase = math.tau * k * PERIOD / 2.0
    return 0.5 * np.array((math.sin(phase), math.cos(phase))), math.pi / 2 * np.array(
        (math.cos(phase), -math.sin(phase))
    )


@given(st.integers(1, 400), st.integers(0, 2**32 - 1))
def test_what_can_be_is_believed_to_the_last_bit(ticks: int, seed: int) -> None:
    watch, random = monitor(), np.random.default_rng(seed)
    for k in range(ticks):
        values, speeds = sway(k)
        values, speeds = values + 1e-3 * random.standard_normal(2), speeds + 0.1 * random.standard_normal(2)
        see(watch, values, speeds, 5.0 * random.standard_normal(2), k)
        assert np.array_equal(watch.values, values) and np.array_equal(watch.speeds, speeds)
    assert not watch.findings


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf, 1e30, math.radians(20.0)])
def test_a_reading_that_cannot_be_is_bridged_and_told(bad: float) -> None:
    watch = monitor()
    for k in range(200):
        values, speeds = sway(k)
        true = values.copy()
        if k == 100:
            values[1] = bad if not abs(bad) < 1.0 else values[1] + bad
        if k == 101:
            speeds[1] = (values[1] - bad) / PERIOD  # an encoder's speed is a difference: the next one is off, too
        see(watch, values, speeds, np.zeros(2), k)
        assert np.abs(watch.values - true).max() < 1e-3
        assert np.abs(watch.speeds - sway(k)[1]).max() < 0.1
    (told,) = watch.findings
    assert (told.where, told.kind) == ("two", "no number" if not math.isfinite(bad) else "jump")
    assert told.time == pytest.approx(101 * PERIOD)


def ticks_to_an_end(reading: object, *, commands: object = None, numbers: object = None) -> tuple[ReadingMonitor, int]:
    """The monitor at its end, and how many ticks after tick 100 that was."""
    watch = monitor()
    for k in range(1000):
        values, speeds = sway(k)
        if k >= 100:
            values, speeds = reading(k, values, speeds)  # type: ignore[operator]
        driven = np.zeros(2) if commands is None else commands(k)  # type: ignore[operator]
        number = k if numbers is None or k < 100 else numbers(k)  # type: ignore[operator]
        try:
            see(watch, values, speeds, driven, number)
        except FaultError as end:
            assert str(watch.findings[-1]).startswith(str(end)[:10]) or watch.findings
            return watch, k - 100
    return watch, -1


def test_a_sensor_that_fails_for_good_ends_the_run_within_its_time() -> None:
    for bad in (math.nan, 40.0):
        watch, ticks = ticks_to_an_end(lambda k, q, qd, bad=bad: (np.array((q[0], bad)), qd))
        assert 0 < ticks * PERIOD <= BRIDGED + PERIOD
        assert watch.bad == {1}
        assert np.isfinite(watch.values).all() and np.isfinite(watch.speeds).all()


def test_a_stuck_sensor_is_told_once_its_motor_is_driven_otherwise() -> None:
    stuck = sway(100)[0][0]
    watch, ticks = ticks_to_an_end(
        lambda k, q, qd: (np.array((stuck, q[1])), np.array((0.0, qd[1]))),
        commands=lambda k: np.array((0.1 * max(0, k - 100), 0.0)),
    )
    assert UNMOVED <= ticks * PERIOD <= 0.4  # 6 N m at 20 N m/s
    assert (watch.findings[-1].where, watch.findings[-1].kind) == ("one", "no answer")
    _, never = ticks_to_an_end(lambda k, q, qd: (np.array((stuck, q[1])), np.array((0.0, qd[1]))))
    assert never == -1  # a joint that is not driven may stand still


def test_a_joint_of_a_limb_that_holds_is_silent_only_while_it_stands_still() -> None:
    """The squeeze between two holds may change without a count; later the body moves, and the joint has never failed."""
    watch = monitor()
    watch.free[0] = False
    still = sway(0)[0][0]
    silent = []
    for k in range(200):
        values, speeds = sway(k)
        stands = k < 100
        values[0], speeds[0] = (still, 0.0) if stands else (still + 1e-3 * (k - 99), 0.2)
        see(watch, values, speeds, np.array((0.1 * k, 0.0)))
        silent.append(bool(watch.silent[0]))
        assert watch.unchanged[0] == (k if stands else 0)
    assert silent[99]
    assert not any(silent[100:])


@pytest.mark.parametrize(("held", "least"), [(0.5, 0.1), (0.0, 0.3)])
def test_a_change_of_command_that_a_hold_has_balanced_is_no_fault_before_the_motor_stirs_the_free_joint(
    held: float, least: float
) -> None:
    """The load passes off a limb on its hold, and a joint of it stands still; then the limb leaves the hold."""
    watch = monitor()

    def stand(command: float, ticks: int = 60) -> None:
        for _ in range(ticks):
            see(watch, np.zeros(2), np.zeros(2), np.array((command * LIMIT, 0.0)))

    watch.free[0] = False
    stand(held)
    stand(0.0)
    watch.free[0] = True
    stand(0.0)
    stand(0.95 * least)
    assert not watch.findings
    with pytest.raises(FaultError, match="one: no answer"):
        stand(1.05 * least)


def test_a_joint_that_moves_soon_after_its_limb_has_left_its_hold_has_not_failed() -> None:
    """It has as long as any joint to answer its motor."""
    watch = monitor()
    for k in range(200):
        watch.free[0] = k >= 100
        angle = 0.0 if k < 120 else 1e-3 * (k - 119)
        see(
            watch,
            np.array((angle, 0.0)),
            np.zeros(2),
            np.array(((0.5 if k < 50 else 0.0 if k < 100 else 0.2) * LIMIT, 0.0)),
        )
    assert not watch.findings


def test_a_joint_that_gives_way_to_a_full_command_is_told() -> None:
    watch, ticks = ticks_to_an_end(
        lambda k, q, qd: (q, qd),
        commands=lambda k: np.array((-0.95 * LIMIT * np.sign(sway(k)[1][0]) * (k >= 110), 0.0)),
    )
    assert YIELDS <= (ticks + 1) * PERIOD <= 2.0 * YIELDS
    assert watch.findings[-1].kind == "overpowered"
    assert watch.findings[-1].why.endswith(f"for {YIELDS:.2f} s and turns against it")


def test_a_joint_that_a_full_command_does_not_move_is_told_later() -> None:
    """Arms that hold the body against a push stand still under all of their torque for a while."""

    def still(k: int, q: Floats, qd: Floats) -> tuple[Floats, Floats]:
        return np.array((sway(100)[0][0] + 1e-4 * (k % 2), q[1])), np.array((0.0, qd[1]))

    def driven(k: int) -> Floats:
        return np.array((0.95 * LIMIT * (k >= 100), 0.0))

    watch, ticks = ticks_to_an_end(still, commands=driven)
    assert FULLY_DRIVEN <= (ticks + 1) * PERIOD <= FULLY_DRIVEN + 0.1
    assert watch.findings[-1].kind == "overpowered"
    assert watch.findings[-1].why.endswith(f"for {FULLY_DRIVEN:.2f} s and does not follow")
    _, never = ticks_to_an_end(still, commands=lambda k: driven(k) * (k * PERIOD % 1.0 < 0.4))
    assert never == -1


@pytest.mark.parametrize(
    ("numbers", "kind", "ends"),
    [
        (lambda k: 99, "no reading", True),  # nothing new any more
        (lambda k: k - 6, "late readings", True),
        (lambda k: k - 1, "no reading", False),  # a tick late: what control is made for
        (lambda k: k if k % 5 else k - 3, "no reading", False),  # an old one now and then
        (lambda k: k + (k - 100) // 7, "uneven ticks", False),
    ],
)
def test_numbers_of_readings_tell_what_is_wrong_with_the_link(numbers: object, kind: str, ends: bool) -> None:
    watch, ticks = ticks_to_an_end(lambda k, q, qd: (q, qd), numbers=numbers)
    assert kind in {finding.kind for finding in watch.findings}
    assert (ticks >= 0) == ends
    assert watch.linked != ends
    if ends:
        assert ticks * PERIOD <= 2 * BRIDGED + 0.07
    assert np.isfinite(watch.values).all()


def test_after_a_pause_joints_may_be_anywhere() -> None:
    watch = monitor()
    see(watch, np.zeros(2), np.zeros(2), np.zeros(2), 1)
    watch.after_pause()
    see(watch, np.ones(2), np.zeros(2), np.zeros(2), 4000)
    assert np.array_equal(watch.values, np.ones(2))
    assert not watch.findings
