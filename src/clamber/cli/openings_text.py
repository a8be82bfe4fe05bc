"""What would make an infeasible task feasible, as people read it."""

from rich.console import Console

from ..planning.openings.result import Opening, Openings, Places, shown
from .output import plain_table

WHY = {"interrupted": "interrupted", "time": "out of time (--openings-seconds)"}


def print_openings(console: Console, found: Openings) -> None:
    """Print every kind of change that opens the task, the smallest of each, and what doesn't."""
    console.print()
    best = () if found.places is None else found.places.openings[:1]
    rows = (*found.openings, *best)
    if rows:
        console.print("any one of these changes makes it feasible (each plan is proved to be the shortest there):")
        table = plain_table("change", "from", "to", "actions", right=("actions",))
        for opening in rows:
            table.add_row(opening.key, shown(opening.before, opening.unit), *_last(opening))
        console.print(table)
    else:
        console.print("no single change that was tried makes it feasible", style="bold red")
    if any(opening.unit and opening.least for opening in rows):
        console.print("numbers are the least that do: one digit less, and it is proved infeasible")
    if any(not opening.least for opening in rows):
        console.print("*: one digit less was proved infeasible or not settled; smaller values were not all tried")
    if found.places is not None:
        _print_places(console, found.places)
    for proved, words in ((True, "proved infeasible even with"), (False, "not settled in the time")):
        texts = [shut.text for shut in found.shut if shut.proved == proved]
        if texts:
            console.print(f"{words}: {', '.join(texts)}")
    ended = f"; {WHY[found.ended]}" if found.ended else ""
    console.print(f"{found.searches} exact searches, {found.seconds:.1f} s{ended}")


def _last(opening: Opening) -> tuple[str, str]:
    to = shown(opening.after, opening.unit) + ("" if opening.least else " *")
    return to, f"{opening.length}" if opening.shortest else f"at most {opening.length}"


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
