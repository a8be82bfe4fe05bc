"""`clamber limb force`: a force on a wall, held standing and sliding, with each way to deal with joint friction."""

from typing import Annotated

import typer

from ..options import ROBOT, AsJson, Output, Quiet
from ..output import announce_compilation
from . import options as opt


def force(
    controllers: Annotated[
        list[str] | None,
        typer.Option("--controller", "-c", help="hybrid, implicit-force or admittance; repeat it. All unless given."),
    ] = None,
    compensations: Annotated[
        list[str] | None,
        typer.Option(
            "--friction-compensation",
            metavar="WAY",
            help="none, model, integral (of the wrist's force), wrist or base (torque loops), wrist+model or base+model; repeat it.",
        ),
    ] = None,
    size: Annotated[str, typer.Option("--force", help="Into the wall.")] = "20N",
    angle: Annotated[str, typer.Option(help="Direction into the wall, from the limb's x axis.")] = "90deg",
    stiffness: Annotated[str, typer.Option(help="Of the wall.")] = "10N/mm",
    wall_friction: Annotated[
        float, typer.Option(min=0.0, help="Friction coefficient of the wall; a slip chatters.")
    ] = 0.0,
    believed_angle: Annotated[str | None, typer.Option(help="What the laws take for the angle.")] = None,
    believed_stiffness: Annotated[str | None, typer.Option(help="What they take for the stiffness.")] = None,
    slide: Annotated[str, typer.Option(help="Way along the wall at full force.")] = "3cm",
    gap: Annotated[str, typer.Option(help="From the start to the wall.")] = "2mm",
    tolerance: Annotated[str, typer.Option(help="Largest error of a force that is held.")] = "1N",
    robot: opt.Robot = ROBOT,
    limb: opt.LimbName = None,
    start: opt.Start = None,
    elbow: opt.Elbow = None,
    flaws: opt.Flaws = opt.FlawsChoice.ideal,
    settings: opt.Settings = None,
    seed: opt.Seed = None,
    log: opt.Log = None,
    output: Output = None,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Press on a wall, stand, slide along it and stand again: who holds the force, and how joint friction is dealt with."""
    telling = opt.Telling(output, log, as_json, quiet)
    telling.check(".json")
    from ...limb_bench.force_entries import force_entries
    from ...limb_bench.force_result import run_force
    from ...limb_bench.force_scenario import ForceTask
    from ...limb_bench.points import read_number
    from .force_text import print_force_result, write_force_result

    task = ForceTask(
        force=read_number("force", size, "force"),
        angle=read_number("angle", angle, "angle"),
        stiffness=read_number("stiffness", stiffness, "stiffness"),
        friction=wall_friction,
        believed_angle=None if believed_angle is None else read_number("believed angle", believed_angle, "angle"),
        believed_stiffness=None
        if believed_stiffness is None
        else read_number("believed stiffness", believed_stiffness, "stiffness"),
        slide=read_number("slide", slide, "length"),
        gap=read_number("gap", gap, "length"),
        tolerance=read_number("tolerance", tolerance, "force"),
    )
    words = opt.BenchWords(robot=robot, limb=limb, start=start, elbow=elbow, flaws=flaws, settings=settings, seed=seed)
    properties = words.build_plant()
    announce_compilation(quiet=quiet)
    chosen = words.build_limb(properties)
    entries = force_entries(chosen, task, properties, controllers or (), compensations or ())
    result = run_force(chosen, task, entries, properties)
    telling.tell(
        result, lambda path: write_force_result(result, path), lambda console: print_force_result(console, result)
    )
    raise typer.Exit(0 if result.held else 1)
