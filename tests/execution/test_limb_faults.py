"""A limb on the bench with a fault: its loop bridges what it can, holds the posture where it cannot, and never raises."""

import math

import numpy as np
import pytest

from clamber.control.controller import Controller, MeasurementError
from clamber.control.law_settings import LawSettings
from clamber.execution.closed_loop import LimbGuard, close_loop
from clamber.execution.fault import FAULTS, Fault
from clamber.execution.faulty_plants import FaultyLimb
from clamber.execution.trace import LimbTrace
from clamber.limb_bench.bench_limb import bench_limb
from clamber.limb_bench.scenario import circle_scenario
from clamber.sim.limb_flaws import LimbFlaws
from clamber.sim.plants import PLANTS

FLAWS = LimbFlaws(encoder_counts=400, delay=1, seed=3)
START = 1.0
"""Of every fault [s]."""
SIZES = {
    "nan": 9.0,
    "spikes": math.radians(20.0),
    "drift": 0.2,
    "weak": 0.5,
    "lost": 1.0,
    "late": 6.0,
    "repeated": 0.3,
    "jitter": 0.2,
}


def circled(name: str, fault: Fault | None, *, guarded: bool = True) -> tuple[LimbTrace, LimbGuard]:
    leg = bench_limb(start=(0.25, 0.0))
    plant = PLANTS[name](leg.chain, FLAWS, gears=leg.gears)
    scenario = circle_scenario(leg, FLAWS.control_rate, radius=0.03, lap=3.0, laps=2)
    controller = Controller(leg.chain, LawSettings(law="scct", kp=100.0), period=FLAWS.period)
    guard = LimbGuard(leg.chain, FLAWS.period)
    plant.reset(leg.q0)
    driven = plant if fault is None else FaultyLimb(plant, fault, leg.chain.joints["rotor"].copy())
    driven.reset(leg.q0)
    return close_loop(driven, controller, scenario.aims, guard=guard if guarded else None), guard


def fault_of(kind: str) -> Fault:
    return Fault(kind=kind, start=START, size=SIZES.get(kind, 1.0), channel=0, where="shoulder", seed=4)


@pytest.mark.parametrize("name", PLANTS)
def test_without_a_fault_a_guarded_loop_is_the_loop_to_the_last_bit(name: str) -> None:
    (plain, _), (guarded, guard) = circled(name, None, guarded=False), circled(name, None)
    for key in ("true", "sensed", "commanded", "applied", "reports"):
        assert np.array_equal(getattr(plain, key), getattr(guarded, key)), key
    assert not guard.monitor.findings


@pytest.mark.parametrize("name", PLANTS)
@pytest.mark.parametrize("kind", [kind for kind, fault in FAULTS.items() if fault.target != "hold"])
def test_a_fault_ends_in_a_trace_to_the_end_and_is_told(name: str, kind: str) -> None:
    trace, guard = circled(name, fault_of(kind))
    assert np.isfinite(trace.true).all() and np.isfinite(trace.applied).all()
    speed = np.abs(trace.true[-40:, 0, 1]).max()
    if guard.held:
        assert speed < 0.3  # it holds, but for the joint that has failed
    found = guard.monitor.findings
    assert found or kind in ("weak", "drift", "dead", "stuck")
    assert all(finding.time >= START for finding in found)


@pytest.mark.parametrize("kind", ["dead", "stuck"])
def test_a_joint_that_does_not_answer_is_told_within_a_second_of_being_driven(kind: str) -> None:
    _, guard = circled("mujoco", fault_of(kind))
    (found,) = guard.monitor.findings
    assert found.kind in ("no answer", "overpowered")
    assert "shoulder" in found.where
    assert START < found.time < START + 1.5


def test_without_a_guard_the_error_is_the_old_one() -> None:
    with pytest.raises(MeasurementError):
        circled("ode", fault_of("nan"), guarded=False)
