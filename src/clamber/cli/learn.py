"""`clamber learn`: find a sequence that repeats, and keep it as a module of its own."""

from typing import Annotated

import typer

from ..terminal.options import AsJson, Output, Overrides, Quiet, TaskName
from ..terminal.output import check_writable, print_json, stderr, stdout


def learn(
    task: TaskName,
    overrides: Overrides = None,
    seeds: Annotated[int, typer.Option(min=1, help="Most plans to look at.")] = 12,
    keep: Annotated[int, typer.Option(min=1, help="Most macros to keep.")] = 1,
    threads: Annotated[int | None, typer.Option(min=1, help="Threads; one a core unless given.")] = None,
    output: Output = None,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Plan a task and learn the gait in the plan; `clamber plan --macros FILE` then uses it."""
    check_writable(output)
    from ..tasks import load_task

    loaded = load_task(task, overrides or ())
    from ..planning.learning import learn_macros
    from .plan.text import ProgressLine, print_lesson

    with ProgressLine(stderr(), quiet=quiet) as line:
        lesson = learn_macros(loaded, seeds=range(seeds), threads=threads, progress=line.update, most=keep)
    if output is not None:
        lesson.save(output)
    if as_json:
        print_json(lesson)
    else:
        print_lesson(stdout(), loaded, lesson, output)
    raise typer.Exit(0 if lesson.macros else 1)
