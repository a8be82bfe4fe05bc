"""Options of `run` and `trials` that climbs have and walks do not are refused by name, for a walk and for a walker's task."""

from collections.abc import Callable
from dataclasses import fields
from typing import TypeAlias

import pytest

from clamber.cli.run.options import RunOptions
from clamber.cli.trials.command import TrialsOptions
from clamber.family import family_named
from clamber.tasks import load_task
from clamber.terminal.worker_options import WorkerOptions

Run: TypeAlias = Callable[..., tuple[int, str, str]]
OF_PLANS = (("--task", "ladder"), ("--planner", "exact"), ("--seconds", "3"))
OF_RUNS = (("--peg-error", "3mm"), ("--no-replan",), ("--plant", "volts"), ("--force",))
OF_TRIALS = (("--no-replan",), ("--force",))


def test_every_one_of_them_is_an_option() -> None:
    of_run = {field.name for field in fields(RunOptions)}
    of_trials = {field.name for holder in (TrialsOptions, WorkerOptions) for field in fields(holder)}
    walker = family_named("walker")
    assert walker.dynamics is not None
    for work in (load_task("terrace-walk"), walker.other_work("level-walk")):
        assert walker.dynamics.unused(work) <= of_run
        assert walker.dynamics.unused(work) & of_trials


@pytest.mark.parametrize(
    ("command", "what", "option"),
    [
        *(("run", "level-walk", option) for option in (*OF_PLANS, *OF_RUNS, ("--save-plan", "plan.json"))),
        *(("run", "terrace-walk", option) for option in OF_RUNS),
        *(("trials", "level-walk", option) for option in (*OF_PLANS, *OF_TRIALS)),
        *(("trials", "terrace-walk", option) for option in OF_TRIALS),
    ],
)
def test_what_only_climbs_have_is_refused(command: str, what: str, option: tuple[str, ...], clamber: Run) -> None:
    code, out, err = clamber(command, what, *option)
    assert (code, out) == (2, "")
    assert option[0] in err and f"'{what}' is a walk" in " ".join(err.split())


def test_trials_of_walks_have_no_picture(clamber: Run) -> None:
    code, out, err = clamber("trials", "level-walk", "--output", "trials.png")
    assert (code, out) == (2, "")
    assert "a walk has no picture of trials" in err
