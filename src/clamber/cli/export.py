"""`clamber export`: a robot, a plan or a run as a file that other programs read."""

from pathlib import Path
from typing import Annotated

import typer

from ..terminal.name_completion import names_of
from ..terminal.options import AsJson, Force, Overrides
from ..terminal.output import check_writable, print_json, stdout


def export(
    thing: Annotated[
        str,
        typer.Argument(
            metavar="ROBOT|PLAN|LOG",
            help="A robot's or a plan's name or file, or the log of a run (.mcap, .csv).",
            autocompletion=names_of("robots", "plans"),
        ),
    ],
    output: Annotated[Path, typer.Option("--output", "-o", metavar="FILE", help="File to write.")],
    task: Annotated[
        str | None,
        typer.Option(help="For a plan: in this task, in place of its own.", autocompletion=names_of("tasks")),
    ] = None,
    overrides: Overrides = None,
    force: Force = False,
    as_json: AsJson = False,
) -> None:
    """Write a robot, a plan or a run for other programs; the file's suffix says as what.

    A robot: .xml (MJCF), .urdf. A plan: .csv and .json (joints over time; JSON in the fields of ROS 2's JointTrajectory),
    .contacts.json (stances and contacts of a robot in space), .md (a table). A run's log: .csv, .json. Pictures and animations are made
    by `clamber show` and `clamber run`.
    """
    check_writable(output, force=force)
    from ..exports.library import export as write

    written = write(thing, output, task, overrides or ())
    if as_json:
        print_json(written)
        return
    console = stdout()
    console.print(f"{written.kind} as {written.format}: {written.path}", soft_wrap=True)
    for note in written.notes:
        console.print(note)
