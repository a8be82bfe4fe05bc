"""`clamber limb circle`: the aim runs round a circle; every law follows."""

from typing import Annotated

import typer

from . import limb_options as opt
from .options import AsJson, Output, Quiet


def circle(
    centre: Annotated[str, typer.Option(metavar="X,Y", help="Of the circle, port frame.")] = "22cm,0",
    radius: Annotated[str, typer.Option(help="Such as 5cm.")] = "5cm",
    lap: Annotated[float, typer.Option(help="Time of one lap [s].")] = 6.0,
    laps: Annotated[int, typer.Option(min=1, help="Laps; the last one is measured.")] = 2,
    controllers: opt.Controllers = None,
    kp: opt.Kp = None,
    kd: opt.Kd = None,
    match: opt.Matched = opt.MatchChoice.yy,
    reference: opt.Reference = "scct",
    robot: opt.Robot = "libra",
    limb: opt.LimbName = None,
    start: opt.Start = None,
    elbow: opt.Elbow = None,
    plant: opt.Plant = "mujoco",
    flaws: opt.Flaws = opt.FlawsChoice.ideal,
    settings: opt.Settings = None,
    seed: opt.Seed = None,
    trials: opt.Trials = 1,
    workers: opt.Workers = None,
    everything: opt.Everything = False,
    log: opt.Log = None,
    output: Output = None,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Let the aim run round a circle, and compare how far each law leaves it in the last lap."""
    telling = opt.Telling(output, log, as_json, quiet, everything)
    telling.check(".json", ".csv")
    from ..experiments.limb.points import read_number, read_point
    from ..experiments.limb.scenario import circle_scenario

    words = opt.BenchWords(
        controllers, kp, kd, match, reference, robot, limb, start, elbow, plant, flaws, settings, seed, trials, workers
    )
    properties = words.build_plant()
    middle, size = read_point("centre", centre), read_number("radius", radius, "length")
    chosen = words.build_limb(properties, (middle[0] + size, middle[1]))
    scenario = circle_scenario(chosen, properties.control_rate, centre=middle, radius=size, lap=lap, laps=laps)
    opt.run_bench(words, chosen, scenario, properties, telling)
