"""Comparisons as values: the same for the same seed, told whole, on perfect and imperfect plants."""

import csv
import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from clamber.control.controller import Controller, MeasurementError
from clamber.control.law_settings import LAWS, LawSettings
from clamber.errors import UnknownNameError
from clamber.execution.closed_loop import close_loop
from clamber.limb_bench.bench_limb import bench_limb
from clamber.limb_bench.entries import make_entries
from clamber.limb_bench.measures import Entry
from clamber.limb_bench.result import LimbResult, Matching, compare_laws, error_line
from clamber.limb_bench.runner import Contest, run_contest
from clamber.limb_bench.scenario import ScenarioError, circle_scenario, push_scenario, step_scenario
from clamber.sim.limb_flaws import LimbFlaws
from clamber.sim.plants import PLANTS

LIMB = bench_limb()
REFERENCE = LawSettings(law="scct", kp=100.0, kd=10.0)
NOMINAL = LimbFlaws(backlash=math.radians(2.0), encoder_counts=400, delay=1)
STEP = step_scenario(LIMB, 200.0, seconds=1.0)


def compare(flaws: LimbFlaws, *texts: str, trials: int = 1) -> LimbResult:
    entries = make_entries(LIMB, texts, REFERENCE, "yy", LIMB.q0)
    return compare_laws(Contest(LIMB, STEP, entries, flaws), trials=trials, matching=Matching(REFERENCE, "yy", LIMB.q0))


def without_ticks(told: Any) -> Any:
    """All but what depends on the machine."""
    if isinstance(told, dict):
        return {key: without_ticks(value) for key, value in told.items() if key != "tick"}
    return [without_ticks(value) for value in told] if isinstance(told, list) else told


def test_the_same_seed_gives_the_same_bytes_and_another_does_not() -> None:
    told = []
    for seed in (3, 3, 4):
        flaws = NOMINAL.with_changes(seed=seed, speed_noise=0.01, model_error=0.1)
        laws = compare(flaws, "scct", "jacobian-transpose", trials=2).to_json()["laws"]
        told.append(json.dumps(without_ticks(laws)))
    assert told[0] == told[1] != told[2]


def test_trials_are_those_of_single_seeds_with_their_mean_and_worst() -> None:
    both = compare(NOMINAL.with_changes(seed=7), "scct", trials=2).to_json()["laws"][0]
    alone = [compare(NOMINAL.with_changes(seed=seed), "scct").to_json()["laws"][0]["trials"][0] for seed in (7, 8)]
    assert without_ticks(both["trials"]) == without_ticks(alone)
    rms = [each["true"]["across_rms"] for each in alone]
    assert both["mean"]["true"]["across_rms"] == pytest.approx(sum(rms) / 2)
    assert both["worst"]["true"]["across_rms"] == max(rms)


def test_scct_and_resolved_rate_by_inertia_are_one_law_in_closed_loop() -> None:
    laws = compare(NOMINAL, "scct", "resolved-rate:weight=inertia").to_json()["laws"]
    for key, value in laws[0]["trials"][0]["true"].items():
        other = laws[1]["trials"][0]["true"][key]
        assert other == (value if value is None else pytest.approx(value, rel=1e-6, abs=1e-9))


def test_an_unstable_law_is_told_and_the_others_go_on() -> None:
    result = compare(LimbFlaws(delay=6), "scct:kp=4000,kd=0", "scct")
    first, second = result.to_json()["laws"]
    assert first["unstable_trials"] == 1
    assert first["trials"][0]["unstable_at"] is not None
    assert second["unstable_trials"] == 0
    assert result.stable
    assert not compare(LimbFlaws(delay=6), "scct:kp=4000,kd=0").stable


class Breaking:
    """A plant whose sensors give up at a tick."""

    def __init__(self, plant: Any, tick: int) -> None:
        self._plant, self._tick = plant, tick
        self.period, self.batch = plant.period, plant.batch
        self.reset, self.actuate, self.step, self.truth = plant.reset, plant.actuate, plant.step, plant.truth

    def sense(self) -> Any:
        sensed = self._plant.sense()
        if self._plant.tick >= self._tick:
            sensed.states[:] = np.nan
        return sensed


def test_a_loop_that_loses_its_numbers_keeps_what_was_and_raises_unless_told() -> None:
    plant = Breaking(PLANTS["mujoco"](LIMB.chain, LimbFlaws(), gears=LIMB.gears), 30)
    controller = Controller(LIMB.chain, REFERENCE, period=0.005)
    plant.reset(LIMB.q0)
    trace = close_loop(plant, controller, STEP.aims, keep=True)  # type: ignore[arg-type]
    assert np.isfinite(trace.true[:30]).all() and np.isnan(trace.true[30:]).all()
    plant.reset(LIMB.q0)
    with pytest.raises(MeasurementError):
        close_loop(plant, controller, STEP.aims)  # type: ignore[arg-type]


