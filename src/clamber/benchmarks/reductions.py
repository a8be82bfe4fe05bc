"""What makes the search smaller, and by how much: the inventory's filters, and a macro learned on a shorter ladder."""

from statistics import median
from typing import Final

from ..planning.genetic.profile import load_profile
from ..planning.learning import learn_macros
from ..planning.problem.problems import pose_problem
from ..tasks import load_task
from .ablation import varied
from .planner_trials import Trials, run_trials
from .rows import NOTHING, Row, Say, keep_quiet, median_or_nothing

FILTER_TASKS: Final = ("ladder", "h")
FILTER_SEEDS: Final = range(10)
FILTER_EVALUATIONS: Final = 200_000
"""Enough for most searches through the unfiltered inventory to end."""
MACRO_SEEDS: Final = range(10)
MACRO_EVALUATIONS: Final = 200_000
TALL: Final = ("board.ladder.rungs=33", "goal.y_min=192in")
"""Three times as many rungs, and a goal as far below the top as on the short ladder."""


def _factor_rows(name: str, before: Trials, after: Trials, what: str) -> list[Row]:
    seeds = len(before.evaluations)
    slow, fast = median_or_nothing(before.evaluations), median_or_nothing(after.evaluations)
    return [
        Row(f"{name}: evaluations to success without {what}, median of {seeds} seeds", slow, "evaluations"),
        Row(f"{name}: evaluations to success with {what}, median of {seeds} seeds", fast, "evaluations"),
        Row(f"{name}: seeds of {seeds} that found a plan without {what}", before.found, "seeds"),
        Row(f"{name}: seeds of {seeds} that found a plan with {what}", after.found, "seeds"),
        Row(f"{name}: times fewer evaluations with {what}", slow / fast, "ratio"),
    ]


def filter_rows(*, seeds: range = FILTER_SEEDS, say: Say = keep_quiet) -> list[Row]:
    """Search with and without the inventory's filters, and the number of sequences D = N^m before and after."""
    profile = varied(load_profile("default"), {"polish": 0})
    rows = []
    for name in FILTER_TASKS:
        task = load_task(name)
        done = {}
        for filters in (False, True):
            say(f"{name}, filters {'on' if filters else 'off'}")
            done[filters] = run_trials(task, profile, seeds, max_evaluations=FILTER_EVALUATIONS, filters=filters)
        rows += _factor_rows(name, done[False], done[True], "filters")
        lengths = [length for length in done[True].first_lengths if length is not None]
        if not lengths:
            rows.append(Row(f"{name}: log10 of the sequences (no plan, so no length)", NOTHING, "log10"))
            continue
        size = pose_problem(task).sized(round(median(lengths)))
        actions = f"plans of {size.length} actions"
        rows += [
            Row(
                f"{name}: sequences D = N^m before filters, {actions}, N = {size.full_size}",
                size.log10_before,
                "log10",
            ),
            Row(
                f"{name}: sequences D = N^m after filters, {actions}, N = {size.modules}",
                size.log10_after,
                "log10",
            ),
        ]
    return rows


def macro_rows(*, seeds: range = MACRO_SEEDS, say: Say = keep_quiet) -> list[Row]:
    """A macro learned on the ladder, used on one three times as tall."""
    say("learning a macro on the ladder")
    lesson = learn_macros(load_task("ladder"))
    name = "ladder three times as tall"
    if not lesson.macros:
        return [Row(f"{name}: times fewer evaluations with a learned macro (none was learned)", NOTHING, "ratio")]
    tall = load_task("ladder", TALL)
    profile = varied(load_profile("default"), {"polish": 0})
    done = {}
    for macros in ((), lesson.macros):
        say(f"{name}, {len(macros)} macros")
        done[len(macros)] = run_trials(tall, profile, seeds, max_evaluations=MACRO_EVALUATIONS, macros=macros)
    return [
        Row("learning the macro: evaluations, on the short ladder", lesson.evaluations, "evaluations"),
        Row("learning the macro: actions of the macro", len(lesson.macros[0].codes), "actions"),
        *_factor_rows(name, done[0], done[len(lesson.macros)], "the macro"),
    ]
