"""Measures against paths whose errors are known in closed form, and against the plant."""

import math
from collections.abc import Callable

import numpy as np
import pytest

from clamber.control.law_settings import LawSettings
from clamber.control.records import REPORT
from clamber.execution.trace import LimbTrace
from clamber.limb_bench.bench_limb import bench_limb
from clamber.limb_bench.measures import NEVER, Entry, Measures, Run, instability, measure
from clamber.limb_bench.runner import run_contest
from clamber.limb_bench.scenario import Scenario, circle_scenario, push_scenario, step_scenario
from clamber.sim.bench_limb import BenchLimb
from clamber.sim.limb_flaws import LimbFlaws

RATE = 200.0
LIMB = bench_limb()
ENTRY = Entry("scct", LawSettings(law="scct", kp=100.0))


def trace_of(limb: BenchLimb, scenario: Scenario, path: Callable[[float], tuple[float, float]]) -> LimbTrace:
    """A trace whose tip is where `path` says, without torques."""
    ticks = len(scenario.aims)
    time = np.arange(ticks) / RATE
    states = np.zeros((ticks, 1, 2, 2))
    for k, at in enumerate(time):
        states[k, 0, 0] = limb.branches(*path(at))[0]
    nothing = np.zeros((ticks, 1, 2))
    return LimbTrace(
        chain=limb.chain,
        time=time,
        aims=scenario.aims,
        sensed=states,
        true=states.copy(),
        commanded=nothing,
        applied=nothing.copy(),
        wrenches=np.zeros((ticks, 1, 6)),
        reports=np.zeros((ticks, 1), REPORT),
    )


def measured(trace: LimbTrace, scenario: Scenario, limb: BenchLimb = LIMB) -> Measures:
    return measure(Run(ENTRY, trace, 0.0), scenario, limb)


@pytest.mark.parametrize(("grown", "behind"), [(0.02, 0.1), (-0.03, -0.05), (0.0, 0.0)])
def test_a_larger_circle_that_comes_late_is_off_by_its_radius_and_its_angle(grown: float, behind: float) -> None:
    limb = bench_limb(start=(0.27, 0.0))
    scenario = circle_scenario(limb, RATE, lap=3.0)
    size = 0.05 * (1.0 + grown)

    def path(at: float) -> tuple[float, float]:
        angle = math.tau * at / 3.0 - behind
        return 0.22 + size * math.cos(angle), size * math.sin(angle)

    told = measured(trace_of(limb, scenario, path), scenario, limb).true
    assert told.radial_rms == pytest.approx(abs(grown) * 0.05, abs=1e-12)
    assert told.radial_max == pytest.approx(abs(grown) * 0.05, abs=1e-12)
    assert told.lag == pytest.approx(behind, abs=1e-9)


@pytest.mark.parametrize("damping", [0.3, 0.5, 0.7])
def test_a_second_order_step_overshoots_and_settles_as_its_closed_form_says(damping: float) -> None:
    scenario = step_scenario(LIMB, RATE, seconds=6.0)
    natural = 12.0
    beaten = natural * math.sqrt(1.0 - damping**2)

    def part(at: float) -> float:
        decay = math.exp(-damping * natural * at)
        return 1.0 - decay * (math.cos(beaten * at) + damping * natural / beaten * math.sin(beaten * at))

    told = measured(trace_of(LIMB, scenario, lambda at: (0.22, -0.02 * part(at))), scenario).true
    assert told.overshoot == pytest.approx(math.exp(-math.pi * damping / math.sqrt(1.0 - damping**2)), abs=2e-3)
    fine = np.arange(0.0, 6.0, 1e-4)
    off = np.abs([1.0 - part(at) for at in fine])
    assert told.settling == pytest.approx(fine[np.flatnonzero(off > 0.02)[-1]], abs=1.5 / RATE)
    assert told.on_aim == pytest.approx(told.settling, abs=1.5 / RATE)
    assert told.across_max == pytest.approx(0.0, abs=1e-12)
    assert told.rest == pytest.approx(0.0, abs=1e-9)


def test_a_step_that_rests_short_settles_but_never_on_its_aim() -> None:
    scenario = step_scenario(LIMB, RATE, seconds=6.0)
    told = measured(trace_of(LIMB, scenario, lambda at: (0.22, -0.018 * (1.0 - math.exp(-10.0 * at)))), scenario).true
    assert told.on_aim == NEVER
    assert told.settling == pytest.approx(math.log(0.018 / (0.02 * 0.02)) / 10.0, abs=1.5 / RATE)
    assert told.rest == pytest.approx(0.002, abs=1e-9)
    assert "on_aim" in told.to_json() and told.to_json()["on_aim"] is None


def test_a_limit_cycle_is_twice_its_amplitude_and_never_settles() -> None:
    scenario = step_scenario(LIMB, RATE, seconds=6.0)
    swing = 0.003
    trace = trace_of(LIMB, scenario, lambda at: (0.22 + swing * math.sin(40.0 * at), -0.02))
    told = measured(trace, scenario)
    assert told.true.cycle == pytest.approx(2 * swing, rel=1e-2)
    assert told.true.settling == NEVER
    assert told.true.across_rms == pytest.approx(swing / math.sqrt(2), rel=1e-2)
    assert told.unstable_at is None