def test_matching_by_diagonal_tells_who_has_one_gain_only() -> None:
    entries = make_entries(LIMB, ["scct", "joint-pd", "jacobian-transpose"], REFERENCE, "diagonal", LIMB.q0)
    result = compare_laws(Contest(LIMB, STEP, entries, LimbFlaws()), matching=Matching(REFERENCE, "diagonal"))
    assert result.matching.not_matched == ("joint-pd",)
    assert "diagonal" in result.match_words()
    assert compare(LimbFlaws(), "scct", "joint-pd").matching.not_matched == ()


@pytest.mark.parametrize("law", LAWS)
def test_every_law_runs_in_every_scenario_and_tells_finite_measures(law: str) -> None:
    circle_limb = bench_limb(start=(0.27, 0.0))
    for limb, scenario in (
        (LIMB, STEP),
        (circle_limb, circle_scenario(circle_limb, 200.0, lap=1.0)),
        (LIMB, push_scenario(LIMB, 200.0, start=0.1, end=0.4, seconds=1.0)),
    ):
        entries = make_entries(limb, [law], REFERENCE, "yy", limb.q0)
        result = compare_laws(Contest(limb, scenario, entries, LimbFlaws()), matching=Matching(REFERENCE, "yy"))
        text = json.dumps(result.to_json(), allow_nan=False)
        assert f'"{law}"' in text
        assert np.isfinite(error_line(result.rows[0].run, scenario, result.shown_until()).error).all()


def test_a_plot_ends_a_while_after_the_last_law_settled_and_never_before_a_wild_one() -> None:
    scenario = step_scenario(LIMB, 200.0, seconds=6.0)
    calm = compare_laws(Contest(LIMB, scenario, [Entry("scct", REFERENCE)], LimbFlaws()))
    assert calm.shown_until() == pytest.approx(1.0)
    line = error_line(calm.rows[0].run, scenario, calm.shown_until())
    assert len(line.error) == 200
    wild = compare_laws(
        Contest(LIMB, scenario, [Entry("wild", LawSettings(law="scct", kp=600.0, kd=2.0))], LimbFlaws(delay=1))
    )
    assert wild.shown_until() == 6.0


def test_three_ticks_are_enough_to_be_measured() -> None:
    result = compare_laws(
        Contest(LIMB, step_scenario(LIMB, 200.0, seconds=0.015), [Entry("scct", REFERENCE)], LimbFlaws())
    )
    told = result.to_json()["laws"][0]["trials"][0]
    assert told["unstable_at"] is None
    assert told["true"]["rest"] == pytest.approx(0.02, rel=0.1)  # it has hardly begun


def test_csv_has_a_line_for_each_trial_and_an_empty_field_for_never(tmp_path: Path) -> None:
    result = compare(NOMINAL.with_changes(seed=0), "scct", "jacobian-transpose", trials=2)
    result.save_table(tmp_path / "laws.csv")
    lines = list(csv.DictReader((tmp_path / "laws.csv").read_text().splitlines()))
    assert [(line["law"], line["trial"]) for line in lines] == [
        ("scct", "0"),
        ("scct", "1"),
        ("jacobian-transpose", "0"),
        ("jacobian-transpose", "1"),
    ]
    told = result.to_json()["laws"][0]["trials"][0]
    assert float(lines[0]["true.across_max"]) == told["true"]["across_max"]
    assert lines[0]["true.on_aim"] == "" and told["true"]["on_aim"] is None


def test_a_circle_beyond_the_printed_limits_of_the_elbow_is_told() -> None:
    limb = bench_limb(start=(0.27, 0.0))
    scenario = circle_scenario(limb, 200.0, lap=3.0, laps=1)
    entries = [Entry("scct", REFERENCE)]
    over = compare_laws(Contest(limb, scenario, entries, LimbFlaws())).beyond_limits()
    assert set(over) == {"right elbow"}
    assert 4.0 < math.degrees(over["right elbow"]) < 8.0  # the circle itself asks for 5.6 deg
    assert compare(LimbFlaws(), "scct").beyond_limits() == {}


def test_what_cannot_be_asked_for_is_named() -> None:
    with pytest.raises(UnknownNameError, match="plant"):
        run_contest(LIMB, STEP, [Entry("scct", REFERENCE)], LimbFlaws(), plant="mojuco")
    with pytest.raises(ScenarioError, match="more than 2 control periods"):
        step_scenario(LIMB, 200.0, seconds=0.01)
    with pytest.raises(ScenarioError, match=r"step: target = \(0.42, 0\) m: must be"):
        step_scenario(LIMB, 200.0, dx=0.2, dy=0.0)
    with pytest.raises(ScenarioError, match="radius"):
        circle_scenario(LIMB, 200.0, radius=-0.05)
