"""Section 2.5.2: with a body move of 6 in the planner "would not have been able to find a solution"."""

from typing import Final

from ...units import INCH
from ..exhaust import exhaust
from ..result import Compared, StudyResult, Table, Value
from . import PAPER
from .modified_ladder import NO_HANGS, OWN, reading
from .replayed import INFERRED, limbed_task

STEPS: Final = (6, 3, 2, 1)
"""Lengths of a body move [in]."""


def vary_step_size() -> StudyResult:
    """Search every stance of the modified ladder, rotation allowed, for each step length and both readings."""
    rows: list[tuple[Value, ...]] = []
    lengths: dict[tuple[str, int], int | None] = {}
    for rules in (OWN, (NO_HANGS,)):
        for step in STEPS:
            found = exhaust(limbed_task("modified-ladder", (*rules, f"step.length={step}in")))
            shortest = None if found.codes is None else len(found.codes)
            lengths[reading(rules), step] = shortest
            answer = "impossible, proved" if found.closed else "possible"
            rows.append((reading(rules), step, answer, shortest, found.stances, found.highest / INCH))
    own = reading(OWN)
    held = lengths[own, 6] is None and lengths[own, 1] is not None
    return StudyResult(
        paper=PAPER,
        result="step-size",
        claim="Section 2.5.2: with 6 in for module 3 there is no plan for the modified ladder, with 1 in there is; "
        "smaller steps cost a larger search space.",
        verdict="holds" if held else "differs",
        compared=tuple(
            Compared(
                f"shortest plan, {step} in steps, {reading(rules)} [actions]", lengths[reading(rules), step] or "none"
            )
            for rules in (OWN, (NO_HANGS,))
            for step in STEPS
        )
        + tuple(Compared(f"stances looked at, {row[1]} in steps, {row[0]}", row[4]) for row in rows),
        deviations=(
            *INFERRED,
            "The verdict is for the reading in which section 2.5.2 is consistent (own halves, offset while holding, no hangs).",
            "In the free reading a plan with 6 in steps exists, too: rotation alone then places the body.",
            "In the reading of the verdict 3 in has a plan and 2 in has none: a smaller step is not always a finer choice, "
            "for body heights count in steps from the start at y = 6 in.",
        ),
        table=Table(
            ("rules", "step [in]", "with rotation", "shortest plan", "stances", "highest body [in]"), tuple(rows)
        ),
    )
