"""`clamber limb`: its commands; `step`, `circle` and `push`, laws compared by one motion of the limb, as a table and a small plot."""

import math
import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any, Final

import typer
from rich.console import Console

from ...terminal.options import takes_options
from ...terminal.output import stderr
from ...terminal.worker_options import EndsLine
from ...units import read_number, read_point
from . import options as opt
from .force import force, open_loop
from .identify import identify, record
from .portrait import portrait
from .sweep import sweep, tune

if TYPE_CHECKING:
    from ...limb_bench.measures import Measures
    from ...limb_bench.result import LimbResult, Row
    from ...limb_bench.scenario import MotionKind
    from ...types import Floats

LEAST_TRIALS: Final = 4
"""A worker process is worth its start for so many trials."""
COLUMNS: Final = {
    "across_max": "across max",
    "across_rms": "across rms",
    "along_max": "along max",
    "radial_rms": "radial rms",
    "radial_max": "radial max",
    "lag": "behind",
    "overshoot": "over",
    "settling": "settled",
    "on_aim": "on aim",
    "rest": "rest off",
    "cycle": "cycle",
    "iae": "IAE",
    "work": "work",
    "heat": "heat",
    "saturated": "at limit",
    "tick": "tick*",
}
"""Measure -> title of its column."""
ONE_DIGIT: Final = ("overshoot", "saturated", "tick")
"""Measures that are shown to a tenth of their unit."""
OF_RUN: Final = ("work", "heat", "saturated", "tick")
"""Measures that are not of the tip, so that truth and encoders do not differ."""
TELLING: Final = {
    "step": ("across_max", "across_rms", "overshoot", "settling", "rest", "cycle"),
    "circle": ("radial_rms", "radial_max", "lag", "iae", "work", "saturated"),
    "push": ("along_max", "across_max", "settling", "rest", "cycle"),
}
"""Scenario -> what tells laws apart."""
MORE: Final = {
    "step": ("on_aim", "iae", "work", "heat", "saturated", "tick"),
    "circle": ("heat", "tick"),
    "push": ("across_rms", "on_aim", "iae", "work", "heat", "saturated", "tick"),
}
"""Scenario -> the other measures, in a second table."""
BLOCKS: Final = " ▁▂▃▄▅▆▇█"


