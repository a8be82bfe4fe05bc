"""`clamber show`: a picture or an animation of a task or a plan, or a picture of a robot or a board alone."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from ..json_form import Count, Key
from ..terminal.live_line import LiveLine
from ..terminal.name_completion import names_of
from ..terminal.options import AsJson, Output, Overrides, Quiet, takes_options
from ..terminal.output import check_writable, print_json, stderr, stdout, tell_written


@dataclass(frozen=True, slots=True)
class Drawn:
    """A picture that was written."""

    written: Annotated[Path, Key(kind=str)]
    """The file."""
    task: str
    """Its name, or that of the robot or the world that is drawn alone."""
    steps: Count
    """Actions that it shows."""
    bytes: Count


@dataclass(frozen=True, slots=True)
class ShowOptions:
    """Options of `clamber show`, as they came."""

    output: Output = None
    step: Annotated[int | None, typer.Option(min=0, help="Draw the stance after this step; 0 is the start.")] = None
    torques: Annotated[bool, typer.Option("--torques", help="Draw the joint torques of every step.")] = False
    task: Annotated[
        str | None,
        typer.Option(help="Show a plan in this task, in place of its own.", autocompletion=names_of("tasks")),
    ] = None
    camera: Annotated[
        str | None,
        typer.Option(
            metavar="FROM",
            help="From where a robot in space is drawn: front, left, right, above, iso, or AZIMUTH,ELEVATION in degrees.",
        ),
    ] = None
    overrides: Overrides = None
    as_json: AsJson = False
    quiet: Quiet = False


@takes_options
def show(
    thing: Annotated[
        str,
        typer.Argument(
            metavar="TASK|PLAN|ROBOT|BOARD",
            help="A task, a plan, a robot, a board or a ground: its name or file.",
            autocompletion=names_of("tasks", "plans", "robots", "boards", "grounds"),
        ),
    ],
    *,
    words: ShowOptions,
) -> None:
    """Draw a task, a plan or one step of it, a robot, a board or a ground (png, svg, pdf), or a plan in motion (gif, html, mp4)."""
    path = words.output or Path(f"{Path(thing).stem}.png")
    check_writable(path)
    with LiveLine(stderr(), quiet=words.quiet) as line:
        drawn = _drawn(thing, words, path, line)
    if words.as_json:
        print_json(drawn)
    else:
        tell_written(stdout(), drawn.written)


def _drawn(thing: str, words: ShowOptions, path: Path, line: LiveLine) -> Drawn:
    from ..inspection.open_file import kind_of
    from ..viewing.alone import draw_alone, open_alone, shown_alone
    from ..viewing.output import CANVASES, check_suffix
    from ..viewing.pictures import ANIMATIONS

    kind = kind_of(thing)
    suffix = check_suffix(path, CANVASES if shown_alone(kind) else (*CANVASES, *ANIMATIONS))
    if shown_alone(kind):
        given = {
            "--step": words.step is not None,
            "--torques": words.torques,
            "--task": words.task is not None,
            "--set": bool(words.overrides),
        }
        if unused := [flag for flag, value in given.items() if value]:
            raise typer.BadParameter(f"is for tasks and plans; '{thing}' is a {kind}", param_hint=", ".join(unused))
        shown_one = open_alone(thing, kind)
        draw_alone(shown_one, path)
        return Drawn(path, shown_one.finding.name, 0, path.stat().st_size)
    if kind == "walk":
        problem = (
            f"'{thing}' is a walk, drawn as it is carried out: clamber run {thing} -o walk.png, or clamber view {thing}"
        )
        raise typer.BadParameter(problem, param_hint="TASK|PLAN|ROBOT|BOARD")
    if suffix in ANIMATIONS:
        line.show(f"preparing {path.name}")
    return _draw_task(thing, words, path, line)


def _draw_task(thing: str, words: ShowOptions, path: Path, line: LiveLine) -> Drawn:
    from ..planning.problem.plan_source import open_replay
    from ..viewing.output import CANVASES
    from ..viewing.pictures import animate, draw_route, draw_stance, pictures_of

    step, camera = words.step, words.camera
    shown, replay = open_replay(thing, words.task, words.overrides or ())
    last = len(replay.stances) - 1
    if step is not None and step > last:
        raise typer.BadParameter(f"{step} is past the last step, {last}", param_hint="--step")
    if words.torques and pictures_of(shown).torque_limits is None:
        family = shown.document["robot"]["family"]
        problem = f"the robot of '{shown.name}' is of the family '{family}', which has no joint torques"
        raise typer.BadParameter(f"needs the plan of a limbed robot; {problem}", param_hint="--torques")
    if words.torques and last == 0:
        raise typer.BadParameter(f"needs the plan of a limbed robot; '{thing}' has no steps", param_hint="--torques")
    if words.torques:
        from ..viewing.plan_curves import draw_torques

        draw_torques(shown, {Path(thing).stem: replay}, path)
    elif path.suffix.lower() not in CANVASES:
        animate(shown, replay, path, camera, line.counting("frame"))
    elif step is None and last > 0:
        draw_route(shown, replay, path, camera)
    else:
        draw_stance(shown, replay, step or 0, path, camera)
    return Drawn(path, shown.name, last, path.stat().st_size)
