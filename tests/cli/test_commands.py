"""Commands are listed without being read: the list says what they say themselves, and a call reads one file."""

import subprocess
import sys

import pytest
from typer.core import TyperGroup

from clamber.cli.app import application, command_of
from clamber.cli.commands import commands, groups


def told(only: str | None) -> dict[str, str]:
    """Command -> the first paragraph of its help."""
    top = command_of(application(only))
    assert isinstance(top, TyperGroup)
    return {name: " ".join(str(each.help).split("\n\n")[0].split()) for name, each in top.commands.items()}


def test_the_list_says_what_the_commands_say() -> None:
    assert told("") == told(None)
    assert set(told("")) == {*commands(), *groups()}


@pytest.mark.parametrize("called", ["list", "limb"])
def test_a_command_that_is_called_is_whole_and_the_others_are_not_read(called: str) -> None:
    script = f"import sys; from clamber.cli.app import application; application({called!r}); print(*sys.modules)"
    read = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True).stdout.split()
    places = {name: place.split(":")[0] for name, place in (commands() | groups()).items()}
    assert {name for name, module in places.items() if module in read} == {called}
