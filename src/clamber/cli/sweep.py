"""`clamber sweep`: plan a task at many values of one or two of its keys."""

from typing import Annotated

import typer

from .crew import CrewWords
from .option_holder import takes_words
from .options import Overrides, PlannerName, TaskName
from .output import announce_compilation, print_json, stdout


@takes_words
def sweep(
    task: TaskName,
    vary: Annotated[
        list[str] | None,
        typer.Option(metavar="KEY=LOW..HIGH:N", help="A key and its range, such as motor.torque_limit=10Nm..21Nm:12."),
    ] = None,
    values: Annotated[
        list[str] | None, typer.Option(metavar="KEY=A,B,C", help="A key and its values, such as board=ladder,h.")
    ] = None,
    mark: Annotated[
        list[str] | None,
        typer.Option(metavar="KEY=VALUE", help="Mark a value of a varied key, or low..high, in table and picture."),
    ] = None,
    planner: PlannerName = "exact",
    overrides: Overrides = None,
    seed: Annotated[int, typer.Option(min=0, help="Of the genetic planner.")] = 0,
    evaluations: Annotated[int, typer.Option(min=1, help="Most plans that the genetic planner tries.")] = 50_000,
    stances: Annotated[int, typer.Option(min=1, help="Most stances that the exact planner keeps.")] = 2_000_000,
    *,
    words: CrewWords,
) -> None:
    """Plan at every point of a range: where a plan exists, how long the shortest is, how hard it loads the joints."""
    words.check()
    pictured = words.output is not None and words.output.suffix.lower() != ".csv"
    if pictured and words.output is not None:
        from ..viewing.output import CANVASES, check_suffix

        check_suffix(words.output, (".csv", *CANVASES))
    from ..planning.axes import check_axes, range_axis, read_mark, values_axis

    axes = [*map(range_axis, vary or ()), *map(values_axis, values or ())]
    check_axes(axes)
    marks = [read_mark(text, axes) for text in mark or ()]
    from ..planning.budgets import accepts
    from .sweep_text import print_sweep

    if words.ray is None:
        announce_compilation(quiet=words.quiet)
    from ..planning.sweep import run_sweep

    stated = {"max_evaluations": evaluations, "max_stances": stances}
    limits = {"seed": seed} | {option: most for option, most in stated.items() if accepts(planner, option)}
    result = run_sweep(
        task,
        axes,
        overrides=overrides or (),
        planner=planner,
        options=limits,
        executor=words.executor,
        marks=marks,
        store=words.store,
        resume=words.resume,
        progress=words.line("points").update,
    )
    if pictured and words.output is not None:
        from ..viewing.sweep_plot import draw_sweep

        draw_sweep(result, words.output)
    elif words.output is not None:
        result.save_table(words.output)
    if words.as_json:
        print_json(result)
    else:
        print_sweep(stdout(), result, words.output)
    raise typer.Exit(0 if result.found else 1)
