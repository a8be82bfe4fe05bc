"""What the tests of the commands share: `clamber` itself, called with words as a shell would."""

from pathlib import Path

import pytest

from clamber.families.climber.execution.executable_plan import climbable
from clamber.families.climber.planning.plans import thesis_code
from clamber.families.climber.planning.task import LimbedTask
from clamber.planning.problem.plan import Plan
from clamber.tasks import load_task


@pytest.fixture(scope="module")
def example_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Where the examples of commands are run: it has a plan of two actions, `two.json`."""
    made = tmp_path_factory.mktemp("examples")
    task = load_task("ladder")
    assert isinstance(task, LimbedTask)
    strict = climbable(task)
    Plan.of_codes(strict, [thesis_code(strict, number) for number in (300, 3)]).save(made / "two.json")
    return made
