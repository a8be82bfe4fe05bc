"""A search as people read it: a live line on the way, and the plan or why there is none."""

from itertools import groupby
from pathlib import Path
from typing import Final

from rich.console import Console

from ...planning.genetic.learning import Macro
from ...planning.learning import Lesson
from ...planning.problem.plan import Plan
from ...planning.problem.problems import plan_family
from ...planning.problem.verdict import ToRun
from ...planning.progress import ProgressEvent, progress_text
from ...planning.result import Furthest, PlanResult
from ...tasks import Task
from ...terminal.live_line import LiveLine
from ...terminal.output import print_indented


class ProgressLine(LiveLine):
    """Follows a search."""

    def __init__(self, console: Console, *, quiet: bool) -> None:
        super().__init__(console, quiet=quiet, doing="preparing the search")

    def update(self, progress: ProgressEvent) -> None:
        """Show where the search is."""
        self.show(progress_text(progress))


def print_result(console: Console, result: PlanResult, output: Path | None, *, codes: bool = False) -> None:
    """Print what a search found, its actions in words or as `codes`, or how far it came and what stopped it."""
    found = result.has_plan
    if found:
        gap = "" if not result.gap else f", at most {result.gap} more than the shortest plan"
        console.print(f"{result.status}: {result.length} actions for '{result.plan.task}'{gap}", style="bold green")
        if costs := _costs_text(result):
            console.print(costs)
    else:
        console.print(f"{result.status}: no plan for '{result.plan.task}'", style="bold red")
        console.print(result.reason)
        if result.furthest is not None:
            _print_furthest(console, result.furthest)
    if result.model:
        console.print(f"proved for: {result.model}; {result.reason}" if found else f"proved for: {result.model}")
    elif found:
        console.print(result.reason)
    effort = f"{result.evaluations} plans, " if result.evaluations else ""
    effort = effort if result.stances is None else f"{result.stances} stances, "
    effort += f"{result.checks} actions judged, " if result.checks else ""
    console.print(f"{effort}{result.seconds:.1f} s, seed {result.seed}")
    if found:
        console.print(_spelled(result.plan, codes))
    if output is not None:
        what = "the plan" if found else "the actions that lead furthest"
        console.print(f"{what}: {output}", soft_wrap=True)


def print_to_run(console: Console, judged: ToRun | None, command: str | None = None) -> None:
    """Print whether `clamber run` would carry a plan out, and what makes one that it would; None: nothing."""
    if judged is None:
        return
    if judged.ok:
        console.print("to run: nothing speaks against it")
    else:
        console.print(f"to run: refused, {judged.objection}", style="yellow")
        if judged.command is not None:
            console.print(f"for one that can be carried out: {command or judged.command}")


def print_lesson(console: Console, task: Task, lesson: Lesson, output: Path | None) -> None:
    """Print the macros that were learned, and how they proved themselves."""
    if not lesson.macros:
        console.print(f"nothing in {lesson.plans} plans of '{lesson.task}' repeats", style="bold red")
        return
    for macro in lesson.macros:
        console.print(f"{macro.name}: {macro_text(task, macro)}", style="bold green")
        print_indented(
            console,
            f"{macro.gain:.3f} m in {len(macro.codes)} actions; works from {macro.starts} of {macro.tried} starts, "
            f"{macro.from_start} times in a row from the task's own",
        )
    console.print(f"{lesson.plans} plans, {lesson.evaluations} evaluations")
    if output is not None:
        console.print(f"macros: {output}", soft_wrap=True)


def macro_text(task: Task, macro: Macro) -> str:
    """A macro's actions by name."""
    return " ".join(plan_family(task).module(task, code) for code in macro.codes)


def _costs_text(result: PlanResult) -> str:
    spent = result.costs or result.spent()
    return ", ".join(cost.words(spent[name]) for name, cost in plan_family(result.task).costs(result.task).items())


def _print_furthest(console: Console, furthest: Furthest) -> None:
    stops = ", ".join(f"{check} {count}" for check, count in furthest.stopped_by.items())
    console.print(f"furthest: {furthest.actions} actions, {furthest.goals_met} of {furthest.goals} goals")
    console.print(f"there, actions that each check forbids: {stops or 'none'}")


MOST_RUNS: Final = 40
"""Runs of equal actions that are printed of a plan; of longer ones the first, the last and the number between."""


def _spelled(plan: Plan, codes: bool) -> str:
    """The plan in words, cut where it is long, or whole in the thesis's numbers if `codes` are asked for and it has some."""
    numbers = plan.numbers() if codes else None
    if numbers is not None:
        return " ".join(map(str, numbers))
    runs = [(title, len(list(run))) for title, run in groupby(action.title for action in plan.actions)]
    words = [title if times == 1 else f"{title} x{times}" for title, times in runs]
    if len(words) > MOST_RUNS + 10 and not codes:
        left = sum(times for _, times in runs[MOST_RUNS - 5 : -5])
        words = [
            *words[: MOST_RUNS - 5],
            f"... {left} actions more (-o FILE keeps all, --codes prints them) ...",
            *words[-5:],
        ]
    return "; ".join(words)
