"""`clamber limb sweep` and `tune`: laws over ranges of plants and gains, and their largest stable gains."""

import math
from dataclasses import asdict, dataclass
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Final

import typer
from rich.console import Console

from ...terminal.name_completion import names_of
from ...terminal.options import takes_options
from ...terminal.output import check_output, check_writable
from ...terminal.worker_options import WorkerOptions
from . import options as opt

if TYPE_CHECKING:
    from ...control.law_settings import LawSettings
    from ...limb_bench.scenario import MotionKind
    from ...limb_bench.sweep import LimbSweep
    from ...limb_bench.sweep_point import Bench
    from ...limb_bench.tune import Tuning
    from ...types import Json

CENTRE: Final = (0.22, 0.0)
"""Of circles, and where other motions start [m]."""
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
    words: WorkerOptions,
) -> None:
    """Run laws at every point of a range: which is best where, and from where on each is unstable."""
    words.check()
    check_output(words.output, ".csv")
    from ...limb_bench.sweep import run_limb_sweep
    from ...planning.axes import range_axis

    axes = [range_axis(text) for text in vary]
    bench = make_bench(command, laws, limb, recommended=gains is GainsChoice.recommended)
    with words.keeping("points") as batch:
        result = run_limb_sweep(bench, axes, opt.crew_of(words, batch))
    opt.tell_batch(result, words, lambda console: print_limb_sweep(console, result))
    raise typer.Exit(0 if any(result.wins().values()) else 1)


def make_bench(command: CommandWords, laws: opt.LawWords, limb: opt.LimbWords, *, recommended: bool = False) -> "Bench":
    """A bench from words.

    Args:
        command: What is asked of the limb.
        laws: What is compared.
        limb: Which one, and its plant.
        recommended: Whether laws without gains have those found by tuning.

    Raises:
        PointError, PlantError, LawError: If a word cannot be read, or its value is not allowed.
        UnknownNameError: If there is no such robot, law, set of flaws or measure.
    """
    from ...control.law_settings import LAWS
    from ...limb_bench.bench_limb import read_elbow
    from ...limb_bench.entries import reference_law, with_recommended_gains
    from ...limb_bench.sweep import chosen_measure
    from ...limb_bench.sweep_point import Bench
    from ...units import read_number, read_point

    kind: MotionKind = command.scenario.value
    measure = chosen_measure(kind, command.measure)
    plant = limb.build_plant()
    law = reference_law(laws.reference, laws.kp, laws.kd)
    size = read_number("radius", command.radius, "length")
    asked: Json
    if kind == "step":
        asked = dict(zip(("dx", "dy"), read_point("by", command.by), strict=True))
    elif kind == "circle":
        asked = {"centre": CENTRE, "radius": size, "lap": command.lap}
    else:
        asked = {"force": read_point("force", command.force, "force")}
    names = tuple(laws.controllers or ())
    usual = (CENTRE[0] + size, CENTRE[1]) if kind == "circle" else CENTRE
    start = usual if limb.start is None else read_point("start", limb.start)
    if recommended:
        names = tuple(with_recommended_gains(limb.build_limb(plant, usual), names or tuple(LAWS)))
    return Bench(
        robot=limb.robot,
        limb=limb.limb,
        start=start,
        elbow=read_elbow(limb.elbow),
        kind=kind,
        command=asked,
        laws=names,
        reference=law.law,
        kp=_one(law, "kp"),
        kd=_one(law, "kd"),
        match=laws.match.value,
        measure=measure,
        flaws=asdict(plant),
    )


def _one(law: "LawSettings", key: str) -> float:
    from ...control.law_settings import LawError

    value = getattr(law, key)
    if isinstance(value, tuple):
        raise LawError(law.law, key, value, "must be one number for all directions in a sweep")
    return float(value)


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


HEADS = {
    "kp": "kp",
    "kd": "kd",
    "limit": "limit\nkp",
    "linear": "of\nlinear",
    "kxx": "Kxx\nN/mm",
    "kyy": "Kyy\nN/mm",
    "cycle": "p-p\nmm",
    "over": "over\n%",
    "iae": "IAE\nmm s",
}


@takes_options
def tune(
    controllers: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="[NAME[:KEY=VALUE,...]]...",
            help="Laws without their gains; all of them unless given.",
            autocompletion=names_of("controllers"),
        ),
    ] = None,
    margin: Annotated[float, typer.Option(help="Largest stable gains over the recommended ones; 2 is 6 dB.")] = 2.0,
    save: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Put the recommended gains into this TOML file; others in it stay."),
    ] = None,
    *,
    limb: opt.NominalLimbWords,
    words: WorkerOptions,
) -> None:
    """Find the largest gains at which the limb comes to rest after steps, circles and pushes, and recommend some below."""
    words.check()
    check_writable(save)
    check_output(words.output)
    from ...control.recommended import read_recommended, save_recommended
    from ...limb_bench.tune import tune as find
    from ...regular_files import is_there

    if save is not None and is_there(save):
        read_recommended(save)
    plant = limb.build_plant()
    chosen = limb.build_limb(plant)
    laws = [] if controllers in (None, ["all"]) else list(controllers or ())
    with words.keeping("searches") as batch:
        result = find(chosen, laws, plant, robot=limb.robot, margin=margin, crew=opt.crew_of(words, batch))
    if save is not None:
        save_recommended(result.recommended(), save)
    opt.tell_batch(result, words, lambda console: print_tuning(console, result), save)
    raise typer.Exit(0 if result.steady else 1)


def print_tuning(console: Console, result: "Tuning") -> None:
    """Print what was found."""
    from ...limb_bench.stability import QUIET_FROM, STEADY
    from ...sim.flaw_texts import plant_words

    limb = result.limb
    console.print(f"recommended gains, {limb.robot.name}'s {limb.name} limb", style="bold")
    console.print(f"plant: {plant_words(result.flaws)}")
    console.print(
        f"margin: the limb comes to rest, within {1e3 * STEADY:g} mm after {QUIET_FROM:g} s, up to {result.margin:g} times the gains"
    )
    console.print()
    rows = [
        (
            law.law,
            f"{law.kp:.4g}",
            f"{law.kd:.3g}",
            f"{law.limit_kp:.4g}",
            f"{law.limit_kp / law.linear_kp:.2f}",
            *(f"{value / 1e3:.1f}" for value in law.stiffness),
            f"{1e3 * law.peak_to_peak:.2f}" if math.isfinite(law.peak_to_peak) else "lost",
            f"{100 * law.overshoot:.0f}",
            f"{1e3 * law.iae:.2f}",
        )
        for law in result.laws
    ]
    opt.show_table(console, ("law", *HEADS.values()), rows)
    console.print()
    console.print(
        "kp, kd: N m/rad, N m s/rad; of jacobian-transpose N/m, N s/m;\n        of operational-space 1/s^2, 1/s"
    )
    console.print("of linear: limit kp over that of the linear loop; K: of the tip at the start")
    console.print(
        "p-p: true tip at rest, worst run; over: worst step of 2 cm, by encoders;\nIAE: of a step of 2 cm in -y"
    )
    for law in result.laws:
        if not law.steady:
            console.print(f"{law.law}: does not come to rest at these gains: {law.situation}", soft_wrap=True)
