"""`clamber limb open-loop`: steady torques, and where the tip goes first."""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

import typer
from rich.console import Console

from ...terminal.option_holder import takes_options
from ...terminal.output import announce_compilation
from . import options as opt

if TYPE_CHECKING:
    from ...limb_bench.open_loop import OpenLoopResult


@dataclass(frozen=True, slots=True)
class PullWords:
    """What the torques are to do at the tip, as it came."""

    force: Annotated[str, typer.Option(help="Along the wanted direction, such as 10N.")] = "10N"
    direction: Annotated[str, typer.Option(help="Wanted, from the x axis of the port, such as -90deg.")] = "-90deg"
    seconds: Annotated[float, typer.Option(help="Length of the run [s].")] = 0.7
    transforms: Annotated[
        list[str] | None,
        typer.Option("--controller", "-c", metavar="NAME", help="A law whose transform is used; repeat it. All four."),
    ] = None
    renewed: Annotated[
        bool, typer.Option("--renewed", help="Let the torques follow the pose instead of standing still.")
    ] = False


@takes_options
def open_loop(
    *,
    pull: PullWords,
    words: opt.LimbWords,
    plant: opt.Plant = "mujoco",
    seed: opt.Seed = None,
    files: opt.FileWords,
) -> None:
    """Put steady torques on the limb at rest, and compare in which direction each law's transform starts the tip."""
    files.check(".json")
    from ...limb_bench.open_loop import TRANSFORMS, compare_open_loop
    from ...units import read_number

    flaws = words.build_plant(seed)
    limb = words.build_limb(flaws)
    how = {"force": read_number("force", pull.force, "force")}
    how["direction"] = read_number("direction", pull.direction, "angle")
    announce_compilation(quiet=files.quiet)
    transforms = pull.transforms or tuple(TRANSFORMS)
    result = compare_open_loop(limb, flaws, transforms, seconds=pull.seconds, renewed=pull.renewed, plant=plant, **how)
    files.tell(result, lambda console: print_open_loop(console, result))
    raise typer.Exit(0 if result.moved else 1)


def print_open_loop(console: Console, result: "OpenLoopResult") -> None:
    """Print how each transform's torques start the tip, and where it strays."""
    from ...limb_bench.open_loop import FAR, FIRST

    limb, degrees = result.limb, math.degrees(1.0)
    asked = f"{result.runs[0].force:g} N along {math.degrees(result.direction):g} deg"
    whose = f"{limb.robot.name}'s {limb.name} limb from ({opt.shown_place(limb.start)}) mm"
    console.print(f"open loop, {asked}, {whose}", style="bold")
    kind = "follow the pose" if result.renewed else "stand still"
    console.print(f"plant: {result.plant_words()}; torques {kind}")
    console.print()
    titles = ("torques\nN m", "first off\ndeg", "told*\ndeg", *(f"at {1e3 * far:g} mm\nmm" for far in FAR), "moved\nmm")
    rows = [
        (
            run.transform,
            " ".join(opt.shown(float(torque)) for torque in run.torques),
            opt.shown(run.turned(), degrees),
            opt.shown(result.predicted(run), degrees),
            *(opt.shown(run.stray(far), 1e3) for far in FAR),
            opt.shown(run.moved, 1e3),
        )
        for run in result.runs
    ]
    opt.show_table(console, ("law", *titles), rows)
    console.print()
    console.print(
        f"first off: the tip's first {1e3 * FIRST:g} mm from the wanted direction, anticlockwise positive; "
        "then how far left of it the tip is after so much of the way; * by the dynamics without friction"
    )
    if not result.moved:
        console.print(f"no transform moves the tip by {1e3 * FIRST:g} mm: friction holds it")
