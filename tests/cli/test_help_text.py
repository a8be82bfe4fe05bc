"""Help and tables print brackets, which are units, as they are written."""

import io
from collections.abc import Callable
from typing import Annotated, Literal

import pytest
import typer
from rich.console import Console
from rich.table import Table
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


def printed(table: Table, columns: int) -> list[str]:
    console = Console(file=io.StringIO(), width=columns)
    console.print(table)
    assert isinstance(console.file, io.StringIO)
    return console.file.getvalue().splitlines()


def test_heads_of_many_columns_break_at_spaces_alone() -> None:
    heads = ("x [mm]", "y [mm]", "angle [deg]", "stroke [mm]", "singular [-]", "balance [mm]", "feet [mm]")
    table = plain_table("slide", "frame to", *heads, right=("slide", *heads))
    table.add_row("2", "Delta", "-274.2", "-51.0", "0.00", "5.2", "0.567", "59.2", "150.1")
    assert printed(table, 60) == [
        "      frame            y angle stroke singular balance  feet",
        "slide to    x [mm]  [mm] [deg]   [mm]      [-]    [mm]  [mm]",
        "    2 Delta -274.2 -51.0  0.00    5.2    0.567    59.2 150.1",
    ]
    assert len(printed(table, 100)) == 2


def test_names_stay_whole_where_heads_can_break_in_their_place() -> None:
    heads = ("radial rms mm", "radial max mm", "behind deg", "IAE mm s", "work J", "at limit %")
    table = plain_table("law", *heads, right=heads)
    table.add_row("jacobian-transpose", "3.02", "6.51", "6.42", "75.45", "3.88", "0.0")
    table.add_row("resolved-rate by inertia", "2.35", "3.57", "2.54", "41.70", "3.74", "0.0")
    lines = printed(table, 60)
    assert max(map(len, lines)) <= 60
    words = {word for line in lines for word in line.split()}
    assert {"jacobian-transpose", "resolved-rate", "inertia", "radial", "behind"} <= words


def test_where_words_have_no_room_the_lines_still_have() -> None:
    table = plain_table("jacobian-transpose", "resolved-rate")
    table.add_row("operational-space", "unweighted")
    assert max(map(len, printed(table, 20))) <= 20
