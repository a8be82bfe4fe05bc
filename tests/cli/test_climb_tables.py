"""Tables of climbs tell of hooks that came off and were brought back."""

from typing import Any

import pytest

from clamber.families.climber.execution.climb_report import ActionReport, ClimbReport
from clamber.families.climber.pictures.climb_text import print_run, print_trials
from clamber.families.climber.trials.run_plan import ClimbRun
from clamber.families.climber.trials.trial_summary import TrialSummary
from clamber.tasks import load_task
from clamber.terminal.output import stdout


def action(step: int, kind: str, title: str, recovered: int) -> ActionReport:
    return ActionReport(step, step, kind, title, "ok", 0.0, 5.0, 1, 0.004, 0.003, 0.006, recovered=recovered)


def climbed(*actions: ActionReport) -> ClimbRun:
    report = ClimbReport(actions=list(actions), done=True, seconds=12.0)
    parts: dict[str, Any] = {"task": load_task("ladder"), "plan": None, "trace": None, "drawn": None}
    return ClimbRun(report=report, wall_seconds=1.0, **parts)


def test_a_run_shows_in_its_table_and_by_name_which_actions_were_recovered(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    moves = (action(2, "move", "body up 3 in", 0), action(4, "move", "body up 6 in", 2))
    print_run(stdout(), climbed(action(1, "grab", "left grabs hold 9", 1), *moves))
    lines = capsys.readouterr().out.splitlines()
    rows = {line.split()[0]: line.split() for line in lines[1:4]}
    column = rows["action"].index("recovered")
    assert (rows["grab"][column], rows["move"][column]) == ("1", "2")
    assert "recovered once: step 1, left grabs hold 9: a hook had come off" in lines
    assert "recovered 2 times: step 4, body up 6 in: a hook had come off" in lines
    assert max(map(len, lines)) <= 80


def test_a_run_in_which_no_hook_came_off_names_none(capsys: pytest.CaptureFixture[str]) -> None:
    print_run(stdout(), climbed(action(1, "move", "body up 3 in", 0)))
    assert "a hook had come off" not in capsys.readouterr().out


@pytest.mark.parametrize("recovered", [0, 5])
def test_trials_tell_how_many_hooks_were_brought_back(recovered: int, capsys: pytest.CaptureFixture[str]) -> None:
    summary = TrialSummary(
        task="ladder", noise="usual", asked=9, n=9, done=8, causes=(), seconds=None, per_rung=None, short=None, speed=None,
        pushes=None, stalled=0, replanned=0, recovered=recovered, recovering=3, saved=2, forced=(), effects=(),
    )  # fmt: skip
    print_trials(stdout(), summary, range(9))
    told = "hooks that came off and were brought back: 5, in 3 climbs, 2 of which succeeded"
    assert (told in " ".join(capsys.readouterr().out.split())) == (recovered > 0)
