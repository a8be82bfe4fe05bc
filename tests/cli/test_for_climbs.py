"""Options of `run` and `trials` that climbs have and walks do not are refused by name, for a walk and for a walker's task."""

from collections.abc import Callable
from dataclasses import fields
from typing import TypeAlias

import pytest

from clamber.cli.run.command import RunOptions
from clamber.cli.trials.command import TrialsOptions
from clamber.family import family_named
from clamber.tasks import load_task
from clamber.terminal.worker_options import WorkerOptions

Run: TypeAlias = Callable[..., tuple[int, str, str]]
OF_PLANS = (("--task", "ladder"), ("--planner", "exact"), ("--seconds", "3"))
OF_RUNS = (("--peg-error", "3mm"), ("--no-replan",), ("--plant", "volts"), ("--force",), ("--law", "whole-body"))
OF_TRIALS = (("--no-replan",), ("--force",), ("--law", "whole-body"), ("--against-law", "joint-impedance"))


def test_every_one_of_them_is_an_option() -> None:
    of_run = {field.name for field in fields(RunOptions)}
    of_trials = {field.name for holder in (TrialsOptions, WorkerOptions) for field in fields(holder)}
    walker = family_named("walker")
    assert walker.dynamics is not None
    for work in (load_task("terrace-walk"), walker.other_work("level-walk")):
        assert walker.dynamics.unused(work) <= of_run | of_trials
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


@pytest.mark.parametrize("option", ["--law", "--against-law"])
def test_laws_of_a_whole_body_are_for_robots_in_space(option: str, clamber: Run) -> None:
    code, out, err = clamber("trials", "ladder", option, "joint-impedance")
    assert (code, out) == (2, "")
    assert option in err and "'ladder' is a climb" in " ".join(err.split())


def test_a_law_that_is_not_there_is_refused_before_a_plan_is_made(clamber: Run) -> None:
    code, out, err = clamber("run", "wall-gripper", "--law", "joint-stiffness")
    assert (code, out) == (2, "")
    assert "joint-stiffness" in err and "jacobian-transpose" in err


def test_trials_of_walks_have_no_picture(clamber: Run) -> None:
    code, out, err = clamber("trials", "level-walk", "--output", "trials.png")
    assert (code, out) == (2, "")
    assert "a walk has no picture of trials; --json" in err
