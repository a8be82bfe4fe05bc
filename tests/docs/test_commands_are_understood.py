"""No page tells the reader a command, an option or a choice that isn't there."""

from functools import cache
from typing import Any

import click
import pytest
from told_commands import Told, pages, told_by

from clamber.cli.app import application, command_of

TOLD = [told for page in pages() for told in told_by(page)]


@cache
def top_command() -> Any:
    """`clamber` with all its commands; to build them takes longer than to read a line."""
    return command_of(application())


def understood(words: tuple[str, ...]) -> None:
    """Read the words as the command line does, down to the last command, and carry nothing out."""
    command: click.Command = top_command()
    rest, parent, name = list(words), None, "clamber"
    while True:
        # Eager options such as --version print and leave while they are read; no page's block asks for one alone.
        context = command.make_context(name, rest, parent=parent)
        if not isinstance(command, click.Group):
            return
        rest = [*context.protected_args, *context.args]
        if not rest:
            return
        found = command.get_command(context, rest[0])
        assert found is not None, f"there is no command {rest[0]!r}"
        command, parent, name, rest = found, context, rest[0], rest[1:]


@pytest.mark.parametrize("told", TOLD, ids=lambda told: f"{told.page}:{told.line}:{' '.join(told.words)[:40]}")
def test_command_of_a_page_is_understood(told: Told) -> None:
    if told.is_pattern or (not told.block and len(told.words) == 1):
        name = told.words[0]
        top = top_command()
        options = {option for parameter in top.params for option in parameter.opts}
        assert name in {"--help", *options, *top.commands}, told  # type: ignore[union-attr]
        return
    try:
        understood(told.words)
    except click.MissingParameter as missing:
        assert not told.block, (
            f"{told}: {missing.format_message()}"
        )  # a sentence may name a command by its options alone
    except click.UsageError as error:
        pytest.fail(f"{told.page}:{told.line}: clamber {told.text}: {error.format_message()}")


def test_pages_tell_commands() -> None:
    """The reader of pages above finds something to read."""
    assert sum(told.block for told in TOLD) > 80
    assert {told.page for told in TOLD} > {"README.md", "docs/climbing.md", "docs/walks.md"}
