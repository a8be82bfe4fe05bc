"""What commands print with `--json` is what their schemas say: on a small example of each, and of each kind of answer."""

import json
import shlex
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft202012Validator

from clamber.actions.limbed_plans import thesis_code
from clamber.actions.plan import Plan
from clamber.cli.app import app
from clamber.cli.help_text import command_of, commands_below
from clamber.cli.printed.library import PRINTED, schema_of
from clamber.cli.printed.tables import tables_of, top_of
from clamber.execution.climb.course import climbable
from clamber.tasks import load_task
from clamber.tasks.limbed import LimbedTask

NO_HANGS = "--set rules.max_hangs=0"
GAP = f"{NO_HANGS} --set step.length=3in --set board.ladder.rungs=7 --set board.ladder.removed=[7,8,9,10,11,12] --set goal.y_min=30in"
LOW = f"{NO_HANGS} --set goal.y_min=15in"
QUICK = (
    "list",
    "list planners",
    f"plan ladder --planner exact {LOW} --threads 1",
    "plan ladder --evaluations 20 --threads 1",
    f"plan ladder --pareto length,torque {LOW} --threads 1",
    "polish ladder-hand --width 0 --effort 2000",
    "learn ladder --seeds 1 --threads 1",
    "inventory ladder",
    "check ladder-hand",
    "check h-ga --all",
    "run two.json",
    "press --seconds 0.2",
    "follow circle --dof 4",
    "show ladder-hand -o picture.png",
    "export hoshino -o robot.urdf",
    f"sweep ladder --vary motor.torque_limit=8Nm..9Nm:2 --workers 1 {LOW}",
    f"reach ladder {LOW}",
    "study bevly-1997 inventory-size",
    "limb step -c scct --seconds 1",
    "limb circle -c scct --lap 1",
    "limb push -c scct --from 0.1 --to 0.4 --seconds 1",
    "limb open-loop",
    "new board --random --holds 20 -o board.toml",
)
LONG = (
    f"plan ladder --planner exact {GAP} --threads 1",
    "plan ladder --planner exact --set start.y=20in --threads 1",
    "run level-walk --set way.0.distance=3cm",
    'run level-walk --set way.0.distance=60cm --set \'hold={x="0.6m",y="0.1m",z="0.5m"}\'',
    "trials two.json -n 2 --workers 1",
    "trials two.json --replay 1",
    "trials level-walk -n 2 --workers 1 --set way.0.distance=3cm",
    "bench plant",
    "calibrate --seeds 1",
    "ditch --straight",
    "ditch --width 180mm",
    "ditch --width 400mm",
    "doctor",
    "limb step -c scct -c joint-pd --seconds 1 --flaws nominal --trials 2",
    "limb record -o limb.csv",
    "limb identify limb.csv",
    "limb force -c hybrid --friction-compensation none",
    "limb portrait scct",
    "limb sweep --scenario step --vary kp=1000..5000:2 --kd 4 --kp 100 -c scct --workers 1",
    "limb tune scct --workers 1",
    "body circle --lap 3 --laps 1 --flaws ideal -c scct",
    "body push-up -c scct",
    "body push -c scct",
    "body push --trials 2 --limit thesis -c scct",
)
ELSEWHERE = {"plant serve": "tests/cli/test_plant.py", "schema": "below"}
"""Commands that need a partner, or print schemas themselves."""


def command_in(words: str) -> str:
    """The longest beginning of some words that is a command."""
    return max((name for name in PRINTED if f"{words} ".startswith(f"{name} ")), key=len)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = tmp_path_factory.mktemp("printed")
    task = load_task("ladder")
    assert isinstance(task, LimbedTask)
    strict = climbable(task)
    Plan.of_codes(strict, [thesis_code(strict, number) for number in (300, 3)]).save(made / "two.json")
    return made


@pytest.fixture
def printed(clamber: Any, folder: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    monkeypatch.chdir(folder)

    def call(words: str) -> Any:
        code, out, err = clamber(*shlex.split(words), "--json")
        assert "Traceback" not in err
        assert code in (0, 1) or "no start" in out, err
        return json.loads(out)

    return call


def check(printed: Any, words: str) -> None:
    Draft202012Validator(schema_of(command_in(words))).validate(printed(words))


@pytest.mark.parametrize("words", QUICK)
def test_output_is_as_its_schema_says(printed: Any, words: str) -> None:
    check(printed, words)


@pytest.mark.slow
@pytest.mark.parametrize("words", LONG)
def test_output_of_what_takes_longer_is_too(printed: Any, words: str) -> None:
    check(printed, words)


def commands() -> Iterator[tuple[str, Any]]:
    for path, command in commands_below(command_of(app)):
        if not hasattr(command, "commands"):
            yield " ".join(path), command


def test_every_command_has_json_and_a_schema() -> None:
    names = dict(commands())
    assert [name for name, command in names.items() if not any("--json" in one.opts for one in command.params)] == []
    assert set(PRINTED) | {"schema"} == set(names)


def test_every_command_has_an_example_here() -> None:
    assert {command_in(words) for words in (*QUICK, *LONG)} == set(PRINTED) - set(ELSEWHERE)


@pytest.mark.parametrize("command", PRINTED)
def test_schemas_are_schemas_and_every_object_says_what_it_is(command: str) -> None:
    schema = schema_of(command)
    Draft202012Validator.check_schema(schema)
    assert top_of(schema)
    for table in tables_of(schema):
        assert table.meaning, table.name
        assert table.rows


def test_schema_tells_people_a_table_and_programs_a_schema(clamber: Any) -> None:
    code, out, _ = clamber("schema", "limb", "step")
    assert code == 0 and max(map(len, out.splitlines())) <= 80
    assert "unstable_trials" in out
    assert json.loads(clamber("schema", "limb", "step", "--json")[1]) == schema_of("limb step")
    assert set(json.loads(clamber("schema", "--json")[1])) == set(PRINTED)
    code, out, err = clamber("schema", "nothing")
    assert (code, out) == (2, "") and "no command with --json is called 'nothing'" in err


def test_a_field_that_no_schema_names_is_noticed() -> None:
    told = {"written": "a", "task": "b", "steps": 1, "bytes": 2}
    validator = Draft202012Validator(schema_of("show"))
    assert validator.is_valid(told)
    assert not validator.is_valid(told | {"more": 1})
    assert not validator.is_valid({"written": "a", "task": "b", "steps": 1})
    assert not validator.is_valid(told | {"steps": "1"})