@dataclass(frozen=True)
class BenchWords(opt.LimbWords):
    """Options of every command that compares laws by one motion of the limb, as they came."""

    plant: opt.Plant = "mujoco"
    seed: opt.Seed = None
    trials: Annotated[int, typer.Option(min=1, help="Plants that are drawn, from the seed on.")] = 1
    workers: Annotated[
        int | None, typer.Option(min=1, help="Processes for the trials; one a core unless given, where there are many.")
    ] = None
    everything: Annotated[bool, typer.Option("--all", help="Print every measure, and the gains.")] = False

    @property
    def crew(self) -> int:
        """Worker processes: as many as asked for, else one a core, but none for so few trials that its start takes longer."""
        return self.workers or max(1, min(os.cpu_count() or 1, self.trials // LEAST_TRIALS))


@dataclass(frozen=True)
class MotionWords(opt.FileWords, BenchWords, opt.LawWords):
    """All of them but those of the motion itself: laws, limb and plant, files."""


@takes_options
def step(
    by: Annotated[str, typer.Option(metavar="DX,DY", help="The step, such as 0,-2cm.")] = "0,-2cm",
    seconds: Annotated[float, typer.Option(help="Length of the run [s].")] = 6.0,
    *,
    words: MotionWords,
) -> None:
    """Let the aim jump, and compare how each law gets there: along the step, across it, at rest."""
    words.check(".json", ".csv")
    dx, dy = read_point("by", by)
    _compare(words, "step", dx=dx, dy=dy, seconds=seconds)


@takes_options
def circle(
    centre: Annotated[str, typer.Option(metavar="X,Y", help="Of the circle, port frame.")] = "22cm,0",
    radius: Annotated[str, typer.Option(help="Such as 5cm.")] = "5cm",
    lap: Annotated[float, typer.Option(help="Time of one lap [s].")] = 6.0,
    laps: Annotated[int, typer.Option(min=1, help="Laps; the last one is measured.")] = 2,
    *,
    words: MotionWords,
) -> None:
    """Let the aim run round a circle, and compare how far each law leaves it in the last lap."""
    words.check(".json", ".csv")
    middle, size = read_point("centre", centre), read_number("radius", radius, "length")
    _compare(words, "circle", (middle[0] + size, middle[1]), centre=middle, radius=size, lap=lap, laps=laps)


@takes_options
def push(
    force: Annotated[str, typer.Option(metavar="FX,FY", help="On the tip, such as 10N,0.")] = "10N,0",
    begin: Annotated[float, typer.Option("--from", help="When the push begins [s].")] = 0.5,
    end: Annotated[float, typer.Option("--to", help="When it ends [s].")] = 2.0,
    seconds: Annotated[float, typer.Option(help="Length of the run [s].")] = 6.0,
    *,
    words: MotionWords,
) -> None:
    """Push the tip and let it go, and compare how far each law yields, where to, and how it comes back."""
    words.check(".json", ".csv")
    pushed = read_point("force", force, "force")
    _compare(words, "push", force=pushed, start=begin, end=end, seconds=seconds)


def _compare(words: MotionWords, kind: "MotionKind", at_first: tuple[float, float] = (0.22, 0.0), **how: Any) -> None:
    """Run the laws, the tip `at_first` there unless a start is said, write and print what came out, and leave with the exit code."""
    from ...limb_bench.entries import make_entries, match_pose, reference_law
    from ...limb_bench.result import Matching, compare_laws
    from ...limb_bench.runner import Contest
    from ...limb_bench.scenario import MOTIONS

    flaws = words.build_plant(words.seed, drawn=words.trials > 1)
    limb = words.build_limb(flaws, at_first)
    scenario = MOTIONS[kind](limb, flaws.control_rate, **how)
    reference, at = reference_law(words.reference, words.kp, words.kd), match_pose(limb, scenario)
    entries = make_entries(limb, words.controllers or (), reference, words.match.value, at)
    with EndsLine(stderr(), "trials", quiet=words.quiet or words.trials == 1) as line:
        result = compare_laws(
            Contest(limb, scenario, entries, flaws, words.plant),
            trials=words.trials,
            workers=words.crew,
            matching=Matching(reference, words.match.value, at),
            progress=line.update,
        )
    words.tell(result, lambda console: print_comparison(console, result, everything=words.everything))
    raise typer.Exit(0 if result.stable else 1)


def print_comparison(console: Console, result: "LimbResult", *, everything: bool) -> None:
    """Print how the laws compare."""
    kind, limb = result.scenario.kind, result.limb
    place = f"from ({opt.shown_place(limb.start)}) mm"
    console.print(f"{result.title()}, {limb.robot.name}'s {limb.name} limb {place}", style="bold")
    trials = "" if result.trials == 1 else f"; {result.trials} trials, mean and worst"
    console.print(f"plant: {result.plant_words()}{trials}")
    console.print(f"gains: {result.match_words()}")
    console.print()
    _print_measures(console, result, TELLING[kind])
    from ...control.law_settings import law_names

    others = set(law_names()) - {row.run.entry.settings.law for row in result.rows}
    if others and kind == "circle":
        console.print(f"laws that are not shown, each by -c NAME: {', '.join(sorted(others))}")
    if everything:
        console.print()
        _print_measures(console, result, MORE[kind])
        console.print("* called from Python on this machine; no two runs give the same")
        console.print()
        _print_gains(console, result)
    console.print()
    _print_lines(console, result)
    for label in result.matching.not_matched:
        console.print(f"{label}: one gain for all directions, so '{result.matching.how}' does not hold for it")
    stops = "has" if result.flaws.joint_limits else "has no"
    for name, excess in result.beyond_limits().items():
        console.print(f"the {name} turned {math.degrees(excess):.1f} deg beyond its limit; the plant {stops} stops")


def _print_measures(console: Console, result: "LimbResult", keys: Sequence[str]) -> None:
    from ...limb_bench.measures import measure_scale

    titles = [f"{COLUMNS[key]}\n{measure_scale(key)[1]}" for key in keys]
    rows: list[Sequence[str]] = []
    for row in result.rows:
        if row.unstable == result.trials:
            when = min(each.unstable_at for each in row.measures if each.unstable_at is not None)
            rows.append((row.entry.label, "unstable", f"from {when:.1f} s"))
            continue
        label = row.entry.label + (f" ({row.unstable} of {result.trials} unstable)" if row.unstable else "")
        rows.append((label, *_cells(row, keys, "true", _mean)))
        if result.trials > 1:
            rows.append(("  worst", *_cells(row, keys, "true", max)))
        if result.imperfect and any(key not in OF_RUN for key in keys):
            rows.append(("  by encoders", *_cells(row, keys, "encoder", _mean)))
    opt.show_table(console, ("law", *titles), rows)


def _mean(values: Sequence[float]) -> float:
    import numpy as np

    return float(np.mean(values))


def _cells(row: "Row", keys: Sequence[str], side: str, how: Callable[[Sequence[float]], float]) -> list[str]:
    from ...limb_bench.measures import measure_scale

    out = []
    for key in keys:
        if side == "encoder" and key in OF_RUN:
            out.append("")
            continue

        def pick(each: "Measures", key: str = key) -> Any:
            return getattr(each if key in OF_RUN else getattr(each, side), key)

        values = row.values(pick)
        value = how(values) if values else None
        never = value is not None and math.isinf(value)
        out.append("never" if never else opt.shown(value, measure_scale(key)[0], 1 if key in ONE_DIGIT else 2))
    return out


def _print_gains(console: Console, result: "LimbResult") -> None:
    from ...limb_bench.entries import gain_unit

    rows = []
    for row in result.rows:
        settings, k = row.entry.settings, row.stiffness / 1e3
        rows.append(
            (
                row.entry.label,
                *(_per_axis(gain) for gain in (settings.kp, settings.kd)),
                gain_unit(settings.law, "kp"),
                *(opt.shown(value) for value in (k[0, 0], k[0, 1], k[1, 1])),
                "own" if row.entry.own_gains else str(result.matching.how),
            )
        )
    opt.show_table(console, ("law", "kp", "kd", "in", "Kxx", "Kxy", "Kyy", "gains"), rows, ("law", "in", "gains"))
    console.print("kd in that unit times s; stiffness K of the tip by the law itself [N/mm]")


def _per_axis(value: float | tuple[float, ...]) -> str:
    return "/".join(f"{one:.4g}" for one in (value if isinstance(value, tuple) else (value,)))


def _print_lines(console: Console, result: "LimbResult") -> None:
    """One line of blocks for each law: its error over the run, all to the scale of the largest of a stable one."""
    import numpy as np

    from ...limb_bench.result import error_line

    lines = [error_line(row.run, result.scenario, result.shown_until()) for row in result.rows]
    stable = [line for row, line in zip(result.rows, lines, strict=True) if row.measures[0].unstable_at is None]
    top = max(float(np.nanmax(line.error)) for line in stable or lines)
    console.print(f"{lines[0].what}, to {1e3 * top:.3g} mm; {lines[0].over}")
    room = min(36, max(len(row.entry.label) for row in result.rows))
    for row, line in zip(result.rows, lines, strict=True):
        blocks = _blocks(line.error, top, 80 - room - 9)
        console.print(f"{row.entry.label[:room]:<{room}} {blocks} {1e3 * np.nanmax(line.error):7.2f}")


def _blocks(values: "Floats", top: float, width: int) -> str:
    """The largest of each of `width` parts of a row, as blocks of eight heights."""
    import numpy as np

    out = ""
    for part in np.array_split(values, width):
        high = float(np.nanmax(part)) if part.size and np.isfinite(part).any() else 0.0
        out += BLOCKS[min(8, math.ceil(8 * high / top)) if top > 0.0 else 0]
    return out


limb = typer.Typer(help="Compare Cartesian controllers on one geared limb.", no_args_is_help=True)
for _command in (step, circle, push, open_loop, identify, record, force, portrait, sweep, tune):
    limb.command(_command.__name__.replace("_", "-"))(_command)
