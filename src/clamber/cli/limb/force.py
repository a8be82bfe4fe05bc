"""`clamber limb force` and `open-loop`: a force on a wall, held standing and sliding; steady torques, and where the tip goes first."""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

import typer
from rich.console import Console

from ...terminal.options import takes_options
from . import options as opt

if TYPE_CHECKING:
    from ...limb_bench.force import ForceResult
    from ...limb_bench.open_loop import OpenLoopResult
    from ...limb_bench.scenario import ForceTask

TITLES = ("mean\nN", "stand\nN", "slide\nN", "worst\nN", "touch\n%", "off\nmm", "work\nJ", "held")


@dataclass(frozen=True, slots=True)
class WallWords:
    """The wall and what is asked of the limb there, as it came."""

    size: Annotated[str, typer.Option("--force", help="Into the wall.")] = "20N"
    angle: Annotated[str, typer.Option(help="Direction into the wall, from the limb's x axis.")] = "90deg"
    stiffness: Annotated[str, typer.Option(help="Of the wall.")] = "10N/mm"
    wall_friction: Annotated[
        float, typer.Option(min=0.0, help="Friction coefficient of the wall; a slip chatters.")
    ] = 0.0
    believed_angle: Annotated[str | None, typer.Option(help="What the laws take for the angle.")] = None
    believed_stiffness: Annotated[str | None, typer.Option(help="What they take for the stiffness.")] = None
    slide: Annotated[str, typer.Option(help="Way along the wall at full force.")] = "3cm"
    gap: Annotated[str, typer.Option(help="From the start to the wall.")] = "2mm"
    tolerance: Annotated[str, typer.Option(help="Largest error of a force that is held.")] = "1N"

    def build_task(self) -> "ForceTask":
        """What is asked."""
        from ...limb_bench.scenario import ForceTask
        from ...units import read_number

        told = {
            "force": (self.size, "force"),
            "angle": (self.angle, "angle"),
            "stiffness": (self.stiffness, "stiffness"),
            "believed angle": (self.believed_angle, "angle"),
            "believed stiffness": (self.believed_stiffness, "stiffness"),
            "slide": (self.slide, "length"),
            "gap": (self.gap, "length"),
            "tolerance": (self.tolerance, "force"),
        }
        numbers = {
            key.replace(" ", "_"): read_number(key, text, dimension)
            for key, (text, dimension) in told.items()
            if text is not None
        }
        return ForceTask(friction=self.wall_friction, **numbers)


@takes_options
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
    *,
    wall: WallWords,
    words: opt.LimbWords,
    seed: opt.Seed = None,
    files: opt.FileWords,
) -> None:
    """Press on a wall, stand, slide along it and stand again: who holds the force, and how joint friction is dealt with."""
    files.check(".json")
    from ...limb_bench.force import force_entries, run_force

    task = wall.build_task()
    flaws = words.build_plant(seed)
    limb = words.build_limb(flaws)
    result = run_force(limb, task, force_entries(limb, task, flaws, controllers or (), compensations or ()), flaws)
    files.tell(result, lambda console: print_force_result(console, result))
    raise typer.Exit(0 if result.held else 1)


def print_force_result(console: Console, result: "ForceResult") -> None:
    """Print how well each law held the force."""
    console.print(f"{result.title()}, {result.limb.robot.name}'s {result.limb.name} limb", style="bold")
    console.print(f"plant: {result.plant_words()}")
    if result.belief_words():
        console.print(result.belief_words())
    console.print()
    rows = []
    for row in result.rows:
        m = row.measures
        errors = (f"{value + 0.0:.2f}" for value in (m.mean_error, m.worst_standing, m.worst_sliding, m.worst))
        held = "yes" if m.held else "lost" if m.contact < 1.0 else "no"
        off, work = f"{1e3 * m.off_line:.2f}", f"{m.work:.2f}"
        rows.append((row.entry.label, *errors, f"{100 * m.contact:.1f}", off, work, held))
    opt.show_table(console, ("law / friction", *TITLES), rows, ("law / friction", "held"))
    console.print()
    console.print("errors of the true force, after it has settled: mean; largest while standing")
    console.print("and while sliding; worst, with the slide's start and end; off: along the wall")
    console.print(f"held: none beyond {result.task.tolerance:g} N, and the tip never off the wall")


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
            opt.shown(run.predicted, degrees),
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
