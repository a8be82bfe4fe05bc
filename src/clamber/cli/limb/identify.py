"""`clamber limb identify`: a joint's inertia, friction, amplifier and play from a log."""

from pathlib import Path
from typing import Annotated, TypeAlias

import typer

from ..name_completion import names_of
from ..options import AsJson
from ..output import announce_compilation, check_writable, print_json, stdout

Column: TypeAlias = str | None


def identify(
    log: Annotated[Path, typer.Argument(help="A log with named columns (.csv, .mcap).")],
    robot: Annotated[
        str | None,
        typer.Option(help="A climber's name or file; as the log says unless given.", autocompletion=names_of("robots")),
    ] = None,
    limb: Annotated[str | None, typer.Option(help="Its limb, by name or from 1.")] = None,
    joint: Annotated[
        list[str] | None, typer.Option(metavar="NAME", help="Only this joint of the log; repeat it.")
    ] = None,
    columns: Annotated[
        list[str] | None,
        typer.Option(
            "--column",
            metavar="COLUMN=ROLE",
            help="What a column is, such as 'pos_3=left elbow angle (deg)'; repeat it.",
        ),
    ] = None,
    time: Annotated[Column, typer.Option(metavar="COLUMN", help="The column of time.")] = None,
    angle: Annotated[
        Column,
        typer.Option(metavar="COLUMN", help="Angle by the encoder, at the joint's scale; for a log of one joint."),
    ] = None,
    torque: Annotated[Column, typer.Option(metavar="COLUMN", help="The motor's torque at the joint.")] = None,
    current: Annotated[Column, typer.Option(metavar="COLUMN", help="The motor's current.")] = None,
    command: Annotated[Column, typer.Option(metavar="COLUMN", help="The amplifier's command voltage.")] = None,
    output_angle: Annotated[Column, typer.Option(metavar="COLUMN", help="Angle behind the gear.")] = None,
    torque_constant: Annotated[
        str | None, typer.Option(help="Of the motors, such as 0.0138Nm/A; the robot's unless given.")
    ] = None,
    gear: Annotated[float | None, typer.Option(help="Motor turns per joint turn; the robot's unless given.")] = None,
    gain: Annotated[
        str | None, typer.Option(help="Of the amplifier, for voltages without currents, such as 0.27A/V.")
    ] = None,
    upright: Annotated[
        bool, typer.Option("--upright", help="The links' weight acts: the limb hangs on a wall.")
    ] = False,
    topic: Annotated[str | None, typer.Option(help="Channel of an MCAP file.")] = None,
    seed: Annotated[int, typer.Option(min=0, help="Of the bootstrap that tells errors.")] = 0,
    output: Annotated[
        Path | None,
        typer.Option(
            "--output", "-o", metavar="FILE", help="A picture (.png, .svg, .pdf), or lines for a robot file (.toml)."
        ),
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Find each joint's inertia, damping, friction, amplifier gain and backlash from a log, with standard errors."""
    check_writable(output)
    if output is not None:
        from ...viewing.output import CANVASES, check_suffix

        check_suffix(output, (".toml", *CANVASES))
    from ...execution.log_columns import read_mapping
    from ...execution.log_files import read_log
    from ...execution.log_identify import Known, identify_log
    from .identify_text import print_identification, write_identification

    chosen = {"time": time, "angle": angle, "torque": torque, "current": current, "command": command}
    mapping = read_mapping(columns or (), chosen | {"output angle": output_angle})
    known = Known.read(torque_constant, gear, gain)
    read = read_log(log, topic)
    announce_compilation(quiet=as_json)
    result = identify_log(
        read,
        robot=robot,
        limb=limb,
        mapping=mapping,
        joints=tuple(joint or ()),
        known=known,
        upright=upright,
        seed=seed,
    )
    if output is not None:
        write_identification(result, output)
    if as_json:
        print_json(result.to_json())
    else:
        print_identification(stdout(), result)
    raise typer.Exit(0 if result.complete else 1)
