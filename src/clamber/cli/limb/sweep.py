"""`clamber limb sweep`: laws over one or two properties of the plant or of the gains."""

from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING, Annotated

import typer
from rich.console import Console

from ...terminal.crew import CrewWords
from ...terminal.option_holder import takes_options
from ...terminal.output import announce_compilation
from . import options as opt

if TYPE_CHECKING:
    from ...limb_bench.sweep import LimbSweep

MARKS = "ABCDEFGHIJKLMNOPQRSTUVWXYZ"
"""Of laws in a map, in their order."""


class GainsChoice(StrEnum):
    """Where the gains come from of laws that state none."""

    matched = "matched"
    recommended = "recommended"


class ScenarioChoice(StrEnum):
    """What is asked of the limb."""

    step = "step"
    circle = "circle"
    push = "push"


@dataclass(frozen=True, slots=True)
class CommandWords:
    """What is asked of the limb at every point, and what is compared, as it came."""

    scenario: Annotated[ScenarioChoice, typer.Option(help="The command.")] = ScenarioChoice.circle
    measure: Annotated[str | None, typer.Option(help="What is compared, such as radial_rms or encoder.across_max.")] = (
        None
    )
    by: Annotated[str, typer.Option(metavar="DX,DY", help="The step.")] = "0,-2cm"
    radius: Annotated[str, typer.Option(help="Of the circle, about (22cm, 0).")] = "5cm"
    lap: Annotated[float, typer.Option(help="Time of one lap of the circle [s].")] = 3.0
    force: Annotated[str, typer.Option(metavar="FX,FY", help="The push.")] = "10N,0"


@takes_options
def sweep(
    vary: Annotated[
        list[str],
        typer.Option(
            metavar="KEY=LOW..HIGH:N",
            help="A property of the plant, or kp, kd (of the reference), gain (a factor on all), such as backlash=0deg..4deg:9.",
        ),
    ],
    *,
    command: CommandWords,
    laws: opt.LawWords,
    gains: Annotated[
        GainsChoice,
        typer.Option(help="Of laws without gains of their own: --match to the reference, or as `limb tune` found."),
    ] = GainsChoice.matched,
    limb: opt.NominalLimbWords,
    words: CrewWords,
) -> None:
    """Run laws at every point of a range: which is best where, and from where on each is unstable."""
    words.check()
    opt.check_output(words.output, ".csv")
    from ...limb_bench.sweep import BenchTexts, make_bench, run_limb_sweep
    from ...planning.axes import range_axis

    axes = [range_axis(text) for text in vary]
    bench = make_bench(BenchTexts(
        kind=command.scenario.value, measure=command.measure, by=command.by, radius=command.radius, lap=command.lap,
        force=command.force, laws=laws.controllers or (), kp=laws.kp, kd=laws.kd, match=laws.match.value, reference=laws.reference,
        robot=limb.robot, limb=limb.limb, start=limb.start, elbow=limb.elbow, flaws=limb.flaws.value,
        settings=limb.settings or (), recommended=gains is GainsChoice.recommended,
    ))  # fmt: skip
    announce_compilation(quiet=words.quiet)
    result = run_limb_sweep(bench, axes, opt.crew_of(words, "points"))
    opt.tell_batch(result, words, lambda console: print_limb_sweep(console, result))
    raise typer.Exit(0 if any(result.wins().values()) else 1)


def print_limb_sweep(console: Console, result: "LimbSweep") -> None:
    """Print a table over one axis, or a map of letters over two, and the boundaries."""
    from ...limb_bench.measures import measure_scale

    bench = result.bench
    unit = measure_scale(bench.measure)[1]
    over = " and ".join(axis.key for axis in result.axes)
    console.print(f"{bench.kind} over {over}: {bench.measure}{f' [{unit}]' if unit else ''}", style="bold")
    console.print(f"plant: {result.plant_words()}")
    console.print(f"gains: {result.gain_words()}")
    console.print()
    if len(result.axes) == 1:
        _print_rows(console, result)
    else:
        _print_map(console, result)
    console.print()
    _print_boundaries(console, result)


def _print_rows(console: Console, result: "LimbSweep") -> None:
    from ...limb_bench.measures import measure_scale

    axis = result.axes[0]
    heads = [f"{MARKS[k % len(MARKS)]}" for k in range(len(result.labels))]
    head = f"{axis.key}\n{axis.unit}" if axis.unit else axis.key
    rows = []
    scale = measure_scale(result.bench.measure)[0]
    assert axis.numbers is not None
    for k, point in enumerate(result.points):
        cells = []
        for cell in point.values():
            told = "never" if cell.value is None else f"{scale * cell.value:.2f}"
            cells.append(told if cell.steady else "unstable")
        rows.append((f"{axis.numbers[k]:.4g}", *cells, result.winner(k) or "none"))
    opt.show_table(console, (head, *heads, "best"), rows, ("best",))
    for mark, label in zip(heads, result.labels, strict=True):
        console.print(f"{mark}  {label}")


def _print_map(console: Console, result: "LimbSweep") -> None:
    """Letters of the winners; the first axis runs across, the second upwards."""
    across, up = result.axes
    assert across.numbers is not None and up.numbers is not None
    letters = {label: MARKS[k % len(MARKS)] for k, label in enumerate(result.labels)}
    for row in reversed(range(len(up.values))):
        winners = [result.winner(k * len(up.values) + row) for k in range(len(across.values))]
        told = " ".join("." if label is None else letters[label] for label in winners)
        console.print(f"{up.numbers[row]:>9.4g}  {told}")
    ends = f"{across.numbers[0]:.4g} to {across.numbers[-1]:.4g} {across.unit}".rstrip()
    console.print(f"{up.key:>9}  {across.key}: {ends}")
    console.print()
    for label, count in result.wins().items():
        console.print(f"{letters[label]}  {label}: best at {count} of {len(result.points)} points")
    console.print(".  none is stable")


def _print_boundaries(console: Console, result: "LimbSweep") -> None:
    if result.scan is None:
        console.print("no boundaries: nothing varies that can be divided")
        return
    axis = next(axis for axis in result.axes if axis.key == result.scan)
    unit = f" {axis.unit}" if axis.unit else ""
    for label in result.labels:
        mine = [each for each in result.boundaries if each.label == label]
        if not mine:
            steady = [point[label].steady for point in result.points]
            what = "stable throughout" if all(steady) else "unstable throughout" if not any(steady) else "no boundary"
            console.print(f"{label}: {what}" + ("" if len(set(steady)) == 1 else f" along {axis.key}"))
            continue
        ends = sorted(each.at for each in mine)
        words = f"{ends[0]:.4g}" if len(ends) == 1 else f"{ends[0]:.4g} to {ends[-1]:.4g}"
        side = {each.steady_below for each in mine}
        what = "stable below" if side == {True} else "stable above" if side == {False} else "stable between"
        console.print(f"{label}: {what} {axis.key} = {words}{unit}")
