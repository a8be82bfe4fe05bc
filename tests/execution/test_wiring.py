"""Counts and volts: round trips, limits, and the same sensors and motors through wires as without them."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from clamber.errors import SpecError
from clamber.execution.hardware import Decoder, Reading, WiredClimber
from clamber.execution.plant import BodyPlant, BodySensed
from clamber.execution.wiring import COMMAND_LIMIT
from clamber.families.climber.execution.wiring import wiring_of
from clamber.families.climber.robot.robot import LimbedRobot
from clamber.families.climber.sim.climber_plant import ClimberPlant
from clamber.families.climber.world.library import load_board
from clamber.sim.limb_flaws import LimbFlaws
from clamber.sim.plant_rules import PlantError
from clamber.sim.wires import Amplifiers, ClimberWires
from clamber.tasks.robots import load_robot
from clamber.types import Floats, Ints
from clamber.units import OZ_IN

FLAWS = LimbFlaws(backlash=np.radians(2.0), physics_rate=1000.0, encoder_counts=400, delay=1)
START = np.array((0.2286, 0.1374, 0.0))


def libra() -> LimbedRobot:
    robot = load_robot("libra")
    assert isinstance(robot, LimbedRobot)
    return robot


WIRING = wiring_of(libra())


def test_ten_volts_are_three_thousand_ounce_inches_at_a_gear_of_574() -> None:
    full = WIRING.torques(np.full(6, 10.0)) / OZ_IN
    np.testing.assert_allclose(full[[0, 2, 4, 5]], 3000.0, rtol=2e-3)
    np.testing.assert_allclose(full[[1, 3]], 3000.0 * 792 / 574, rtol=2e-3)  # the joint's own limit is the torque's


def test_seven_encoders_are_the_joints_and_the_body() -> None:
    assert (WIRING.n_joints, WIRING.n_encoders) == (6, 7)
    turn = WIRING.resolution * math.tau
    np.testing.assert_allclose(turn, [400 * 574, 400 * 792, 400 * 574, 400 * 792, 400 * 574, 400 * 574, 4000])


@given(st.lists(st.floats(-40.0, 40.0), min_size=6, max_size=6))
def test_torques_come_back_from_volts_within_limits(asked: list[float]) -> None:
    torques = np.array(asked)
    volts = WIRING.volts(torques)
    assert np.all(np.abs(volts) <= COMMAND_LIMIT)
    limit = libra().motor.torque_limit
    np.testing.assert_allclose(WIRING.torques(volts), np.clip(torques, -limit, limit), rtol=1e-12, atol=1e-300)


@given(st.lists(st.floats(-6.0, 6.0), min_size=7, max_size=7))
def test_angles_come_back_from_counts_within_half_a_count(angles: list[float]) -> None:
    true = np.array(angles)
    counts = WIRING.counts(true)
    assert np.all(np.abs(WIRING.angles(counts) - true) * WIRING.resolution <= 0.5 + 1e-6)
    assert np.array_equal(WIRING.counts(WIRING.angles(counts)), counts)


@given(st.floats(-1e308, 1e308))
def test_no_command_drives_an_amplifier_beyond_its_limit(volts: float) -> None:
    for bits in (0, 12):
        torques = Amplifiers(WIRING, bits).torques(np.full(6, volts))
        assert np.all(np.abs(torques) <= COMMAND_LIMIT * WIRING.torque_per_volt)
        assert np.all(torques * math.copysign(1.0, volts) >= 0.0)


@given(st.floats(-10.0, 10.0), st.integers(4, 16))
def test_a_converter_is_off_by_half_a_step_at_most(volts: float, bits: int) -> None:
    given_volts = Amplifiers(WIRING, bits).torques(np.full(6, volts)) / WIRING.torque_per_volt
    assert np.all(np.abs(given_volts - volts) <= 10.0 / 2**bits * (1 + 1e-9))


@pytest.mark.parametrize("bits", [-1, 25])
def test_converters_that_cannot_be_are_refused(bits: int) -> None:
    with pytest.raises(PlantError, match="dac_bits"):
        Amplifiers(WIRING, bits)


def test_a_robot_without_amplifiers_or_counts_has_no_wires() -> None:
    robot = load_robot("gecko4")
    assert isinstance(robot, LimbedRobot)
    if robot.motor.amplifier_gain is None:
        with pytest.raises(SpecError, match=r"gecko4.*amplifier_gain.*volts"):
            wiring_of(robot)
    with pytest.raises(SpecError, match=r"libra.*encoder_counts = 0.*counted"):
        wiring_of(libra(), 0)


def test_speeds_count_the_ticks_that_nobody_read() -> None:
    decoder = Decoder(WIRING, 0.005)
    counts = np.full(7, 1000, np.int32)
    assert not decoder.decode(Reading(0 * counts, 10))[1].any(), "the first reading has nothing to compare with"
    np.testing.assert_allclose(decoder.decode(Reading(counts, 14))[1], WIRING.angles(counts) / 0.02)
    assert not decoder.decode(Reading(counts, 14))[1].any()
    decoder.reset()
    assert not decoder.decode(Reading(0 * counts, 15))[1].any()


def climbers() -> tuple[ClimberPlant, WiredClimber]:
    robot, board = libra(), load_board("ladder")
    here, there = (ClimberPlant(robot, board, FLAWS) for _ in range(2))
    wiring = wiring_of(robot, FLAWS.encoder_counts)
    return here, WiredClimber(ClimberWires(there, wiring), wiring)


def drive(plant: BodyPlant, q: Floats, torques: Floats) -> list[list[Floats]]:
    plant.reset(START, q)
    seen = []
    for torque in torques:
        sensed = plant.sense()
        seen.append([sensed.q.copy(), sensed.qd.copy(), np.array((sensed.angle, sensed.angle_speed))])
        plant.actuate(torque, np.array((1, 0, 1), np.int32))
        plant.step()
    truth = plant.truth()
    assert truth is not None
    seen.append([truth.pose, truth.q, truth.tips, truth.torques])
    return seen


def test_sensors_through_wires_say_the_same_to_the_last_bit() -> None:
    plain, wired = climbers()
    q = np.random.default_rng(0).uniform(-0.5, 0.5, (3, 2))
    none = np.zeros((60, 3, 2))
    for here, there in zip(drive(plain, q, none), drive(wired, q, none), strict=True):
        for a, b in zip(here, there, strict=True):
            assert np.array_equal(a, b)


def test_motors_through_wires_do_the_same() -> None:
    plain, wired = climbers()
    rng = np.random.default_rng(1)
    q, torques = rng.uniform(-0.5, 0.5, (3, 2)), rng.uniform(-30.0, 30.0, (40, 3, 2))
    for here, there in zip(drive(plain, q, torques), drive(wired, q, torques), strict=True):
        for a, b in zip(here, there, strict=True):
            # a last bit of torque moves an encoder by a count now and then, and its speed with it
            np.testing.assert_allclose(a, b, atol=2 * 200 / WIRING.resolution[-1])


def test_grippers_are_switches_behind_volts_and_counts() -> None:
    robot = load_robot("libra-grippers")
    assert isinstance(robot, LimbedRobot)
    wiring = wiring_of(robot)
    whole = [i for i, limb in enumerate(robot.limbs) if limb.end.kind == "gripper"]
    assert wiring.grippers == tuple(whole) and whole
    assert (wiring.n_commands, wiring.n_readings) == (6 + len(whole), 7 + len(whole))
    inner = GrippingPlant()
    wired = WiredClimber(ClimberWires(inner, wiring), wiring)
    for grips in ((1, 0, 1), (0, 1, 1)):
        wired.actuate(np.zeros((3, 2)), np.array(grips, np.int32))
        assert [inner.grips[i] for i in whole] == [grips[i] for i in whole]
        inner.gripped[:] = grips
        assert [int(wired.sense().gripped[i]) for i in whole] == [grips[i] for i in whole]


class GrippingPlant:
    """A climber that does nothing but grip."""

    period = 0.005

    def __init__(self) -> None:
        self.grips, self.gripped = np.zeros(3, np.int32), np.zeros(3, np.int32)

    def reset(self, pose: Floats, q: Floats) -> None:
        pass

    def sense(self) -> BodySensed:
        return BodySensed(np.zeros((3, 2)), np.zeros((3, 2)), 0.0, 0.0, self.gripped)

    def actuate(self, torques: Floats, grips: Ints) -> None:
        self.grips[:] = grips

    def step(self) -> None:
        pass

    def pause(self) -> None:
        pass

    def truth(self) -> None:
        return None
