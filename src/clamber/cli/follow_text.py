"""What `clamber follow` prints of a run."""

from rich.console import Console

from ..control.cooperative.planted_feet import SUPPORT_WORDS
from ..experiments.cooperative.follow import FollowRun
from ..experiments.cooperative.tool_path import ToolPath
from .output import plain_table


def print_follow(console: Console, run: FollowRun, path: ToolPath) -> None:
    """Print how the tool followed its path, how far it was off, and which limit it came nearest to."""
    told = run.to_json()
    name, margin, time, unit = run.closest_range()
    table = plain_table("", "", right=("",))
    table.add_row("result", run.reason)
    table.add_row("stands on", f"the {SUPPORT_WORDS[run.footing.support]}")
    table.add_row("took", f"{told['seconds']:.1f} s, {1e3 * path.length:.0f} mm of path")
    table.add_row(
        "off its place", f"{1e3 * told['rms_error_m']:.3f} mm rms, {1e3 * told['largest_error_m']:.3f} mm at most"
    )
    table.add_row("manipulability", f"{told['mean_manipulability']:.4f} mean, {told['least_manipulability']:.4f} least")
    if run.options.gain > run.stable_gain:
        table.add_row(
            "gain", f"{run.options.gain:g} swings about summits of V; below {run.stable_gain:.3g} it does not"
        )
    table.add_row("closest limit", f"{name}, {margin:.3g}{'' if unit == '1' else ' ' + unit} left at {time:.1f} s")
    if run.unreachable:
        table.add_row("out of reach", f"{len(run.unreachable)} of the points looked at beforehand")
    console.print(table)
    for note in path.notes:
        console.print(note)
