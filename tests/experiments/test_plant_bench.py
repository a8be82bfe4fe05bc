"""Safe stops at moments of a climb: with its guard the robot stays on its pegs, without power it falls."""

import pytest

from clamber.benchmarks.plant_bench import StoppingHardware, stopped_at
from clamber.families.climber.trials.run_plan import climbing_flaws, climbing_task
from clamber.tasks import load_task

# on its way to a peg, pushing at one, tugging, between grabs, releasing, moving its body
MOMENTS = (172, 871, 2349, 2769, 3689, 3872)


def robot_stopped_at(tick: int) -> StoppingHardware:
    task = climbing_task(load_task("ladder"))
    return stopped_at(task, climbing_flaws(task, ()), tick, seed=tick)


@pytest.mark.parametrize("tick", MOMENTS)
def test_the_guard_keeps_a_climbing_robot_on_its_pegs(tick: int) -> None:
    assert robot_stopped_at(tick).hold(3.0) < 0.005


def test_without_power_the_gearbox_does_not_hold_the_robot() -> None:
    assert robot_stopped_at(2000).hold(3.0, power=False) > 0.05
