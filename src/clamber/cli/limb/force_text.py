"""Forces held on a wall as people read them: a table, and files by suffix."""

from pathlib import Path

from rich.console import Console

from ...limb_bench.force_result import ForceResult
from ..output import plain_table

TITLES = ("mean\nN", "stand\nN", "slide\nN", "worst\nN", "touch\n%", "off\nmm", "work\nJ", "held")


def print_force_result(console: Console, result: ForceResult) -> None:
    """Print how well each law held the force."""
    console.print(f"{result.title()}, {result.limb.robot.name}'s {result.limb.name} limb", style="bold")
    console.print(f"plant: {result.plant_words()}")
    if result.belief_words():
        console.print(result.belief_words())
    console.print()
    table = plain_table("law / friction", *TITLES, right=TITLES[:-1])
    for row in result.rows:
        m = row.measures
        table.add_row(
            row.entry.label,
            *(f"{value + 0.0:.2f}" for value in (m.mean_error, m.worst_standing, m.worst_sliding, m.worst)),
            f"{100 * m.contact:.1f}",
            f"{1e3 * m.off_line:.2f}",
            f"{m.work:.2f}",
            "yes" if m.held else "lost" if m.contact < 1.0 else "no",
        )
    console.print(table)
    console.print()
    console.print("errors of the true force, after it has settled: mean; largest while standing")
    console.print("and while sliding; worst, with the slide's start and end; off: along the wall")
    console.print(f"held: none beyond {result.task.tolerance:g} N, and the tip never off the wall")


def write_force_result(result: ForceResult, path: Path) -> None:
    """Write a result as its file's suffix says: a picture or JSON."""
    if path.suffix.lower() == ".json":
        result.save(path)
        return
    from ...limb_bench.pictures.force_plot import draw_force_result

    draw_force_result(result, path)
