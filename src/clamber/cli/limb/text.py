"""A comparison on the limb bench as people read it: a table, a small plot, and files by suffix."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
from rich.console import Console

from ...limb_bench.entries import gain_unit
from ...limb_bench.error_lines import error_line
from ...limb_bench.measures import Measures
from ...limb_bench.result import LimbResult, Row
from ...types import Floats
from ..output import plain_table


@dataclass(frozen=True, slots=True)
class Column:
    """One measure in the table."""

    title: str
    unit: str
    scale: float
    digits: int
    key: str
    tip: bool = True
    """Whether it is of the tip, so that truth and encoders differ."""


MM: Final = 1e3
COLUMNS: Final = {
    "across_max": Column("across max", "mm", MM, 2, "across_max"),
    "across_rms": Column("across rms", "mm", MM, 2, "across_rms"),
    "along_max": Column("along max", "mm", MM, 2, "along_max"),
    "radial_rms": Column("radial rms", "mm", MM, 2, "radial_rms"),
    "radial_max": Column("radial max", "mm", MM, 2, "radial_max"),
    "lag": Column("behind", "deg", math.degrees(1.0), 2, "lag"),
    "overshoot": Column("over", "%", 100.0, 1, "overshoot"),
    "settling": Column("settled", "s", 1.0, 2, "settling"),
    "on_aim": Column("on aim", "s", 1.0, 2, "on_aim"),
    "rest": Column("rest off", "mm", MM, 2, "rest"),
    "cycle": Column("cycle", "mm", MM, 2, "cycle"),
    "iae": Column("IAE", "mm s", MM, 2, "iae"),
    "work": Column("work", "J", 1.0, 2, "work", tip=False),
    "heat": Column("heat", "J", 1.0, 2, "heat", tip=False),
    "saturated": Column("at limit", "%", 100.0, 1, "saturated", tip=False),
    "tick": Column("tick*", "us", 1e6, 1, "tick", tip=False),
}
"""Measure -> its column."""
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


def print_limb_result(console: Console, result: LimbResult, *, everything: bool) -> None:
    """Print how the laws compare."""
    kind = result.scenario.kind
    console.print(_headline(result), style="bold")
    console.print(_plant_line(result))
    console.print(_match_line(result))
    console.print()
    _print_table(console, result, TELLING[kind])
    if everything:
        console.print()
        _print_table(console, result, MORE[kind])
        console.print("* called from Python on this machine; no two runs give the same")
        console.print()
        _print_gains(console, result)
    console.print()
    _print_lines(console, result)
    for label in result.mismatches():
        console.print(f"{label}: one gain for all directions, so '{result.match}' does not hold for it")
    stops = "has" if result.flaws.joint_limits else "has no"
    for name, excess in result.beyond_limits().items():
        console.print(f"the {name} turned {math.degrees(excess):.1f} deg beyond its limit; the plant {stops} stops")


def _headline(result: LimbResult) -> str:
    return f"{result.title()}, {result.limb.robot.name}'s {result.limb.name} limb from ({_mm(result.limb.start)}) mm"


def _mm(place: Sequence[float]) -> str:
    return ", ".join(f"{round(1e3 * value, 3) + 0.0:g}" for value in place)


def _plant_line(result: LimbResult) -> str:
    trials = "" if result.trials == 1 else f"; {result.trials} trials, mean and worst"
    return f"plant: {result.plant_words()}{trials}"


def _match_line(result: LimbResult) -> str:
    return f"gains: {result.match_words()}"


def _print_table(console: Console, result: LimbResult, keys: Sequence[str]) -> None:
    columns = [COLUMNS[key] for key in keys]
    titles = [f"{column.title}\n{column.unit}" for column in columns]
    table = plain_table("law", *titles, right=tuple(titles))
    for row in result.rows:
        if row.unstable == result.trials:
            when = min(each.unstable_at for each in row.measures if each.unstable_at is not None)
            table.add_row(row.entry.label, "unstable", f"from {when:.1f} s")
            continue
        told = row.entry.label + (f" ({row.unstable} of {result.trials} unstable)" if row.unstable else "")
        table.add_row(told, *_cells(row, columns, "true", _mean))
        if result.trials > 1:
            table.add_row("  worst", *_cells(row, columns, "true", max))
        if result.imperfect and any(column.tip for column in columns):
            table.add_row("  by encoders", *_cells(row, columns, "encoder", _mean))
    console.print(table)


def _mean(values: Sequence[float]) -> float:
    return float(np.mean(values))


def _cells(row: Row, columns: Sequence[Column], side: str, how: Callable[[Sequence[float]], float]) -> list[str]:
    out = []
    for column in columns:
        if side == "encoder" and not column.tip:
            out.append("")
            continue

        def pick(each: Measures, column: Column = column) -> float | None:
            value: float | None = getattr(getattr(each, side) if column.tip else each, column.key)
            return value

        values = row.values(pick)
        out.append(_number(how(values), column) if values else "-")
    return out


def _number(value: float, column: Column) -> str:
    if math.isinf(value):
        return "never"
    return f"{round(value * column.scale, column.digits) + 0.0:.{column.digits}f}"


def _print_gains(console: Console, result: LimbResult) -> None:
    numbers = ("kp", "kd", "Kxx", "Kxy", "Kyy")
    table = plain_table("law", "kp", "kd", "in", "Kxx", "Kxy", "Kyy", "gains", right=numbers)
    for row in result.rows:
        settings, k = row.entry.settings, row.stiffness / 1e3
        table.add_row(
            row.entry.label,
            *(_per_axis(getattr(settings, key)) for key in ("kp", "kd")),
            gain_unit(settings.law, "kp"),
            *(f"{round(value, 2) + 0.0:.2f}" for value in (k[0, 0], k[0, 1], k[1, 1])),
            "own" if row.entry.own_gains else result.match,
        )
    console.print(table)
    console.print("kd in that unit times s; stiffness K of the tip by the law itself [N/mm]")


def _per_axis(value: float | tuple[float, ...]) -> str:
    return "/".join(f"{one:.4g}" for one in (value if isinstance(value, tuple) else (value,)))


def _print_lines(console: Console, result: LimbResult) -> None:
    """One line of blocks for each law: its error over the run, all to the scale of the largest of a stable one."""
    lines = [error_line(row.run, result.scenario, result.shown_until()) for row in result.rows]
    stable = [line for row, line in zip(result.rows, lines, strict=True) if row.measures[0].unstable_at is None]
    top = max(float(np.nanmax(line.error)) for line in stable or lines)
    console.print(f"{lines[0].what}, to {1e3 * top:.3g} mm; {lines[0].over}")
    room = min(36, max(len(row.entry.label) for row in result.rows))
    width = 80 - room - 9
    for row, line in zip(result.rows, lines, strict=True):
        console.print(
            f"{row.entry.label[:room]:<{room}} {_blocks(line.error, top, width)} {1e3 * np.nanmax(line.error):7.2f}"
        )


def _blocks(values: Floats, top: float, width: int) -> str:
    """The largest of each of `width` parts of a row, as blocks of eight heights."""
    out = ""
    for part in np.array_split(values, width):
        high = float(np.nanmax(part)) if part.size and np.isfinite(part).any() else 0.0
        out += BLOCKS[min(8, math.ceil(8 * high / top)) if top > 0.0 else 0]
    return out


def write_limb_result(result: LimbResult, path: Path) -> None:
    """Write a result as its file's suffix says: a picture, JSON or CSV."""
    suffix = path.suffix.lower()
    if suffix == ".json":
        result.save(path)
    elif suffix == ".csv":
        result.save_table(path)
    else:
        from ...limb_bench.pictures.limb_plot import draw_limb_result

        draw_limb_result(result, path)
