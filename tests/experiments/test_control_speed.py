"""The benchmark of control measures what it says; how fast, only the benchmark itself tells."""

import math
from dataclasses import replace

import numpy as np
import pytest

from clamber.benchmarks import control_speed
from clamber.benchmarks.benches import BENCHES
from clamber.control.controller import Controller
from clamber.control.law_settings import LAWS
from clamber.execution.closed_loop import close_loop
from clamber.limb_bench.bench_limb import bench_limb
from clamber.limb_bench.scenario import step_scenario
from clamber.sim.bench_limb import BenchLimb
from clamber.sim.limb_flaws import LimbFlaws
from clamber.sim.mujoco_limb import MujocoLimb
from clamber.sim.raw_steps import RawSteps


@pytest.fixture(scope="module")
def leg() -> BenchLimb:
    return bench_limb()


def test_the_benchmark_is_found_by_its_name() -> None:
    assert BENCHES["control"] is control_speed.control_rows


def test_every_law_has_a_row_alone_and_in_a_batch() -> None:
    rows = control_speed.tick_rows(rounds=1, ticks=20, batch=10)
    for law in LAWS:
        mine = [row for row in rows if row.name.startswith(f"tick of {law},")]
        assert [row.aim for row in mine] == ["< 5", "< 1"]
        assert all(row.value > 0.0 and row.unit == "us" for row in mine)


@pytest.mark.parametrize("peer", control_speed.IK_PEERS)
def test_a_peer_finds_the_same_motion_as_the_inverse_of_our_jacobian(peer: str, leg: BenchLimb) -> None:
    if not control_speed.installed(peer):
        pytest.skip(f"{peer} comes with the extra `bench`")
    tick, _ = control_speed.IK_PEERS[peer](leg.chain)
    # Their error is a screw: it is the plain difference where the tip's frame is parallel to the base, to first order in the way to go
    for shoulder in (-0.6, -0.2, 0.5):
        q = np.array((shoulder, np.pi / 2 - shoulder))
        error = np.array((1e-6, -2e-6))
        speeds = np.linalg.solve(leg.chain.jacobian(q)[:2], error) / control_speed.PERIOD
        place = leg.chain.place(q) + np.array((*error, 0.0))
        np.testing.assert_allclose(tick(q, place), speeds, rtol=1e-4, atol=1e-6)


def test_a_missing_peer_is_a_row_without_a_value(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(control_speed, "installed", lambda peer: False)
    rows = control_speed.peer_rows()
    assert len(rows) == len(control_speed.IK_PEERS)
    assert all(math.isnan(row.value) and "not installed" in row.name for row in rows)


@pytest.mark.parametrize("loop", control_speed.loops_timed(limbs=3), ids=lambda loop: loop.label)
def test_the_raw_steps_are_those_of_the_closed_loop(loop: control_speed.Loop, leg: BenchLimb) -> None:
    """Same model, same steps, same torques: the limb ends where it did in the loop, to the last bit."""
    flaws = replace(loop.flaws, push=None)
    aims = step_scenario(leg, flaws.control_rate, seconds=0.25).aims
    controller = Controller(leg.chain, control_speed.law_named("scct"), period=flaws.period, batch=loop.batch)
    plant = MujocoLimb(leg.chain, flaws, gears=leg.gears, batch=loop.batch)
    plant.reset(leg.q0)
    applied = close_loop(plant, controller, aims).applied
    end = RawSteps(plant.model, flaws.steps, applied, leg.q0).run()
    stride = end.shape[1] // leg.chain.n
    places = sum(end[:, k::stride] for k in range(stride))
    assert np.array_equal(places, plant.truth().states[:, 0])


def test_a_loop_has_its_ratio_and_its_steps() -> None:
    loops = (control_speed.Loop("one", LimbFlaws()), control_speed.Loop("three", LimbFlaws(), 3))
    rows = control_speed.loop_rows(loops=loops, rounds=1, seconds=0.8)
    assert [row.unit for row in rows] == ["ratio", "us", "ratio", "us", "us"]
    assert all(row.value > 0.0 for row in rows)


def test_works_take_turns_in_rounds_after_a_first_that_is_not_timed() -> None:
    said: list[str] = []
    ticks = iter(range(100))
    times = control_speed.round_times(
        [lambda: said.append("a"), lambda: said.append("b")], 3, clock=lambda: float(next(ticks))
    )
    assert said == ["a", "b"] * 4
    assert times.tolist() == [[1.0, 1.0]] * 3
