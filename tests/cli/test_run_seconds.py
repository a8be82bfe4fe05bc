"""`--seconds` of commands that plan before they climb."""

from collections.abc import Callable

import pytest

from clamber.families.climber.trials.planning_margins import PLANNING_MARGINS, STEADY


@pytest.mark.parametrize("command", ["run", "trials"])
def test_searches_that_seconds_ended_are_told(command: str, clamber: Callable[..., tuple[int, str, str]]) -> None:
    code, out, err = clamber(command, "ladder", "--planner", "greedy", "--seconds", "0")
    assert (code, out) == (1, "")
    assert f"--seconds ended {len(PLANNING_MARGINS) + len(STEADY) + 1} searches" in err
    assert "nothing has moved" in err
