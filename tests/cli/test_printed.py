"""What commands print with `--json` is what their schemas say: on a small example of each, and of each kind of answer."""

import json
import re
import shlex
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from command_examples import ELSEWHERE, LONG, QUICK
from jsonschema import Draft202012Validator

from clamber.cli.app import application, command_of, commands_below
from clamber.cli.printed.library import PRINTED, schema_of
from clamber.cli.printed.tables import tables_of, top_of

ROOT = Path(__file__).parents[2]


def command_in(words: str) -> str:
    """The longest beginning of some words that is a command."""
    return max((name for name in PRINTED if f"{words} ".startswith(f"{name} ")), key=len)


@pytest.fixture
def printed(clamber: Any, example_folder: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    monkeypatch.chdir(example_folder)

    def call(words: str) -> Any:
        code, out, err = clamber(*shlex.split(words), "--json")
        assert "Traceback" not in err
        assert code in (0, 1) or "no start" in out, err
        return json.loads(out)

    return call


def check(printed: Any, words: str) -> None:
    Draft202012Validator(schema_of(command_in(words))).validate(printed(words))


@pytest.mark.slow
@pytest.mark.usefixtures("in_this_process")
@pytest.mark.parametrize("words", QUICK)
def test_output_is_as_its_schema_says(printed: Any, words: str) -> None:
    check(printed, words)


@pytest.mark.long
@pytest.mark.usefixtures("in_this_process")
@pytest.mark.parametrize("words", LONG)
def test_output_of_what_takes_longer_is_too(printed: Any, words: str) -> None:
    check(printed, words)


def commands() -> Iterator[tuple[str, Any]]:
    for path, command in commands_below(command_of(application())):
        if not hasattr(command, "commands"):
            yield " ".join(path), command


def test_every_command_has_json_and_a_schema() -> None:
    names = dict(commands())
    assert [name for name, command in names.items() if not any("--json" in one.opts for one in command.params)] == []
    assert set(PRINTED) | {"schema"} == set(names)


def test_every_command_has_an_example_here() -> None:
    assert {command_in(words) for words in (*QUICK, *LONG)} == set(PRINTED) - set(ELSEWHERE)
    for command, test in ELSEWHERE.items():
        assert f'schema_of("{command}")' in (ROOT / test).read_text(encoding="utf-8")


@pytest.mark.slow
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


def test_fields_mean_what_they_mean_where_they_are_made_and_have_null_where_python_has_none() -> None:
    objects = schema_of("limb step")["$defs"]
    assert objects["TipMeasures"]["properties"]["lag"]["description"] == (
        "Mean angle behind the aim on a circle, last lap [rad]."
    )
    assert objects["TipMeasures"]["properties"]["on_aim"]["description"].endswith("[s]; null: never.")
    told = [row[2] for command in PRINTED for table in tables_of(schema_of(command)) for row in table.rows]
    assert [meaning for meaning in told if re.search(r"\b(None|NaN)\b", meaning)] == []
