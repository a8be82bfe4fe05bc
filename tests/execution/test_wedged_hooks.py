"""Hooks that do not come off where a plan releases them: they are taken off where they were less turned."""

from pathlib import Path

import pytest

from clamber.actions.plan_source import open_plan
from clamber.experiments.climb.noise import named_noise
from clamber.experiments.climb.run_plan import climbing_flaws, climbing_task, run_plan

CIRCLE = Path(__file__).parents[2] / "examples" / "circle" / "plan.json"


@pytest.mark.slow
def test_a_hook_that_a_peg_has_come_into_as_it_turned_comes_off_farther_back() -> None:
    """Pegs 23 and 25, nominally 25 mm apart, are drawn so near to each other that the hook on 25 does not come off as it stands."""
    opened = open_plan(CIRCLE)
    task = climbing_task(opened.task)
    report = run_plan(task, opened.plan, climbing_flaws(task, ()), noise=named_noise("usual"), seed=142).report
    assert report.done
    tries = [action.tries for action in report.actions if action.kind == "release"]
    assert max(tries) == 2 and sum(tries) == len(tries) + 1
