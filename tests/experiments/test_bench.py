"""The benchmarks' adapters do what they say; how fast, only the benchmarks themselves tell."""

import json
import math
import platform
import random
from collections.abc import Callable, Generator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from clamber.benchmarks import batches, benches, peers, speed, starts
from clamber.benchmarks.batches import ScalingLaw
from clamber.benchmarks.planner_trials import ABLATION_TASKS, VARIANTS, bench_ablation, run_cases, run_trials, varied
from clamber.benchmarks.speed import PlainProblem, plain_module
from clamber.benchmarks.starts import performance_page
from clamber.execution.plant import PlantStoppedError
from clamber.jobs import LocalProcesses
from clamber.jobs.executor import End
from clamber.planning.genetic.evolve import weights_for
from clamber.planning.genetic.planner import plan_genetic
from clamber.planning.genetic.profile import load_profile
from clamber.planning.problem.problem import CompiledProblem
from clamber.planning.problem.problems import pose_problem
from clamber.tasks import load_task
from clamber.trials.measured import NOTHING, Crew, Row, median_or_nothing

NEAR = ("goal.y_min=12in",)
"""A goal two steps up: found at once."""


@pytest.fixture(scope="module")
def problem() -> CompiledProblem:
    return pose_problem(load_task("ladder", NEAR), threads=1).problem


def test_a_row_without_a_value_is_null_in_json() -> None:
    assert Row("x", NOTHING, "s").to_json() == {"name": "x", "value": None, "unit": "s", "aim": None}
    assert Row("x", 2.5, "s", "<= 3").to_json() == {"name": "x", "value": 2.5, "unit": "s", "aim": "<= 3"}


def test_a_failure_counts_as_slower_than_anything_in_a_median() -> None:
    assert median_or_nothing([1.0, None, 2.0]) == 2.0
    assert math.isnan(median_or_nothing([1.0, None, None]))
    assert math.isnan(median_or_nothing([]))


def test_every_benchmark_of_the_issue_is_there() -> None:
    assert {"plan", "seeds", "ablation", "jobs"} <= set(benches.BENCHES)


@pytest.mark.parametrize("variant", VARIANTS)
def test_every_variant_but_the_default_changes_the_profile(variant: str) -> None:
    default = load_profile("default")
    assert (varied(default, VARIANTS[variant]) == default) == (variant == "default")
    assert replace(varied(default, VARIANTS[variant]), search=default.search) == default


def test_the_plain_problem_tries_as_many_actions_as_the_kernels() -> None:
    module = plain_module()
    assert module is not None
    load = speed.evolved_load("ladder", generations=5, copies=1)
    plain = PlainProblem(load.task, load.table, module)
    few = load.few(40)
    tried = [plain.carry_out(few.table.spell(row[:n])) for row, n in zip(few.genes, few.lengths, strict=True)]
    compiled = few.problem(1)
    assert tried == few.run(compiled)["checks"].tolist()
    assert np.array_equal(few.run(plain), few.run(compiled))


def test_a_package_without_its_tests_has_no_plain_evaluator(tmp_path: Any) -> None:
    assert plain_module(tmp_path) is None


@pytest.mark.parametrize("peer", peers.PEERS)
def test_a_peer_is_given_our_fitness_and_its_count_is_true(peer: str, problem: CompiledProblem) -> None:
    if not peers.installed(peer):
        pytest.skip(f"{peer} comes with the extra `bench`")
    asked: list[int] = []

    class Counting(type(problem)):  # type: ignore[misc]
        def rollout(self, genes: Any, lengths: Any, weights: Any, limit: int) -> Any:
            assert np.array_equal(weights, weights_for(problem, load_profile("default")))
            assert genes.min() >= 0 and genes.max() < len(problem.actions)
            assert lengths.max() <= limit
            asked.append(len(genes))
            return super().rollout(genes, lengths, weights, limit)

    counting = problem.rebind(problem.actions)
    counting.__class__ = Counting
    before = random.getstate()
    np_before = np.random.get_state()[1].tolist()  # type: ignore[index, union-attr]
    run = peers.race(peer, counting, 3, seconds=60.0, length=30)
    assert run.success is not None and run.success <= run.seconds
    assert run.evaluations == sum(asked)
    assert random.getstate() == before
    assert np.random.get_state()[1].tolist() == np_before  # type: ignore[index, union-attr]
    first = list(asked)
    asked.clear()
    peers.race(peer, counting, 3, seconds=60.0, length=30)
    assert asked == first, "same seed, same search"


def test_trials_tell_what_the_planner_told() -> None:
    task, profile = load_task("ladder", NEAR), load_profile("default")
    trials = run_trials(task, profile, range(3))
    for seed in range(3):
        result = plan_genetic(task, seed=seed, profile=profile, threads=1)
        assert trials.evaluations[seed] == result.first_evaluations
        assert (trials.first_lengths[seed], trials.lengths[seed]) == (result.first_length, result.length)
    assert trials.found == 3


def test_trials_that_run_out_of_budget_count_as_failures() -> None:
    trials = run_trials(load_task("h"), load_profile("default"), range(2), max_evaluations=200)
    assert trials.lengths == (None, None)
    assert trials.found == 0
    assert math.isnan(trials.rows("h")[1].value)


