"""`clamber limb open-loop`: steady torques, and where the tip goes first."""

from typing import Annotated

import typer

from ..options import ROBOT, AsJson, Output, Quiet
from ..output import announce_compilation
from . import options as opt


def open_loop(
    force: Annotated[str, typer.Option(help="Along the wanted direction, such as 10N.")] = "10N",
    direction: Annotated[str, typer.Option(help="Wanted, from the x axis of the port, such as -90deg.")] = "-90deg",
    seconds: Annotated[float, typer.Option(help="Length of the run [s].")] = 0.7,
    transforms: Annotated[
        list[str] | None,
        typer.Option("--controller", "-c", metavar="NAME", help="A law whose transform is used; repeat it. All four."),
    ] = None,
    renewed: Annotated[
        bool, typer.Option("--renewed", help="Let the torques follow the pose instead of standing still.")
    ] = False,
    robot: opt.Robot = ROBOT,
    limb: opt.LimbName = None,
    start: opt.Start = None,
    elbow: opt.Elbow = None,
    plant: opt.Plant = "mujoco",
    flaws: opt.Flaws = opt.FlawsChoice.ideal,
    settings: opt.Settings = None,
    seed: opt.Seed = None,
    log: opt.Log = None,
    output: Output = None,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Put steady torques on the limb at rest, and compare in which direction each law's transform starts the tip."""
    telling = opt.Telling(output, log, as_json, quiet)
    telling.check(".json")
    from ...limb_bench.open_loop import TRANSFORMS
    from ...limb_bench.open_loop_result import compare_open_loop
    from ...limb_bench.points import read_number
    from .open_loop_text import print_open_loop, write_open_loop

    words = opt.BenchWords(
        robot=robot, limb=limb, start=start, elbow=elbow, plant=plant, flaws=flaws, settings=settings, seed=seed
    )
    properties = words.build_plant()
    chosen = words.build_limb(properties)
    size, angle = read_number("force", force, "force"), read_number("direction", direction, "angle")
    announce_compilation(quiet=quiet)
    result = compare_open_loop(
        chosen, properties, transforms or tuple(TRANSFORMS), force=size, direction=angle, seconds=seconds,
        renewed=renewed, plant=plant,
    )  # fmt: skip
    telling.tell(result, lambda path: write_open_loop(result, path), lambda console: print_open_loop(console, result))
    raise typer.Exit(0 if result.moved else 1)
