from functools import cache
from pathlib import Path

import numpy as np
import pytest

from clamber.control.law_settings import LawSettings
from clamber.execution.log import Log
from clamber.execution.log_files import read_log, write_log
from clamber.execution.log_roles import samples_of
from clamber.execution.trace import trace_log
from clamber.families.climber.execution.log_identify import Identification, Known, identify_log
from clamber.limb_bench.bench_limb import bench_limb
from clamber.limb_bench.excitation import SensorNoise, record_log
from clamber.limb_bench.measures import Entry
from clamber.limb_bench.runner import run_contest
from clamber.limb_bench.scenario import ScenarioError, circle_scenario
from clamber.sim.limb_flaws import LimbFlaws
from clamber.units import DEGREE

PARAMETERS = ("inertia", "damping", "friction", "amplifier gain", "backlash")


@cache
def recorded(limb: str, seed: int, **flaws: float) -> Log:
    real = {"backlash": 2 * DEGREE, "encoder_counts": 400, "delay": 1} | flaws
    return record_log(bench_limb("libra", limb), LimbFlaws(**real), SensorNoise(seed=seed))  # type: ignore[arg-type]


def assert_within(found: Identification, part: float, **scales: float) -> None:
    """Every parameter of both joints is told, and within `part` of the file's, times a scale for those that were changed."""
    assert len(found.joints) == 2
    for joint in found.joints:
        for estimate in joint.estimates:
            if estimate.name not in PARAMETERS:
                continue
            assert estimate.value is not None, (joint.samples.name, estimate)
            assert estimate.stated is not None
            right = estimate.stated * scales.get(estimate.name, 1.0)
            assert estimate.value == pytest.approx(right, rel=part), (joint.samples.name, estimate.name)


@pytest.mark.slow
def test_every_parameter_of_a_limb_comes_within_five_percent_from_a_noisy_log() -> None:
    assert_within(identify_log(recorded("right", 0)), 0.05)


@pytest.mark.slow
def test_csv_and_mcap_files_give_the_same_numbers(tmp_path: Path) -> None:
    found = []
    for name in ("log.csv", "log.mcap"):
        write_log(recorded("right", 0), tmp_path / name)
        found.append(identify_log(read_log(tmp_path / name), joints=("right elbow",)).to_json()["joints"])
    assert found[0] == found[1] == identify_log(recorded("right", 0), joints=("right elbow",)).to_json()["joints"]


@pytest.mark.slow
def test_the_same_seed_gives_the_same_log() -> None:
    flaws = LimbFlaws(backlash=2 * DEGREE, encoder_counts=400, delay=1)
    first, second = recorded("right", 0), record_log(bench_limb("libra", "right"), flaws, SensorNoise(seed=0))
    for name in first.columns:
        np.testing.assert_array_equal(first.columns[name], second.columns[name])


def test_links_are_taken_off_only_where_a_robot_is_named() -> None:
    log = recorded("right", 0)
    bare = Log(log.columns, log.units, {}, "bare")
    known = Known(torque_constant=0.0138, gear=574.0)
    alone = identify_log(bare, joints=("right shoulder",), known=known)
    named = identify_log(log, joints=("right shoulder",))
    assert any("includes the links'" in note for note in alone.notes)
    more, less = (found.joints[0].estimates[0].value for found in (alone, named))
    assert more is not None and less is not None
    chain = bench_limb("libra", "right").chain
    links = [chain.inertia((0.0, bend))[0, 0] - chain.joints["rotor"][0] for bend in (0.0, 1.9)]
    assert 0.2 * min(links) < more - less < 1.2 * max(links)


def test_an_encoder_alone_tells_no_play_and_a_voltage_alone_no_gain() -> None:
    log = recorded("right", 0)
    kept = {name: values for name, values in log.columns.items() if "output" not in name and "current" not in name}
    found = identify_log(Log(kept, {name: log.units[name] for name in kept}, log.notes, "less"))
    for joint in found.joints:
        told = {estimate.name: estimate for estimate in joint.estimates}
        assert told["amplifier gain"].value is None
        assert told["backlash"].value is None
        assert "taken as given" in joint.torque_from
        assert told["inertia"].difference == pytest.approx(0.0, abs=0.05)


def test_a_recorded_log_keeps_within_the_joints_limits_and_stalls_at_one() -> None:
    chain = bench_limb("libra", "right").chain
    for joint, record in zip(samples_of(recorded("right", 0)).joints, chain.joints, strict=True):
        assert joint.angle.min() > record["lower"] - 0.01
        assert abs(joint.angle.max() - record["upper"]) < 0.02


def test_noise_that_cannot_be_is_refused() -> None:
    with pytest.raises(ScenarioError, match=r"noise.current = -1.0: must be 0 or more"):
        SensorNoise(current=-1.0)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("limb", ["right", "left", "bottom"])
def test_all_six_joints_come_within_five_percent_whatever_the_seed(limb: str, seed: int) -> None:
    assert_within(identify_log(recorded(limb, seed), seed=seed), 0.05)


@pytest.mark.slow
@pytest.mark.parametrize("limb", ["right", "left", "bottom"])
def test_a_limb_that_is_not_as_its_file_says_is_told_as_it_is(limb: str) -> None:
    log = recorded(limb, 11, friction=1.5, damping=0.7, backlash=1 * DEGREE)
    assert_within(identify_log(log), 0.05, friction=1.5, damping=0.7, backlash=0.5)


def test_a_stated_torque_constant_keeps_the_robots_gear_and_scales_what_torques_give() -> None:
    log = recorded("right", 0)
    once, twice = (
        identify_log(log, joints=("right shoulder",), known=Known(torque_constant=constant)).joints[0]
        for constant in (0.0138, 0.0276)
    )
    assert once.torque is not None and twice.torque is not None
    np.testing.assert_allclose(twice.torque, 2 * once.torque, rtol=1e-12)
    assert once.estimates[1].difference == pytest.approx(0.0, abs=0.05)


@pytest.mark.slow
def test_weight_is_taken_off_an_upright_limb_and_noticed_where_it_is_not() -> None:
    limb = bench_limb("libra", "left", upright=True)
    log = record_log(limb, LimbFlaws(backlash=2 * DEGREE, encoder_counts=400, upright=True))
    assert_within(identify_log(log), 0.05)
    assert not any("pulled one way" in note for note in identify_log(log).notes)
    unsaid = Log(log.columns, log.units, {"robot": "libra", "limb": "left"}, "log")
    assert any("left shoulder is pulled one way" in note for note in identify_log(unsaid).notes)


def test_a_run_of_the_bench_is_identified_as_it_was_logged() -> None:
    limb = bench_limb(start=(0.27, 0.0))
    scenario = circle_scenario(limb, 200.0, lap=3.0, laps=3)
    entries = [Entry("scct", LawSettings(law="scct", kp=200.0, kd=10.0))]
    trace = run_contest(limb, scenario, entries, LimbFlaws(encoder_counts=400))[0].trace
    found = identify_log(trace_log(trace, notes={"robot": "libra", "limb": "right"}))
    for joint in found.joints:
        for estimate in joint.estimates[:3]:
            assert estimate.difference == pytest.approx(0.0, abs=0.05), (joint.samples.name, estimate)
