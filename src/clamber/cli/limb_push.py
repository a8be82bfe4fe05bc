"""`clamber limb push`: a force on the tip; every law holds against it."""

from typing import Annotated

import typer

from . import limb_options as opt
from .options import AsJson, Output, Quiet


def push(
    force: Annotated[str, typer.Option(metavar="FX,FY", help="On the tip, such as 10N,0.")] = "10N,0",
    begin: Annotated[float, typer.Option("--from", help="When the push begins [s].")] = 0.5,
    end: Annotated[float, typer.Option("--to", help="When it ends [s].")] = 2.0,
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
    """Push the tip and let it go, and compare how far each law yields, where to, and how it comes back."""
    telling = opt.Telling(output, log, as_json, quiet, everything)
    telling.check(".json", ".csv")
    from ..experiments.limb.points import read_point
    from ..experiments.limb.scenario import push_scenario

    words = opt.BenchWords(
        controllers, kp, kd, match, reference, robot, limb, start, elbow, plant, flaws, settings, seed, trials, workers
    )
    properties = words.build_plant()
    chosen = words.build_limb(properties)
    pushed = read_point("force", force, "force")
    scenario = push_scenario(chosen, properties.control_rate, force=pushed, start=begin, end=end, seconds=seconds)
    opt.run_bench(words, chosen, scenario, properties, telling)
