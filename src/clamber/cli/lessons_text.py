"""What a plan learned in rehearsals, as people read it."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from rich.console import Console

from .live_line import LiveLine
from .output import plain_table

if TYPE_CHECKING:  # loads NumPy, which `--help` does without
    from ..experiments.climb.lessons import Lesson, Rehearsed


class LessonsLine(LiveLine):
    """Follows rehearsals."""

    def update(self, best: "Rehearsed", tried: "Sequence[Lesson]") -> None:
        """Show how the best plan so far climbs, and how many changes were tried."""
        self.show(f"{_climbed(best)}; {len(tried)} changes tried, {sum(lesson.taken for lesson in tried)} taken")


def print_lessons(
    console: Console, first: "Rehearsed", best: "Rehearsed", tried: "Sequence[Lesson]", written: Path | None
) -> None:
    """Print climbs before and after, a row for each change, and what still fails."""
    console.print(
        f"{_climbed(first)} before, {best.climbed} after; {len(first.plan.actions)} actions, now {len(best.plan.actions)}",
        style="bold",
    )
    if tried:
        table = plain_table("grab", "change", "actions", "climbed", "", right=("grab", "actions", "climbed"))
        for lesson in tried:
            table.add_row(
                str(lesson.step), lesson.what, str(lesson.length), f"{lesson.climbed} of {lesson.tried}",
                "taken" if lesson.taken else "",
            )  # fmt: skip
        console.print(table)
    for step, seeds in best.faults.items():
        where = f"step {step}, {best.plan.actions[step - 1].title}" if step else "before the first grab"
        console.print(f"still fails: {where}, {len(seeds)} of {len(best.trials)}")
    if written is not None:
        console.print(f"written: {written}")


def _climbed(plan: "Rehearsed") -> str:
    return f"{plan.climbed} of {len(plan.trials)} climbs"
