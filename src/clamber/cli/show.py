"""`clamber show`: a picture or an animation of a task or a plan."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from ..json_form import Count, Key
from ..terminal.name_completion import names_of
from ..terminal.options import AsJson, Output, Overrides
from ..terminal.output import announce_compilation, check_writable, print_json, stdout


@dataclass(frozen=True, slots=True)
class Drawn:
    """A picture that was written."""

    written: Annotated[Path, Key(kind=str)]
    """The file."""
    task: str
    steps: Count
    """Actions that it shows."""
    bytes: Count


def show(
    thing: Annotated[
        str,
        typer.Argument(
            metavar="TASK|PLAN",
            help="A task's name or file, or a plan's file.",
            autocompletion=names_of("tasks", "plans"),
        ),
    ],
    output: Output = None,
    step: Annotated[int | None, typer.Option(min=0, help="Draw the stance after this step; 0 is the start.")] = None,
    torques: Annotated[bool, typer.Option("--torques", help="Draw the joint torques of every step.")] = False,
    task: Annotated[
        str | None,
        typer.Option(help="Show a plan in this task, in place of its own.", autocompletion=names_of("tasks")),
    ] = None,
    camera: Annotated[
        str | None,
        typer.Option(
            metavar="FROM",
            help="From where a robot in space is drawn: front, left, right, above, iso, or AZIMUTH,ELEVATION in degrees.",
        ),
    ] = None,
    overrides: Overrides = None,
    as_json: AsJson = False,
) -> None:
    """Draw a task, a plan or one step of it (png, svg, pdf), or a plan in motion (gif, html, mp4)."""
    path = output or Path(f"{Path(thing).stem}.png")
    check_writable(path)
    announce_compilation()
    from ..planning.problem.plan_source import check_name, open_replay
    from ..viewing.output import CANVASES
    from ..viewing.pictures import animate, draw_route, draw_stance, pictures_of

    check_name(thing)
    shown, replay = open_replay(thing, task, overrides or ())
    last = len(replay.stances) - 1
    if step is not None and step > last:
        raise typer.BadParameter(f"{step} is past the last step, {last}", param_hint="--step")
    if torques and pictures_of(shown).torque_limits is None:
        family = shown.document["robot"]["family"]
        words = f"the robot of '{shown.name}' is of the family '{family}', which has no joint torques"
        raise typer.BadParameter(f"needs the plan of a limbed robot; {words}", param_hint="--torques")
    if torques and last == 0:
        raise typer.BadParameter(f"needs the plan of a limbed robot; '{thing}' has no steps", param_hint="--torques")
    if torques:
        from ..viewing.plan_curves import draw_torques

        draw_torques(shown, {Path(thing).stem: replay}, path)
    elif path.suffix.lower() not in CANVASES:
        animate(shown, replay, path, camera)
    elif step is None and last > 0:
        draw_route(shown, replay, path, camera)
    else:
        draw_stance(shown, replay, step or 0, path, camera)
    if as_json:
        print_json(Drawn(path, shown.name, last, path.stat().st_size))
        return
    stdout().print(f"written to {path}", soft_wrap=True)
