"""`clamber trials`: one plan or walk carried out many times, each time with another robot and world than believed."""

from typing import Annotated

import typer

from ...terminal.crew import CrewWords
from ...terminal.name_completion import names_of
from ...terminal.options import takes_options
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
    from ...trials.work import open_work
    from .carried_out import try_out

    asked.check()
    try_out(open_work(what, asked.task, asked.overrides or ()), asked, words)
