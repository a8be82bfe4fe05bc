"""The benchmark of climbs measures what it says; how fast, only the benchmark itself tells."""

import pytest

from clamber.benchmarks import climb_speed as speed
from clamber.benchmarks.benches import BENCHES
from clamber.benchmarks.climb_speed import TapedClimberPlant, timed_trial, two_rungs
from clamber.execution.sequencer import Sequencer
from clamber.families.climber.execution.climbing import Climbing
from clamber.families.climber.execution.executable_plan import lay_course
from clamber.families.climber.trials.run_plan import climbing_flaws


def test_the_benchmark_is_found_by_its_name() -> None:
    assert BENCHES["climb"] is speed.climb_rows


@pytest.mark.slow
def test_the_raw_steps_are_those_of_the_climb() -> None:
    """Same model, same steps, same torques and pushes: the robot ends where it did, to the last bit."""
    task, plan = two_rungs()
    plant = TapedClimberPlant(task.robot, task.world, climbing_flaws(task, ()))
    told = lambda step, *_: plant.push((20.0, 0.0) if step == 2 else (0.0, 0.0))  # noqa: E731
    report = Sequencer(Climbing(speed.climber_on(task, plant), lay_course(task, plan)), progress=told).run()
    assert report.done, report.reason
    end = plant.coordinates
    assert plant.steps == pytest.approx(1000.0 * report.seconds)
    plant.replay()
    assert (plant.coordinates == end).all()


def test_the_shares_are_of_one_whole() -> None:
    task, plan = two_rungs()
    shares = speed.shares_of(task, plan, climbing_flaws(task, ()))
    assert sum(shares.values()) == pytest.approx(1.0)
    assert all(share > 0.0 for share in shares.values())


@pytest.mark.slow
def test_the_rows_are_all_there() -> None:
    rows = speed.loop_rows(rounds=1)
    assert [row.unit for row in rows[:4]] == ["x real time", "x real time", "ratio", "us"]
    closed, raw, ratio = (row.value for row in rows[:3])
    assert ratio == pytest.approx(raw / closed)
    assert rows[0].aim == ">= 20"


def test_a_trial_tells_who_did_it_and_how_long_it_took() -> None:
    told = timed_trial({"seed": 1})
    assert set(told) == {"process", "ready", "seconds", "cpu"}
    assert told["seconds"] > 0.0


@pytest.mark.long
def test_the_efficiency_of_workers_is_measured() -> None:
    rows = speed.trial_rows(trials=4, workers=(1, 2))
    assert [row.name for row in rows if row.name.startswith("efficiency")] == [
        "efficiency, 4 trials on 1 workers",
        "efficiency, 4 trials on 2 workers",
    ]
    assert all(row.value > 0.0 for row in rows)
