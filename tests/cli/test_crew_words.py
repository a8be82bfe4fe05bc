"""Options that commands with many items share."""

import pytest
from typer.main import get_command

from clamber.cli.app import application, commands_below
from clamber.terminal.worker_options import WorkerOptions

SHARING = (("trials",), ("sweep",), ("limb", "sweep"), ("limb", "tune"))


@pytest.mark.parametrize("path", SHARING, ids=" ".join)
def test_commands_with_many_items_take_the_same_options_with_the_same_words(path: tuple[str, ...]) -> None:
    commands = dict(commands_below(get_command(application())))
    shared = list(WorkerOptions.__dataclass_fields__)
    told = {one.name: (one.opts, getattr(one, "help", None)) for one in commands[path].params}
    assert [name for name in told if name in shared] == shared
    assert {name: told[name] for name in shared} == {
        one.name: (one.opts, getattr(one, "help", None)) for one in commands[SHARING[0]].params if one.name in shared
    }