def test_swings_that_grow_past_the_step_are_unstable_from_when_they_stay_there() -> None:
    scenario = step_scenario(LIMB, RATE, seconds=6.0)

    def path(at: float) -> tuple[float, float]:
        return 0.22, -0.02 + min(0.05, 0.001 * math.exp(1.2 * at)) * math.sin(40.0 * at)

    at = instability(trace_of(LIMB, scenario, path), scenario)
    passes = math.log(0.01 / 0.001) / 1.2  # where peak to peak is 20 mm
    assert at is not None and passes - 6.0 / 8 <= at <= passes + 6.0 / 8
    shrinking = trace_of(LIMB, scenario, lambda at: (0.22, -0.02 + 0.05 * math.exp(-at) * math.sin(40.0 * at)))
    assert instability(shrinking, scenario) is None


def test_a_joint_far_beyond_its_limits_or_a_number_that_is_none_is_unstable_then() -> None:
    scenario = step_scenario(LIMB, RATE, seconds=2.0)
    gone = trace_of(LIMB, scenario, lambda at: (0.22, -0.02))
    gone.true[100:, 0, 0, 1] = LIMB.chain.joints["upper"][1] + math.radians(21.0)
    assert instability(gone, scenario) == pytest.approx(100 / RATE)
    lost = trace_of(LIMB, scenario, lambda at: (0.22, -0.02))
    lost.true[50:] = np.nan
    told = measured(lost, scenario)
    assert told.unstable_at == pytest.approx(50 / RATE)
    assert told.true.to_json() == {}


def test_work_is_torque_times_turn_and_heat_that_of_the_currents() -> None:
    scenario = step_scenario(LIMB, RATE, seconds=2.0)
    trace = trace_of(LIMB, scenario, lambda at: (0.22, -0.01 * at))
    trace.applied[:, 0] = (2.0, -3.0)
    turned = np.abs(np.diff(trace.true[:, 0, 0], axis=0)).sum(axis=0)
    told = measured(trace, scenario)
    assert told.work == pytest.approx(2.0 * turned[0] + 3.0 * turned[1])
    motor = LIMB.robot.motor
    currents = np.array((2.0, -3.0)) / (np.array((574.0, 792.0)) * motor.torque_constant)
    assert told.heat == pytest.approx((currents**2).sum() * motor.resistance * 2.0)
    assert told.saturated == 1.0  # what is applied is not what was commanded


def test_what_is_lost_to_friction_in_a_circle_is_less_than_the_motors_work() -> None:
    limb = bench_limb(start=(0.27, 0.0))
    flaws = LimbFlaws()
    scenario = circle_scenario(limb, flaws.control_rate, lap=3.0, laps=1)
    (run,) = run_contest(limb, scenario, [ENTRY], flaws)
    speeds = run.trace.true[:, 0, 1]
    joints = limb.chain.joints
    lost = ((joints["damping"] * speeds**2 + joints["friction"] * np.abs(speeds)).sum(axis=1)).sum() * flaws.period
    told = measure(run, scenario, limb)
    assert lost < told.work * 1.01
    assert told.work < 1.6 * lost  # the rest speeds the limb up and brakes it


def test_encoders_and_truth_differ_by_no_more_than_half_of_the_play() -> None:
    flaws = LimbFlaws(backlash=math.radians(2.0), seed=3)
    scenario = push_scenario(LIMB, flaws.control_rate, seconds=2.5)
    (run,) = run_contest(LIMB, scenario, [ENTRY], flaws)
    gap = np.abs(run.trace.true[:, 0, 0] - run.trace.sensed[:, 0, 0])
    assert gap[0] == pytest.approx(math.radians(1.0), rel=1e-9)
    # the ends of the play are stiff springs: the hit of a link on them gives more, for a tick or two
    pressed = (run.trace.time > 1.0) & (run.trace.time < 2.0)
    assert gap[pressed].max() < math.radians(1.02)
    assert gap[pressed, 1].min() > math.radians(0.99)  # the elbow carries the push


def test_a_push_yields_by_the_force_over_the_stiffness_without_friction() -> None:
    flaws = LimbFlaws(friction=0.0)
    scenario = push_scenario(LIMB, flaws.control_rate, force=(0.0, 5.0), end=4.0, seconds=8.0)
    from clamber.limb_bench.entries import tip_stiffness

    (run,) = run_contest(LIMB, scenario, [ENTRY], flaws)
    rest = run.trace.true_places()[run.trace.time < 4.0][-1, 0, :2] - np.array(LIMB.start)
    expected = np.linalg.solve(tip_stiffness(LIMB.chain, ENTRY.settings, LIMB.q0), (0.0, 5.0))
    # the stiffness is that of the start, the displacement 6 mm
    np.testing.assert_allclose(rest, expected, rtol=0.05, atol=1e-4)
    told = measure(run, scenario, LIMB)
    assert told.true.along_max == pytest.approx(expected[1], rel=0.1)
    assert told.true.rest == pytest.approx(0.0, abs=1e-5)
