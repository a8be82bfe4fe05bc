"""The closed loop writes down what a loop by hand sees, and the recorder copies rows and nothing else."""

import copy
import pickle

import numpy as np
import pytest

from clamber.control.controller import Controller, still_aim
from clamber.control.law_settings import LawSettings
from clamber.execution.closed_loop import Recorder, close_loop
from clamber.limb_bench.bench_limb import bench_limb
from clamber.sim.limb_flaws import LimbFlaws, Push
from clamber.sim.plants import PLANTS


@pytest.mark.parametrize("name", PLANTS)
@pytest.mark.parametrize("batch", [1, 3])
def test_the_trace_is_what_a_loop_by_hand_sees(name: str, batch: int) -> None:
    leg = bench_limb()
    flaws = LimbFlaws(encoder_counts=400, delay=2, push=Push(x=4.0, y=1.0, start=0.05, end=0.1))
    aims = np.stack([still_aim((0.22, -0.02))] * 50)
    plant = PLANTS[name](leg.chain, flaws, gears=leg.gears, batch=batch)
    controller = Controller(leg.chain, LawSettings(law="implicit-admittance"), period=flaws.period, batch=batch)
    plant.reset(leg.q0)
    trace = close_loop(plant, controller, aims)
    plant.reset(leg.q0)
    controller.reset()
    for k in range(50):
        assert np.array_equal(trace.true[k], plant.truth().states)
        sensed = plant.sense()
        assert np.array_equal(trace.sensed[k], sensed.states)
        torques = controller.command(aims[k], sensed.states, sensed.wrenches)
        assert np.array_equal(trace.commanded[k], torques)
        assert np.array_equal(trace.reports[k], controller.reports)
        plant.actuate(torques)
        plant.step()
        assert np.array_equal(trace.applied[k], plant.truth().torques)
        assert np.array_equal(trace.wrenches[k], plant.truth().wrenches)
        assert np.array_equal(trace.true_places()[k, 0], leg.chain.place(trace.true[k, 0, 0]))
        assert np.array_equal(trace.sensed_places()[k, -1], leg.chain.place(trace.sensed[k, -1, 0]))
    assert trace.wrenches.any() and trace.reports["place"].any()


def test_a_recorder_fills_one_row_of_each_array() -> None:
    rows, marks = np.zeros((4, 2, 3)), np.zeros((4, 5), np.int32)
    source, mark = np.arange(6.0).reshape(2, 3), np.arange(5, dtype=np.int32)
    recorder = Recorder(((rows, source), (marks, mark)))
    recorder.note(2)
    source += 10.0
    assert np.array_equal(rows[2], np.arange(6.0).reshape(2, 3)) and not rows[[0, 1, 3]].any()
    assert np.array_equal(marks[2], mark) and not marks[[0, 1, 3]].any()


@pytest.mark.parametrize("tick", [-1, 4])
def test_a_recorder_writes_nowhere_but_in_its_rows(tick: int) -> None:
    with pytest.raises(AssertionError):
        Recorder(((np.zeros((4, 2)), np.zeros(2)),)).note(tick)


def test_a_recorder_takes_only_what_fits() -> None:
    with pytest.raises(AssertionError):
        Recorder(((np.zeros((4, 2)), np.zeros(3)),))
    with pytest.raises(AssertionError):
        Recorder(((np.zeros((4, 2)), np.zeros(4)[::2]),))


def test_a_controller_is_not_copied_with_the_addresses_of_another() -> None:
    controller = Controller(bench_limb().chain, LawSettings(law="scct"), period=0.005)
    for attempt in (copy.deepcopy, pickle.dumps):
        with pytest.raises(TypeError, match="copy its chain and settings"):
            attempt(controller)
