"""`clamber limb record`: excite a simulated limb's joints and keep the log."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from ...terminal.option_holder import takes_options
from ...terminal.options import ROBOT, AsJson, Flaws, FlawsChoice, Quiet, Settings
from ...terminal.output import announce_compilation, check_writable, print_json, stdout
from . import options as opt


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
    from ...families.climber.sim.flaw_texts import named_flaws, read_flaws
    from ...limb_bench.bench_limb import bench_limb
    from ...limb_bench.excitation import SensorNoise, log_summary, record_log
    from ...units import parse_quantity

    noise = SensorNoise(
        angle=parse_quantity(sensors.angle_noise, "angle"), current=sensors.current_noise,
        output_angle=parse_quantity(sensors.output_noise, "angle"), seed=sensors.seed,
    )  # fmt: skip
    chosen = bench_limb(robot, limb)
    properties = read_flaws(named_flaws(flaws.value, chosen.robot), settings or ())
    if properties.upright:
        chosen = bench_limb(robot, limb, upright=True)
    announce_compilation(quiet=quiet)
    log = record_log(chosen, properties, noise, output_encoder=sensors.output_encoder)
    write_log(log, output)
    summary = log_summary(log, output)
    if as_json:
        print_json(summary)
    else:
        stdout().print(
            f"{summary['file']}: {summary['rows']} samples, {summary['seconds']:.1f} s, {', '.join(log.columns)}"
        )
