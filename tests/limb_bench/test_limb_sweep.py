"""Sweeps of laws: each point a run, boundaries between a stable and an unstable run, mistakes named."""

import csv
from dataclasses import asdict, fields, replace
from pathlib import Path
from typing import Any

import pytest

from clamber.cli.limb.options import LawWords, NominalLimbWords
from clamber.cli.limb.sweep import CommandWords, ScenarioChoice, make_bench
from clamber.errors import ClamberError, UnknownNameError
from clamber.limb_bench.measures import measure
from clamber.limb_bench.runner import Crew, run_contest
from clamber.limb_bench.sweep import LimbSweep, run_limb_sweep
from clamber.limb_bench.sweep_point import Bench, Cell, find_boundary, run_point, try_laws
from clamber.planning.axes import range_axis
from clamber.sim.limb_flaws import LimbFlaws
from clamber.sim.plant_rules import PlantError

STIFF = {"kp": "1000"}
TOO_STIFF = {"kp": "6000"}


def short_bench(**changes: object) -> Bench:
    said: dict[str, Any] = {"scenario": ScenarioChoice.step, "kp": 100.0, "kd": 4.0, "controllers": ["scct"]} | changes
    holders: list[Any] = [CommandWords, LawWords, NominalLimbWords]
    words = [
        holder(**{each.name: said.pop(each.name) for each in fields(holder) if each.name in said}) for holder in holders
    ]
    assert not said
    return make_bench(*words)


def told(bench: Bench) -> dict[str, object]:
    return asdict(bench) | {"start": list(bench.start), "laws": list(bench.laws)}


def test_a_cell_is_the_measure_of_the_same_run_without_its_rest() -> None:
    bench = short_bench(measure="iae")
    limb = bench.build_limb()
    flaws, entries = bench.build_point(limb, STIFF)
    scenario, ticks = bench.build_scenario(limb, flaws.control_rate)
    plain = replace(scenario, aims=scenario.aims[:ticks])
    (run,) = run_contest(limb, plain, entries, flaws)
    assert try_laws(bench, STIFF)["scct"].value == measure(run, plain, limb).true.iae


def test_a_law_is_steady_below_its_boundary_and_not_above() -> None:
    bench = short_bench()
    item = {"bench": told(bench), "varied": {}, "label": "scct", "key": "kp", "unit": "", "low": 1000.0, "high": 6000.0}
    at = find_boundary(item | {"steady": True, "precision": 100.0})["at"]
    # nearer than that a swing takes longer to grow, or to die out, than the aim stands still
    assert try_laws(bench, {"kp": f"{0.9 * at:.6g}"})["scct"].steady
    assert not try_laws(bench, {"kp": f"{1.1 * at:.6g}"})["scct"].steady


def test_kd_follows_kp_unless_it_varies_itself() -> None:
    bench = short_bench()
    limb = bench.build_limb()
    for varied, gains in (
        ({"kp": "200"}, (200.0, 8.0)),
        ({"kd": "9"}, (100.0, 9.0)),
        ({"kp": "200", "kd": "9"}, (200.0, 9.0)),
        ({"gain": "3"}, (300.0, 12.0)),
    ):
        (entry,) = bench.build_point(limb, varied)[1]
        assert (entry.settings.kp, entry.settings.kd) == pytest.approx(gains)


def test_what_varies_of_the_plant_is_read_with_its_unit() -> None:
    bench = short_bench()
    flaws, _ = bench.build_point(bench.build_limb(), {"backlash": "4 deg", "control_rate": "330 Hz"})
    assert flaws.backlash == pytest.approx(0.0698, abs=1e-4)
    assert flaws.physics_rate == pytest.approx(2310.0)


def test_the_winner_is_the_smallest_measure_of_the_steady_laws() -> None:
    cells = {
        "a": Cell(1.0, 0.0, False),
        "b": Cell(3.0, 0.0, True),
        "c": Cell(2.0, 0.0, True),
        "d": Cell(None, 0.0, True),
    }
    lost = {name: Cell(1.0, 1.0, False) for name in cells}
    axis = range_axis("kp=1..2:2")
    sweep = LimbSweep(
        bench=short_bench(), axes=(axis,), labels=tuple(cells), points=(cells, lost), boundaries=(), scan="kp"
    )
    assert [sweep.winner(k) for k in range(2)] == ["c", None]
    assert sweep.wins() == {"a": 0, "b": 0, "c": 1, "d": 0}


def test_a_point_travels_as_plain_data() -> None:
    bench = short_bench(scenario=ScenarioChoice.push)
    (label,) = out = run_point({"bench": told(bench), "varied": STIFF})
    assert label == "scct"
    assert Cell(**out[label]) == try_laws(bench, STIFF)["scct"]


@pytest.mark.parametrize(
    ("words", "error", "names"),
    [
        ({"measure": "radial_rms"}, UnknownNameError, "radial_rms"),
        ({"scenario": ScenarioChoice.circle, "measure": "across_max"}, UnknownNameError, "across_max"),
        ({"measure": "beauty"}, UnknownNameError, "beauty"),
        ({"settings": ["backlash=-2deg"]}, PlantError, "backlash"),
        ({"reference": "scct:kp=100/50", "kp": None}, ClamberError, "one number"),
    ],
)
def test_words_that_make_no_bench_are_named(words: dict[str, object], error: type[Exception], names: str) -> None:
    with pytest.raises(error, match=names):
        short_bench(**words)


@pytest.mark.parametrize(
    ("vary", "names"),
    [
        ("nothing=0..1:2", "nothing"),
        ("payload=-1kg..1kg:2", "payload"),
        ("delay=0.5..1.5:2", "delay"),
        ("kp=-5..5:3", "kp"),
        ("physics_rate=100Hz..2000Hz:2", "control_rate"),
    ],
)
def test_what_cannot_vary_is_named_before_anything_runs(vary: str, names: str) -> None:
    with pytest.raises(ClamberError, match=names):
        run_limb_sweep(short_bench(), [range_axis(vary)])


@pytest.mark.long
def test_a_sweep_finds_its_boundary_on_any_number_of_workers_and_resumes(tmp_path: Path) -> None:
    bench = short_bench(controllers=["scct", "jacobian-transpose"])
    axes = [range_axis("backlash=0deg..2deg:2"), range_axis("kp=1000..6000:3")]
    alone = run_limb_sweep(bench, axes, Crew(store=tmp_path / "points.db"))
    together = run_limb_sweep(bench, axes, Crew(workers=3))
    again = run_limb_sweep(bench, axes, Crew(store=tmp_path / "points.db", resume=True))
    assert alone.to_json() == together.to_json() == again.to_json()
    assert alone.scan == "kp"
    assert {(each.label, each.beside) for each in alone.boundaries} >= {("scct", 0.0), ("scct", 2.0)}
    for each in alone.boundaries:
        near = 0.1 * each.at
        there = {"backlash": f"{each.beside} deg"}
        below, above = (try_laws(bench, there | {"kp": f"{each.at + d:.6g}"})[each.label] for d in (-near, near))
        assert (below.steady, above.steady) == (each.steady_below, not each.steady_below)
    path = tmp_path / "sweep.csv"
    alone.save_table(path)
    with path.open() as file:
        lines = list(csv.DictReader(file))
    assert len(lines) == 2 * 3 * 2
    assert {line["law"] for line in lines} == {"scct", "jacobian-transpose"}


def test_flaws_of_a_bench_are_those_of_the_plant() -> None:
    assert LimbFlaws(**short_bench(settings=["payload=300g"]).flaws).payload == pytest.approx(0.3)
