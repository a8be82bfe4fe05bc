"""`clamber limb identify`: a joint's inertia, friction, amplifier and play from a log."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, TypeAlias

import typer

from ..name_completion import names_of
from ..option_holder import takes_words
from ..options import AsJson
from ..output import announce_compilation, check_writable, print_json, stdout

Column: TypeAlias = str | None


@dataclass(frozen=True, slots=True)
class IdentifyWords:
    """Options of `clamber limb identify`, as they came."""

    robot: Annotated[
        str | None,
        typer.Option(help="A climber's name or file; as the log says unless given.", autocompletion=names_of("robots")),
    ] = None
    limb: Annotated[str | None, typer.Option(help="Its limb, by name or from 1.")] = None
    joint: Annotated[list[str] | None, typer.Option(metavar="NAME", help="Only this joint of the log; repeat it.")] = (
        None
    )
    columns: Annotated[
        list[str] | None,
        typer.Option(
            "--column",
            metavar="COLUMN=ROLE",
            help="What a column is, such as 'pos_3=left elbow angle (deg)'; repeat it.",
        ),
    ] = None
    time: Annotated[Column, typer.Option(metavar="COLUMN", help="The column of time.")] = None
    angle: Annotated[
        Column,
        typer.Option(metavar="COLUMN", help="Angle by the encoder, at the joint's scale; for a log of one joint."),
    ] = None
    torque: Annotated[Column, typer.Option(metavar="COLUMN", help="The motor's torque at the joint.")] = None
    current: Annotated[Column, typer.Option(metavar="COLUMN", help="The motor's current.")] = None
    command: Annotated[Column, typer.Option(metavar="COLUMN", help="The amplifier's command voltage.")] = None
    output_angle: Annotated[Column, typer.Option(metavar="COLUMN", help="Angle behind the gear.")] = None
    torque_constant: Annotated[
        str | None, typer.Option(help="Of the motors, such as 0.0138Nm/A; the robot's unless given.")
    ] = None
    gear: Annotated[float | None, typer.Option(help="Motor turns per joint turn; the robot's unless given.")] = None
    gain: Annotated[
        str | None, typer.Option(help="Of the amplifier, for voltages without currents, such as 0.27A/V.")
    ] = None
    upright: Annotated[bool, typer.Option("--upright", help="The links' weight acts: the limb hangs on a wall.")] = (
        False
    )
    topic: Annotated[str | None, typer.Option(help="Channel of an MCAP file.")] = None
    seed: Annotated[int, typer.Option(min=0, help="Of the bootstrap that tells errors.")] = 0
    output: Annotated[
        Path | None,
        typer.Option(
            "--output", "-o", metavar="FILE", help="A picture (.png, .svg, .pdf), or lines for a robot file (.toml)."
        ),
    ] = None
    as_json: AsJson = False

    def check(self) -> None:
        """Make sure that the output can be written before anything is computed."""
        check_writable(self.output)
        if self.output is not None:
            from ...viewing.output import CANVASES, check_suffix

            check_suffix(self.output, (".toml", *CANVASES))

    def mapping(self) -> dict[str, str]:
        """Which columns of the log are what."""
        from ...execution.log_columns import read_mapping

        chosen = {
            "time": self.time, "angle": self.angle, "torque": self.torque, "current": self.current, "command": self.command,
            "output angle": self.output_angle,
        }  # fmt: skip
        return read_mapping(self.columns or (), chosen)


@takes_words
def identify(
    log: Annotated[Path, typer.Argument(help="A log with named columns (.csv, .mcap).")],
    *,
    words: IdentifyWords,
) -> None:
    """Find each joint's inertia, damping, friction, amplifier gain and backlash from a log, with standard errors."""
    words.check()
    from ...execution.log_files import read_log
    from ...execution.log_identify import Known, identify_log
    from .identify_text import print_identification, write_identification

    mapping = words.mapping()
    known = Known.read(words.torque_constant, words.gear, words.gain)
    read = read_log(log, words.topic)
    announce_compilation(quiet=words.as_json)
    result = identify_log(
        read,
        robot=words.robot,
        limb=words.limb,
        mapping=mapping,
        joints=tuple(words.joint or ()),
        known=known,
        upright=words.upright,
        seed=words.seed,
    )
    if words.output is not None:
        write_identification(result, words.output)
    if words.as_json:
        print_json(result.to_json())
    else:
        print_identification(stdout(), result)
    raise typer.Exit(0 if result.complete else 1)
