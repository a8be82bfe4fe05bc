"""`clamber limb identify` and `record`: a joint's inertia, friction, amplifier and play from a log; such a log from a simulated limb."""

from dataclasses import dataclass
from pathlib import Path
from textwrap import wrap
from typing import TYPE_CHECKING, Annotated, TypeAlias

import typer
from rich.console import Console

from ...terminal.name_completion import names_of
from ...terminal.options import ROBOT, AsJson, Flaws, FlawsChoice, Quiet, Settings, takes_options
from ...terminal.output import check_output, check_writable, print_json, stdout
from ...units import DEGREE
from . import options as opt

if TYPE_CHECKING:
    from ...control.identification.joint import IdentifiedJoint
    from ...control.identification.samples import Estimate
    from ...families.climber.execution.log_identify import Identification

WIDTH = 80
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

    def mapping(self) -> dict[str, str]:
        """Which columns of the log are what."""
        from ...execution.log_roles import read_mapping

        chosen = {
            "time": self.time,
            "angle": self.angle,
            "torque": self.torque,
            "current": self.current,
            "command": self.command,
            "output angle": self.output_angle,
        }
        return read_mapping(self.columns or (), chosen)


@takes_options
def identify(
    log: Annotated[Path, typer.Argument(help="A log with named columns (.csv, .mcap).")],
    *,
    words: IdentifyWords,
) -> None:
    """Find each joint's inertia, damping, friction, amplifier gain and backlash from a log, with standard errors."""
    check_output(words.output, ".toml")
    from ...execution.log_files import read_log
    from ...families.climber.execution.log_identify import Known, identify_log

    mapping = words.mapping()
    known = Known.read(words.torque_constant, words.gear, words.gain)
    read = read_log(log, words.topic)
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


def print_identification(console: Console, result: "Identification") -> None:
    """Print every joint's table and what had to be assumed."""
    whose = f": {result.limb} limb of {result.robot}" if result.robot else ""
    console.print(f"{result.log}{whose}", style="bold")
    for joint in result.joints:
        console.print()
        _print_joint(console, joint)
    for note in result.notes:
        console.print()
        for line in wrap(f"note: {note}", WIDTH, subsequent_indent="  "):
            console.print(line)


def _print_joint(console: Console, joint: "IdentifiedJoint") -> None:
    time = joint.samples.time
    console.print(f"{joint.samples.name}: {time.size} samples, {time[-1] - time[0]:.1f} s", style="bold")
    if joint.fit is not None and joint.fit.rows is not None:
        console.print(
            f"  torque from {joint.torque_from}; angle {joint.fit.lag * 1e3:.1f} ms behind it;"
            f" {joint.fit.residual:.2g} N m left over"
        )
    told = [estimate for estimate in joint.estimates if estimate.value is not None]
    if told:
        titles = ("  parameter", "value", "std error", "unit", "in the file", "diff")
        opt.show_table(console, titles, map(_cells, told), ("  parameter", "unit"))
    for estimate in joint.estimates:
        if estimate.value is None:
            line = f"{estimate.name}: not in this log: needs {estimate.needs}"
            for words in wrap(line, WIDTH - 2, subsequent_indent="  "):
                console.print(f"  {words}")
    rough = joint.rough
    if rough.damping is not None and rough.friction is not None:
        inertia = "" if rough.inertia is None else f"inertia {rough.inertia:.3g}, "
        console.print(
            f"  by {len(rough.episodes)} constant torques alone: {inertia}damping {rough.damping:.3g},"
            f" friction {rough.friction:.3g}"
        )


def _cells(estimate: "Estimate") -> tuple[str, ...]:
    scale, unit = (1.0 / DEGREE, "deg") if estimate.unit == "rad" else (1.0, estimate.unit)
    value, error = (estimate.value or 0.0) * scale, (estimate.error or 0.0) * scale
    stated = "" if estimate.stated is None else f"{estimate.stated * scale:.4g}"
    difference = "" if estimate.difference is None else f"{100 * estimate.difference:+.1f} %"
    return f"  {estimate.name}", f"{value:.4g}", f"{error:.2g}", unit, stated, difference


def write_identification(result: "Identification", path: Path) -> None:
    """Write a picture, or lines for a robot's file (.toml), as the suffix says.

    Raises:
        SuffixError: If the suffix names neither.
        FileError: If the file cannot be written.
    """
    if path.suffix.lower() == ".toml":
        from ...files import write_atomically

        write_atomically(path, result.toml())
        return
    from ...families.climber.pictures.identification import draw_identification

    draw_identification(result, path)


@dataclass(frozen=True, slots=True)
class SensorWords:
    """Options of the log's sensors, as they came."""

    current_noise: Annotated[float, typer.Option(help="Standard deviation of the current sensors' noise [A].")] = 0.01
    angle_noise: Annotated[str, typer.Option(help="Of the encoders' noise besides their steps, such as 0.01deg.")] = (
        "0deg"
    )
    output_noise: Annotated[str, typer.Option(help="Of the angles behind the gears, such as 0.02deg.")] = "0.02deg"
    output_encoder: Annotated[
        bool, typer.Option("--output-encoder/--no-output-encoder", help="Whether angles behind the gears are measured.")
    ] = True
    seed: Annotated[int, typer.Option(min=0, help="Of the noise.")] = 0


@takes_options
def record(
    limb: Annotated[str | None, typer.Argument(help="The limb, by name or from 1.")] = None,
    output: Annotated[
        Path, typer.Option("--output", "-o", metavar="FILE", help="The log to write (.csv, .mcap).")
    ] = Path("limb.csv"),
    robot: opt.Robot = ROBOT,
    flaws: Flaws = FlawsChoice.nominal,
    settings: Settings = None,
    *,
    sensors: SensorWords,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Simulate a limb whose joints are excited one by one, for `clamber limb identify`."""
    check_writable(output)
    from ...execution.log_files import check_log_suffix, write_log

    check_log_suffix(output)
    from ...limb_bench.bench_limb import bench_limb
    from ...limb_bench.excitation import Recorded, SensorNoise, record_log
    from ...sim.flaw_texts import named_flaws, read_flaws
    from ...units import parse_quantity

    noise = SensorNoise(
        angle=parse_quantity(sensors.angle_noise, "angle"),
        current=sensors.current_noise,
        output_angle=parse_quantity(sensors.output_noise, "angle"),
        seed=sensors.seed,
    )
    chosen = bench_limb(robot, limb)
    properties = read_flaws(named_flaws(flaws.value, chosen.robot), settings or ())
    if properties.upright:
        chosen = bench_limb(robot, limb, upright=True)
    log = record_log(chosen, properties, noise, output_encoder=sensors.output_encoder)
    write_log(log, output)
    summary = Recorded.of(log, output)
    if as_json:
        print_json(summary)
    else:
        stdout().print(f"{summary.file}: {summary.rows} samples, {summary.seconds:.1f} s, {', '.join(log.columns)}")
