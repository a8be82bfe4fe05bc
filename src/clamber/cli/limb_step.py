"""`clamber limb step`: the aim jumps; every law follows."""

from typing import Annotated

import typer

from . import limb_options as opt
from .options import AsJson, Output, Quiet


def step(
    by: Annotated[str, typer.Option(metavar="DX,DY", help="The step, such as 0,-2cm.")] = "0,-2cm",
    seconds: Annotated[float, typer.Option(help="Length of the run [s].")] = 6.0,
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
    """Let the aim jump, and compare how each law gets there: along the step, across it, at rest."""
    telling = opt.Telling(output, log, as_json, quiet, everything)
    telling.check(".json", ".csv")
    from ..experiments.limb.points import read_point
    from ..experiments.limb.scenario import step_scenario

    words = opt.BenchWords(
        controllers, kp, kd, match, reference, robot, limb, start, elbow, plant, flaws, settings, seed, trials, workers
    )
    properties = words.build_plant()
    chosen = words.build_limb(properties)
    dx, dy = read_point("by", by)
    scenario = step_scenario(chosen, properties.control_rate, dx=dx, dy=dy, seconds=seconds)
    opt.run_bench(words, chosen, scenario, properties, telling)
