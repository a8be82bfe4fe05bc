"""`clamber follow`: a walker that stands follows a tool path with arm and body."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.console import Console

from ....errors import FileError, SpecError
from ....terminal.name_completion import names_of
from ....terminal.options import AsJson, takes_options
from ....terminal.output import check_writable, print_json, stdout
from ....viewing.text_table import plain_table

if TYPE_CHECKING:
    from ..robot import WalkerRobot
    from ..trials.cooperative.follow import FollowOptions, FollowRun
    from ..trials.cooperative.tool_path import ToolPath

Outputs = Annotated[
    list[Path] | None,
    typer.Option("--output", "-o", metavar="FILE", help="A picture (.png, .svg, .pdf) or a log (.csv, .mcap); again."),
]


@dataclass(frozen=True, slots=True)
class Following:
    """How a path is followed, as it was asked for."""

    dof: Annotated[int, typer.Option(help="Degrees of freedom: 4 arm, 5 with height, 7 with tilts, 10 all.")] = 10
    gain: Annotated[float, typer.Option(help="k_p of the manipulability's gradient.")] = 1.0
    speed: Annotated[str, typer.Option(help="Largest of the tool, where the path has no times.")] = "50mm/s"
    payload: Annotated[str, typer.Option(help="At the tool.")] = "0kg"
    balance: Annotated[str, typer.Option(help="Least margin of the centre of mass in the support.")] = "0mm"
    height: Annotated[str | None, typer.Option(help="Of the plate at the start; legs' nominal length.")] = None
    dynamics: Annotated[bool, typer.Option("--dynamics", help="Lead a robot in contact dynamics through it.")] = False
    blind: Annotated[bool, typer.Option("--blind", help="In dynamics: without correction by what sensors say.")] = False

    def options(self) -> "FollowOptions":
        """The same in SI."""
        from ....units import parse_quantity
        from ..trials.cooperative.follow import FollowOptions

        return FollowOptions(
            dof=self.dof,
            gain=self.gain,
            speed=parse_quantity(self.speed, "speed"),
            payload=parse_quantity(self.payload, "mass"),
            balance=parse_quantity(self.balance, "length"),
            height=None if self.height is None else parse_quantity(self.height, "length"),
            dynamics=self.dynamics,
            felt=not self.blind,
        )


@takes_options
def follow(
    path: Annotated[
        str,
        typer.Argument(
            help="File with columns x, y, z and perhaps t, or one of: circle, wide.",
            autocompletion=names_of(besides=("circle", "wide")),
        ),
    ],
    robot: Annotated[
        str,
        typer.Option(help="A two-frame walker with an arm, by name or file.", autocompletion=names_of("robots")),
    ] = "hoshino",
    *,
    asked: Following,
    output: Outputs = None,
    as_json: AsJson = False,
) -> None:
    """Follow a tool path with arm and body, within every limit of joints, rates, actuators, legs and balance.

    Exit code 1 if the tool does not come to the path's end or cannot reach points of it.
    """
    from ..trials.cooperative.follow import follow_path
    from ..trials.cooperative.tool_path import load_tool_path

    if asked.blind and not asked.dynamics:
        raise typer.BadParameter("is for a robot in dynamics", param_hint="--blind")
    files = output or []
    _check_files(files)
    chosen = _load_robot_with_arm(robot)
    options = asked.options()
    tool_path = load_tool_path(path)
    run = follow_path(chosen, tool_path, options)
    _write_files(run, files)
    if as_json:
        print_json(run)
    else:
        _print_follow(stdout(), run, tool_path)
    raise typer.Exit(0 if run.at_end() and not run.unreachable else 1)


def _print_follow(console: Console, run: "FollowRun", path: "ToolPath") -> None:
    """Print how the tool followed its path, how far it was off, and which limit it came nearest to."""
    from ..control.cooperative.planted_feet import SUPPORT_WORDS

    closest = run.closest_range()
    unit = "" if closest.unit == "1" else f" {closest.unit}"
    table = plain_table("", "", right=("",))
    table.add_row("result", run.reason)
    table.add_row("stands on", f"the {SUPPORT_WORDS[run.footing.support]}")
    table.add_row("took", f"{run.seconds:.1f} s, {1e3 * path.length:.0f} mm of path")
    table.add_row("off its place", f"{1e3 * run.rms_error:.3f} mm rms, {1e3 * run.largest_error:.3f} mm at most")
    table.add_row("manipulability", f"{run.mean_manipulability:.4f} mean, {run.least_manipulability:.4f} least")
    if run.options.gain > run.stable_gain:
        table.add_row(
            "gain", f"{run.options.gain:g} swings about summits of V; below {run.stable_gain:.3g} it does not"
        )
    table.add_row("closest limit", f"{closest.name}, {closest.margin:.3g}{unit} left at {closest.time:.1f} s")
    if run.unreachable:
        table.add_row("out of reach", f"{len(run.unreachable)} of the points looked at beforehand")
    console.print(table)
    for note in path.notes:
        console.print(note)


def _check_files(files: Sequence[Path]) -> None:
    from ....execution.log_files import SUFFIXES
    from ....viewing.output import CANVASES

    for file in files:
        check_writable(file)
        if file.suffix.lower() not in (*CANVASES, *SUFFIXES):
            allowed = ", ".join((*CANVASES, *SUFFIXES))
            raise FileError(str(file), f"no picture or log has the suffix '{file.suffix}'", f"allowed are {allowed}")


def _load_robot_with_arm(name: str) -> "WalkerRobot":
    from ....tasks.robots import load_robot
    from ..robot import WalkerRobot

    chosen = load_robot(name)
    if not isinstance(chosen, WalkerRobot) or chosen.arm is None:
        raise SpecError(f"robot '{chosen.name}'", "arm", chosen.name, "must be a two-frame walker with an arm")
    return chosen


def _write_files(run: "FollowRun", files: Sequence[Path]) -> None:
    from ....execution.log_files import SUFFIXES, write_log

    for file in files:
        if file.suffix.lower() in SUFFIXES:
            write_log(run.log(), file, "follow")
        else:
            from ..pictures.tool_plots import draw_follow

            draw_follow(run, file)
