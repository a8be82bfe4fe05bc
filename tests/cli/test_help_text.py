"""Help and tables print brackets, which are units, as they are written."""

from collections.abc import Callable
from typing import Annotated, Literal

import pytest
import typer
from typer.main import get_command

from clamber.cli.app import application, command_of, commands_below
from clamber.terminal.output import stdout
from clamber.viewing.text_table import plain_table

Clamber = Callable[..., tuple[int, str, str]]
TEXTS = {
    path: [
        text
        for one in (command, *command.params)
        for text in (getattr(one, "help", None), getattr(one, "metavar", None))
        if text
    ]
    for path, command in commands_below(get_command(application()))
}
"""Words of a command -> the texts of its help, as they are written."""


def in_a_line(text: str) -> str:
    return " ".join(text.split())


@pytest.mark.parametrize("path", TEXTS, ids=lambda path: " ".join(path) or "clamber")
def test_help_prints_every_text_as_it_is_written(
    path: tuple[str, ...], clamber: Clamber, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "2000")
    code, out, _ = clamber(*path, "--help")
    assert code == 0
    for text in TEXTS[path]:
        assert in_a_line(text) in in_a_line(out)


@pytest.mark.parametrize("markup", ["rich", None])
def test_a_unit_in_brackets_is_printed_with_and_without_rich(
    markup: Literal["rich"] | None, capsys: pytest.CaptureFixture[str]
) -> None:
    one = typer.Typer(rich_markup_mode=markup)

    @one.command()
    def fall(seconds: Annotated[float, typer.Option(help="For how long [s].")] = 1.0) -> None:
        """Fall with a speed [m/s]."""

    with pytest.raises(SystemExit):
        command_of(one)(["--help"])
    out = capsys.readouterr().out
    assert "For how long [s]." in out
    assert "Fall with a speed [m/s]." in out


def test_tables_print_brackets(capsys: pytest.CaptureFixture[str]) -> None:
    table = plain_table("way [mm]", "time [s]")
    table.add_row("of [red]", "[3, 4]")
    stdout().print(table)
    out = capsys.readouterr().out
    assert all(word in out for word in ("way [mm]", "time [s]", "of [red]", "[3, 4]"))
