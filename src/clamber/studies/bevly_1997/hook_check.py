"""Section 2.3: "the leg could hold onto the peg in any orientation"; how often the printed plans ask hooks to push."""

from typing import Final

from ..result import Compared, StudyResult, Table, Value
from . import PAPER
from .replayed import H_START, INFERRED, replay_printed

PLANS: Final[dict[str, tuple[str, tuple[str, ...]]]] = {
    "Table D.1, ladder": ("ladder-hand", ()),
    "Table D.2, H by hand": ("h-hand", ()),
    "Table 2.4, H by the planner": ("h-ga", H_START),
    "Table 2.3, modified ladder": ("modified-ladder-ga", ()),
    "Table D.3, across": ("across-hand", ()),
    "Table D.4, circle": ("circle-hand", ()),
}
"""Label -> plan and what its task needs."""


def check_hooks() -> StudyResult:
    """Count the steps that no force split could carry if hooks can only pull."""
    rows: list[tuple[Value, ...]] = []
    after = 0
    for label, (name, overrides) in PLANS.items():
        counts = []
        for support in ("atomic", "strict"):
            verdict = replay_printed(name, (*overrides, f"rules.support={support}")).verdict
            failing = [row.step for row in verdict.per_step if row.ok and "hook" in row.reported]
            counts.append(failing)
        after += len(counts[0])
        rows.append((label, verdict.steps, len(counts[0]), len(counts[1]), ", ".join(map(str, counts[0]))))
    return StudyResult(
        paper=PAPER,
        result="hook-check",
        claim="Section 2.3: the planner's simulation assumes that a leg can hold a peg in any orientation. "
        "The robot's hooks can only pull, so plans made this way should be possible with hooks as well.",
        verdict="differs" if after else "holds",
        compared=tuple(
            Compared(f"{row[0]}: steps that hooks cannot carry, of {row[1]}, stance after the step", row[2])
            for row in rows
        )
        + tuple(Compared(f"{row[0]}: the same with the swing of the leg", row[3]) for row in rows),
        deviations=(
            *INFERRED,
            "The thesis makes no such check; the claim as a test of its plans is ours.",
            "A hook takes any pull within 90 deg of its grab direction; either side of the elbow may be used.",
            "The swing of a leg adds a step of Table D.2 where the robot hangs on one leg in between.",
        ),
        table=Table(("plan", "steps", "after the step", "with the swing", "steps that fail (after)"), tuple(rows)),
    )
