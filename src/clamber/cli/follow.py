"""`clamber follow`: a walker that stands follows a tool path with arm and body."""

from pathlib import Path
from typing import Annotated

import typer

from ..errors import FileError, SpecError
from .options import AsJson
from .output import announce_compilation, check_writable, plain_table, print_json, stdout

Outputs = Annotated[
    list[Path] | None,
    typer.Option("--output", "-o", metavar="FILE", help="A picture (.png, .svg, .pdf) or a log (.csv, .mcap); again."),
]


def follow(
    path: Annotated[str, typer.Argument(help="File with columns x, y, z and perhaps t, or one of: circle, wide.")],
    robot: Annotated[str, typer.Option(help="A two-frame walker with an arm, by name or file.")] = "hoshino",
    dof: Annotated[int, typer.Option(help="Degrees of freedom: 4 arm, 5 with height, 7 with tilts, 10 all.")] = 10,
    gain: Annotated[float, typer.Option(help="k_p of the manipulability's gradient.")] = 1.0,
    speed: Annotated[str, typer.Option(help="Largest of the tool, where the path has no times.")] = "50mm/s",
    payload: Annotated[str, typer.Option(help="At the tool.")] = "0kg",
    balance: Annotated[str, typer.Option(help="Least margin of the centre of mass in the support.")] = "0mm",
    height: Annotated[str | None, typer.Option(help="Of the plate at the start; legs' nominal length.")] = None,
    dynamics: Annotated[bool, typer.Option("--dynamics", help="Lead a robot in contact dynamics through it.")] = False,
    blind: Annotated[
        bool, typer.Option("--blind", help="In dynamics: without correction by what sensors say.")
    ] = False,
    output: Outputs = None,
    as_json: AsJson = False,
) -> None:
    """Follow a tool path with arm and body, within every limit of joints, rates, actuators, legs and balance.

    Exit code 1 if the tool does not come to the path's end or cannot reach points of it.
    """
    from ..control.cooperative.planted_feet import SUPPORT_WORDS
    from ..execution.log_files import SUFFIXES, write_log
    from ..experiments.cooperative.follow import FollowOptions, follow_path
    from ..experiments.cooperative.tool_path import load_tool_path
    from ..robots.library import load_robot
    from ..robots.walker import WalkerRobot
    from ..units import parse_quantity
    from ..viewing.output import CANVASES

    if blind and not dynamics:
        raise typer.BadParameter("is for a robot in dynamics", param_hint="--blind")
    files = output or []
    for file in files:
        check_writable(file)
        if file.suffix.lower() not in (*CANVASES, *SUFFIXES):
            allowed = ", ".join((*CANVASES, *SUFFIXES))
            raise FileError(str(file), f"no picture or log has the suffix '{file.suffix}'", f"allowed are {allowed}")
    chosen = load_robot(robot)
    if not isinstance(chosen, WalkerRobot) or chosen.arm is None:
        raise SpecError(f"robot '{chosen.name}'", "arm", chosen.name, "must be a two-frame walker with an arm")
    options = FollowOptions(
        dof=dof,
        gain=gain,
        speed=parse_quantity(speed, "speed"),
        payload=parse_quantity(payload, "mass"),
        balance=parse_quantity(balance, "length"),
        height=None if height is None else parse_quantity(height, "length"),
        dynamics=dynamics,
        felt=not blind,
    )
    tool_path = load_tool_path(path)
    announce_compilation("prepare", quiet=as_json)
    run = follow_path(chosen, tool_path, options)
    for file in files:
        if file.suffix.lower() in SUFFIXES:
            write_log(run.log(), file, "follow")
        else:
            from ..viewing.follow_plot import draw_follow

            draw_follow(run, file)
    told = run.to_json()
    if as_json:
        print_json(told)
    else:
        table = plain_table("", "", right=("",))
        name, margin, time, unit = run.closest_range()
        table.add_row("result", run.reason)
        table.add_row("stands on", f"the {SUPPORT_WORDS[run.footing.support]}")
        table.add_row("took", f"{told['seconds']:.1f} s, {1e3 * tool_path.length:.0f} mm of path")
        table.add_row(
            "off its place", f"{1e3 * told['rms_error_m']:.3f} mm rms, {1e3 * told['largest_error_m']:.3f} mm at most"
        )
        table.add_row(
            "manipulability", f"{told['mean_manipulability']:.4f} mean, {told['least_manipulability']:.4f} least"
        )
        if run.options.gain > run.stable_gain:
            table.add_row(
                "gain", f"{run.options.gain:g} swings about summits of V; below {run.stable_gain:.3g} it does not"
            )
        table.add_row("closest limit", f"{name}, {margin:.3g} {unit} left at {time:.1f} s")
        if run.unreachable:
            table.add_row("out of reach", f"{len(run.unreachable)} of the points looked at beforehand")
        stdout().print(table)
        for note in tool_path.notes:
            stdout().print(note)
    raise typer.Exit(0 if told["reached"] and not run.unreachable else 1)
