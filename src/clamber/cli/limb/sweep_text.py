"""A sweep of laws as people read it: who wins where, and each law's boundary."""

from pathlib import Path

from rich.console import Console

from ...limb_bench.limb_sweep import LimbSweep
from ..output import plain_table
from .text import COLUMNS

MARKS = "ABCDEFGHIJKLMNOPQRSTUVWXYZ"
"""Of laws in a map, in their order."""


def print_limb_sweep(console: Console, result: LimbSweep, output: Path | None) -> None:
    """Print a table over one axis, or a map of letters over two, and the boundaries."""
    bench = result.bench
    over = " and ".join(axis.key for axis in result.axes)
    console.print(f"{bench.kind} over {over}: {bench.measure}{_unit(bench.measure)}", style="bold")
    console.print(f"plant: {result.plant_words()}")
    console.print(f"gains: {result.gain_words()}")
    console.print()
    if len(result.axes) == 1:
        _print_rows(console, result)
    else:
        _print_map(console, result)
    console.print()
    _print_boundaries(console, result)
    if output is not None:
        console.print(f"written to {output}", soft_wrap=True)


def measure_scale(name: str) -> tuple[float, str]:
    """What a measure is multiplied by to be shown, and the unit that it then has."""
    column = COLUMNS.get(name.rpartition(".")[2])
    return (1e3, "mm") if column is None else (column.scale, column.unit)


def _unit(name: str) -> str:
    unit = measure_scale(name)[1]
    return f" [{unit}]" if unit else ""


def _print_rows(console: Console, result: LimbSweep) -> None:
    axis = result.axes[0]
    heads = [f"{MARKS[k % len(MARKS)]}" for k in range(len(result.labels))]
    head = f"{axis.key}\n{axis.unit}" if axis.unit else axis.key
    table = plain_table(head, *heads, "best", right=(head, *heads))
    scale = measure_scale(result.bench.measure)[0]
    assert axis.numbers is not None
    for k, point in enumerate(result.points):
        cells = []
        for cell in point.values():
            told = "never" if cell.value is None else f"{scale * cell.value:.2f}"
            cells.append(told if cell.steady else "unstable")
        table.add_row(f"{axis.numbers[k]:.4g}", *cells, result.winner(k) or "none")
    console.print(table)
    for mark, label in zip(heads, result.labels, strict=True):
        console.print(f"{mark}  {label}")


def _print_map(console: Console, result: LimbSweep) -> None:
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


def _print_boundaries(console: Console, result: LimbSweep) -> None:
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


def write_limb_sweep(result: LimbSweep, path: Path) -> None:
    """Write a sweep as its file's suffix says: CSV or a picture."""
    if path.suffix.lower() == ".csv":
        result.save_table(path)
    else:
        from ...limb_bench.pictures.limb_map_plot import draw_limb_sweep

        draw_limb_sweep(result, path, *measure_scale(result.bench.measure))
