"""What would make an infeasible task feasible, as people read it."""

from rich.console import Console

from ...openings.result import Openings, Places, shown
from ..output import plain_table

WHY = {"interrupted": "interrupted", "time": "out of time (--openings-seconds)"}


def print_openings(console: Console, found: Openings) -> None:
    """Print every kind of change that opens the task, the smallest of each, and what doesn't."""
    console.print()
    best = () if found.places is None else found.places.openings[:1]
    rows = (*found.openings, *best)
    if rows:
        console.print("any one of these changes makes it feasible:", style="bold green")
        right = ("actions",)
        table = plain_table("change", "from", "to", "not yet at", *right, right=right)
        for opening in rows:
            ends = (shown(value, opening.unit) for value in (opening.before, opening.after, opening.shut_at))
            length = f"{opening.length}" if opening.shortest else f"at most {opening.length}"
            table.add_row(opening.key, *ends, length if opening.least else f"{length} *")
        console.print(table)
    else:
        console.print("no single change that was tried makes it feasible", style="bold red")
    if any(not opening.least for opening in rows):
        console.print("*: values in between were not all settled, so less may be enough")
    if found.places is not None:
        _print_places(console, found.places)
    for proved, words in ((True, "proved infeasible even with"), (False, "not settled in the time")):
        texts = [shut.text for shut in found.shut if shut.proved == proved]
        if texts:
            console.print(f"{words}: {', '.join(texts)}")
    ended = f"; {WHY[found.ended]}" if found.ended else ""
    console.print(f"{found.searches} exact searches, {found.seconds:.1f} s{ended}")


def _print_places(console: Console, places: Places) -> None:
    spots = f"{len(places.openings)} of {places.tried} places" + (
        "" if places.complete else f" ({places.places} in all)"
    )
    console.print(
        f"one hold more: {spots} open it, on a lattice of {places.spacing * 1000:.4g} mm "
        "wherever a limb could ever grab" + ("; the best:" if places.openings else "")
    )
    if places.openings:
        console.print(f"  --set '{places.openings[0].overrides[0]}'", soft_wrap=True)
