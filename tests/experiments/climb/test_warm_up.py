"""The time of a climb is its own: kernels are ready before it begins, and new plans don't count."""

import subprocess
import sys

import pytest

from clamber.benchmarks.climb_speed import two_rungs
from clamber.execution.sequencer import Sequencer
from clamber.families.climber.execution.climb_report import ClimbReport
from clamber.families.climber.execution.climbing import Climbing, Group
from clamber.families.climber.planning.task import LimbedTask
from clamber.families.climber.trials import run_plan as running
from clamber.families.climber.trials.run_plan import climbing_flaws, run_plan
from clamber.planning.problem.plan import Plan

CLIMB = """
import gc
from numba.core.registry import CPUDispatcher
from clamber.benchmarks.climb_speed import two_rungs
from clamber.families.climber.trials.noise import Noise
from clamber.families.climber.trials.run_plan import climbing_flaws, run_plan
from clamber.families.climber.trials.warm_up import warm_up

def loaded():
    return {(one.__module__, one.__name__) for one in gc.get_objects() if isinstance(one, CPUDispatcher) and one.overloads}

warm_up()
before = loaded()
task, plan = two_rungs()
run = run_plan(task, plan, climbing_flaws(task, ()), noise=Noise.of("usual"), seed=3, plant="volts")
assert len(run.report.actions) == 11, run.report.reason
assert len(before) > 5
print(sorted(loaded() - before))
"""

ALONE = """
import gc
from numba.core.registry import CPUDispatcher
from clamber.families.climber.trials import warm_up

warm_up.warm_up = lambda: None
warm_up.warm_up_beside_planning()
kernels = [one for one in gc.get_objects() if isinstance(one, CPUDispatcher) and one.overloads]
print(*(one.__name__ for one in kernels), *(one.__module__ for one in kernels))
"""


@pytest.mark.slow
def test_beside_planning_what_climbs_alone_need_comes_first() -> None:
    told = subprocess.run([sys.executable, "-c", ALONE], capture_output=True, text=True, timeout=600)
    words = told.stdout.split()
    assert "command_tick" in words, told.stderr
    assert not [
        word
        for word in words
        if word.startswith(("clamber.planning.problem", "clamber.planning", "clamber.families.climber.statics"))
    ]


@pytest.mark.slow
def test_after_warming_up_a_climb_loads_no_further_kernel() -> None:
    told = subprocess.run([sys.executable, "-c", CLIMB], capture_output=True, text=True, timeout=600)
    assert told.stdout.strip() == "[]", told.stderr


def test_time_of_a_climb_has_neither_warming_up_nor_new_plans_in_it(monkeypatch: pytest.MonkeyPatch) -> None:
    now = 0.0

    def pass_by(seconds: float) -> None:
        nonlocal now
        now += seconds

    def climb(self: Sequencer[Group, ClimbReport, int, int, str, float]) -> ClimbReport:
        climbing = self.performer
        assert isinstance(climbing, Climbing)
        assert climbing.replan is not None
        pass_by(3.0)
        assert climbing.replan(task) is plan
        climbing.start()
        climbing.climber.tick()
        return climbing.report

    def replan(task: LimbedTask) -> Plan:
        pass_by(10.0)
        return plan

    task, plan = two_rungs()
    monkeypatch.setattr(running.time, "perf_counter", lambda: now)
    monkeypatch.setattr(running, "warm_up", lambda: pass_by(100.0))
    monkeypatch.setattr(Sequencer, "run", climb)
    assert run_plan(task, plan, climbing_flaws(task, ()), replan=replan).wall_seconds == 3.0
