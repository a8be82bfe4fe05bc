"""`clamber schema`: what a command prints with `--json`, field by field."""

from typing import TYPE_CHECKING, Annotated

import typer

from ..terminal.options import AsJson
from ..terminal.output import print_json, stdout
from ..viewing.text_table import plain_table

if TYPE_CHECKING:
    from ..types import Json


def schema(
    command: Annotated[
        list[str] | None, typer.Argument(help="Words of a command, such as limb step; all commands unless given.")
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Tell what a command prints with --json: every field, what it holds and means. With --json: the JSON Schema."""
    from .printed.library import PRINTED, schema_of

    if command:
        told = schema_of(" ".join(command))
        if as_json:
            print_json(told)
        else:
            print_tables(told)
        return
    if as_json:
        print_json({name: schema_of(name) for name in PRINTED})
        return
    for name in PRINTED:
        stdout().print(name)


def print_tables(told: "Json") -> None:
    """The objects of a schema as people read them."""
    from .printed.tables import tables_of, top_of

    console = stdout()
    console.print(f"{told['title']}: {top_of(told)}" if "properties" not in told else str(told["title"]), style="bold")
    for each in tables_of(told):
        console.print()
        if each.name != told["title"]:
            console.print(each.name, style="bold")
        if each.meaning:
            console.print(each.meaning)
        table = plain_table("field", "holds", "meaning")
        for row in each.rows:
            table.add_row(*row)
        console.print(table)
