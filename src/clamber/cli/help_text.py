"""Help texts say what they say: a unit in brackets, such as [s], is no markup."""

from collections.abc import Iterator
from typing import TypeAlias

import typer
from rich.markup import escape
from typer.core import TyperCommand, TyperGroup

from .limits import limit_numbers

Command: TypeAlias = TyperCommand | TyperGroup


def command_of(app: typer.Typer) -> Command:
    """The command of an application: its texts and those of all commands below it as they are written, its numbers within limits."""
    top = typer.main.get_command(app)
    assert isinstance(top, Command)
    for path, command in commands_below(top):
        limit_numbers(command, path)
        if command.rich_markup_mode == "rich":  # a plain terminal prints no markup, so none is to be escaped
            for told in (command, *command.params):
                text = getattr(told, "help", None)
                if text is not None:
                    setattr(told, "help", escape(text))  # noqa: B010  # a bare click parameter has none
    return top


def commands_below(command: Command, path: tuple[str, ...] = ()) -> Iterator[tuple[tuple[str, ...], Command]]:
    """A command and all below it, each with its words after `clamber`."""
    yield path, command
    if isinstance(command, TyperGroup):
        for name, below in command.commands.items():
            assert isinstance(below, Command)
            yield from commands_below(below, (*path, name))
