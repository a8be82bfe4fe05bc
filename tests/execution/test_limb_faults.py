"""A limb on the bench with a fault: its loop bridges what it can, holds the posture where it cannot, and never raises."""

import math

import numpy as np
import pytest

from clamber.control.controller import Controller, MeasurementError
from clamber.control.law_settings import LawSettings
from clamber.execution.closed_loop import LimbGuard, close_loop
from clamber.execution.fault import FAULTS, Fault, Injector
from clamber.execution.faulty_plants import OwnHold, step_on
from clamber.execution.plant import LimbPlant, Sensed, Truth
from clamber.execution.trace import LimbTrace
from clamber.limb_bench.bench_limb import bench_limb
from clamber.limb_bench.scenario import circle_scenario
from clamber.sim.limb_flaws import LimbFlaws
from clamber.sim.plants import PLANTS
from clamber.types import Floats

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


class FaultyLimb:
    """A limb with a fault; a `LimbPlant` with a batch of one.

    Args:
        plant: What moves.
        fault: Channels are its joints.
        inertias: As in `FaultyBody`.
    """

    batch: int = 1

    def __init__(self, plant: LimbPlant, fault: Fault, inertias: Floats) -> None:
        assert plant.batch == 1
        self.plant, self.period = plant, plant.period
        self._injector, self._own = Injector(fault, plant.period), OwnHold(inertias)
        self._states = np.zeros((2, len(inertias)))
        n = plant.truth().torques.shape[1]
        self._told = Sensed(np.zeros((1, 2, n)), np.zeros((1, 6)), np.zeros((1, 6)))
        self._torques = np.zeros(n)

    def reset(self, q: Floats) -> None:
        """See `LimbPlant`."""
        self.plant.reset(q)
        self._injector.reset()
        self._own.reset()
        self._torques[:] = self._states[:] = 0.0

    def sense(self) -> Sensed:
        """See `LimbPlant`."""
        sensed, injector, told = self.plant.sense(), self._injector, self._told
        told.wrenches[:], told.mounts[:] = sensed.wrenches, sensed.mounts
        states, number, at = sensed.states[0], int(sensed.number[0]), injector.fault.channel
        self._states[:] = states
        if injector.fault.target == "sensor":
            told.states[0], told.number[0] = states, number
            told.states[0, 0], _ = injector.read(states[0], number)
            told.states[0, 1, at] = injector.speed(float(told.states[0, 0, at]), float(states[1, at]))
        else:
            packet, told.number[0] = injector.read(states.ravel(), number)
            told.states[0] = packet.reshape(2, -1)
        return told

    def actuate(self, torques: Floats) -> None:
        """See `LimbPlant`."""
        arrived = self._injector.command(np.ravel(torques))
        if arrived is not None:
            self._torques[:] = arrived

    def step(self) -> None:
        """See `LimbPlant`."""
        torques = self._own.torques(self._torques, *self._states) if self._injector.silent else self._torques
        self.plant.actuate(self._injector.weaken(torques.copy(), np.zeros(len(torques)))[None])
        step_on(self.plant, self._injector.passed())

    def truth(self) -> Truth:
        """See `LimbPlant`."""
        return self.plant.truth()


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
