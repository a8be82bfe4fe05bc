"""Checks that other packages add. They are Python, not kernels: planners do not see them, verdicts tell of them, and they only report."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from ...extensions import ExtensionError, blamed, failure, load_outside, outside
from ...tasks import Task
from .check import Check
from .step_verdict import StepVerdict

MarginOf: TypeAlias = Callable[[Task, StepVerdict], float | None]


@dataclass(frozen=True, slots=True, kw_only=True)
class OutsideCheck:
    """A check of another package, named by its entry point in the group `clamber.checks`."""

    unit: str
    """SI unit of its margin; "1" for a count."""
    meaning: str
    """What the margin says, in one line."""
    margin: MarginOf
    """Of a task and a step of a plan: the signed margin, positive holds; None where nothing limits it."""


@dataclass(frozen=True, slots=True)
class Judged:
    """What the checks of other packages say of a plan."""

    checks: tuple[Check, ...]
    rows: tuple[dict[str, float | None], ...]
    """For each step: check -> margin."""
    notes: tuple[str, ...]
    """Which of them could not be had, and why."""


def judge_outside(task: Task, steps: Sequence[StepVerdict], taken: Sequence[str]) -> Judged:
    """The margins of every check that other packages add, for each step; one that fails is a note and no error.

    Args:
        task: What is planned.
        steps: As our own checks have judged them.
        taken: Names of our own checks.
    """
    checks: list[Check] = []
    rows: list[dict[str, float | None]] = [{} for _ in steps]
    notes: list[str] = []
    for name in outside("checks"):
        try:
            if name in taken:
                raise failure("checks", name, "has the name of one of Clamber's own checks")
            check = _loaded(name)
            margins = [_margin(name, check, task, step) for step in steps]
        except ExtensionError as error:
            notes.append(f"a check was left out: {error}")
            continue
        checks.append(Check(name, check.unit, check.meaning))
        for row, margin in zip(rows, margins, strict=True):
            row[name] = margin
    return Judged(tuple(checks), tuple(rows), tuple(notes))


def _loaded(name: str) -> OutsideCheck:
    check = load_outside("checks", name)
    if not isinstance(check, OutsideCheck):
        raise failure("checks", name, f"is a {type(check).__name__}; it must be a clamber.OutsideCheck")
    return check


def _margin(name: str, check: OutsideCheck, task: Task, step: StepVerdict) -> float | None:
    with blamed("checks", name):
        margin = check.margin(task, step)
        return None if margin is None or math.isnan(margin) else float(margin)