def test_speed_is_reported_for_every_load() -> None:
    loads = [speed.evolved_load("ladder", generations=3, copies=1), speed.printed_load("across-hand", copies=2)]
    told = speed.speed_rows(loads=loads, repeats=1)
    assert {load.name for load in loads} <= {row.name.rpartition("by CPU time, ")[2] for row in told}
    assert all(row.value > 0.0 for row in told if "load of the machine" not in row.name)


@pytest.mark.slow
def test_memory_is_that_of_the_command_and_not_of_the_process_that_starts_it(tmp_path: Any) -> None:
    ballast = np.ones(400 * 2**20 // 8)
    seconds, memory = starts.run_command(("--help",), tmp_path)
    assert ballast.all() and seconds > 0.0
    assert 5.0 < memory < 300.0  # MiB


@pytest.mark.slow
def test_the_ablation_runs_on_every_task() -> None:
    told = bench_ablation(seeds=range(1), variants=("default",))
    assert {row.name.split(", default")[0] for row in told} == set(ABLATION_TASKS)
    assert all(isinstance(row, Row) for row in told)


def test_the_scaling_law_keeps_its_limits() -> None:
    law = ScalingLaw(start=2.0, driver=1e-4, overhead=1e-3)
    assert law.seconds(0.1, 1000, 1) == pytest.approx(2.0 + 1000 * 0.101)
    assert law.seconds(1e-6, 10_000, 1000) == pytest.approx(2.0 + 10_000 * 1e-4, rel=1e-3), "the driver is the limit"
    for cores in (1, 10, 100, 1000):
        shares = [law.efficiency(item, 100 * cores, cores) for item in (1e-4, 1e-2, 1.0, 100.0)]
        assert shares == sorted(shares) and shares[0] > 0.0 and shares[-1] < 1.0
        least = law.shortest_item(100 * cores, cores)
        assert law.efficiency(least, 100 * cores, cores) == pytest.approx(0.8, rel=1e-2)
    assert law.shortest_item(1, 10) == math.inf, "one item keeps nine cores idle"


def test_a_page_of_figures_names_command_machine_and_every_row() -> None:
    measured = {"one": [Row("a | b", 1.5, "s", "below 2")], "two": [Row("none", NOTHING, "1")]}
    page = performance_page(measured, "clamber bench one two -o page.md")
    assert "\n    clamber bench one two -o page.md\n" in page
    assert f"Python {platform.python_version()}" in page
    assert "| a \\| b | 1.5 | s | below 2 |" in page
    assert "| none | none | 1 |  |" in page
    assert page.index("## one") < page.index("## two")


@pytest.mark.slow
def test_a_small_batch_gives_every_row_of_the_jobs_benchmark() -> None:
    made = {row.name: row.value for row in batches.batch_rows(items=6, workers=(1, 2))}
    assert all(value > 0.0 for value in made.values())
    assert made["time of 2 ready workers that the points took"] <= 1.0


@pytest.mark.slow
def test_cases_on_workers_are_the_trials_in_this_process_and_a_store_keeps_them(tmp_path: Path) -> None:
    task, profile = load_task("ladder", NEAR), load_profile("default")
    crew = Crew(executor=LocalProcesses(2), store=tmp_path / "store.db")
    cases = {"near": (task, profile), "no polishing": (task, varied(profile, {"polish": 0}))}
    done = run_cases(cases, range(3), crew)
    assert done["near"] == run_trials(task, profile, range(3))
    assert done["no polishing"] == run_trials(task, cases["no polishing"][1], range(3))
    assert run_cases(cases, range(3), replace(crew, executor=Nobody(), resume=True)) == done


class Nobody(LocalProcesses):
    """Runs nothing."""

    def run(self, name: str, items: Mapping[str, str]) -> Generator[End]:
        assert not items
        yield from ()


def test_commands_that_compute_nothing_are_timed_as_whole_processes(monkeypatch: pytest.MonkeyPatch) -> None:
    ran: list[tuple[str, ...]] = []

    def run_command(words: tuple[str, ...], cache: Path) -> tuple[float, float]:
        ran.append(words)
        return 1.0 / len(ran), 10.0

    monkeypatch.setattr(starts, "run_command", run_command)
    rows = starts.command_rows()
    assert [row.aim for row in rows] == ["under 0.3 s", None, "under 1 s", None]
    assert set(ran) == {("--help",), ("--version",), ("list",), ("doctor",)}
    assert rows[0].value == 1.0 / starts.STARTS, "the best of several"


def test_a_plant_that_stops_on_a_busy_machine_is_told_of_and_the_others_are_measured(
    clamber: Callable[..., tuple[int, str, str]], monkeypatch: pytest.MonkeyPatch
) -> None:
    def stops(**_: Any) -> list[Row]:
        raise PlantStoppedError("the plant has made a safe stop: no command came for two ticks")

    monkeypatch.setitem(benches.BENCHES, "plant", stops)
    monkeypatch.setitem(benches.BENCHES, "control", lambda **_: [Row("a tick", 12.0, "us")])
    code, out, err = clamber("bench", "plant", "control", "--json")
    assert code == 1
    assert "plant is left out: the plant has made a safe stop" in " ".join(err.split()) and "Traceback" not in err
    assert [row["name"] for row in json.loads(out)] == ["a tick"]
    assert clamber("bench", "control")[0] == 0
