"""`clamber trials`: one plan or walk carried out many times, each time with another robot and world than believed."""

from typing import Annotated

import typer

from ..crew import CrewWords
from ..name_completion import names_of
from ..option_holder import takes_options
from .options import TrialsOptions


@takes_options
def trials(
    what: Annotated[
        str,
        typer.Argument(
            metavar="TASK|PLAN|WALK",
            help="A task, to be planned once, a plan, or a walk: names or files.",
            autocompletion=names_of("tasks", "plans", "walks"),
        ),
    ],
    *,
    asked: TrialsOptions,
    words: CrewWords,
) -> None:
    """Climb many times under noise: how often it succeeds, why it fails, how long it takes, what matters.

    Each climb draws what is not as believed from its own seed (docs/climbing.md lists the keys and usual widths); `--noise none
    --noise friction=30%` leaves one of them. `-o` writes a picture (.png, .svg, .pdf), or with `--replay` what `clamber run` writes.
    """
    words.check()
    from ...families.walker.planning import is_walk, walk_names
    from ...planning.problem.plan_source import check_name

    check_name(what, walk_names())
    if is_walk(what):
        from .walk import walk_trials_of

        walk_trials_of(what, asked, words)
        return
    from ...families.walker.trials.planned import open_planned_walk
    from ...trials.plant_settings import split_settings

    planned = open_planned_walk(what, asked.task, split_settings(asked.overrides or ())[0])
    if planned is not None:
        from .walk import planned_walk_trials_of

        planned_walk_trials_of(what, *planned, asked, words)
        return
    from .climb import climb_trials_of

    climb_trials_of(what, asked, words)
