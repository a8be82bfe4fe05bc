"""`clamber run`: carry a plan or a walk out in contact dynamics."""

import shlex
from collections.abc import Container
from typing import Annotated

import typer

from ...terminal.name_completion import names_of
from ...terminal.options import takes_options
from .options import RunOptions

NOT_REPEATED = ("output", "save_plan", "report", "as_json", "quiet")
"""Options that change no run."""


def repeat_words(context: typer.Context, without: Container[str]) -> str:
    """The command with its arguments and the options that are not as usual.

    Args:
        context: Of the command that runs.
        without: Names of parameters that change nothing of what comes out, such as files to write.
    """
    words = context.command_path.split()
    options: list[str] = []
    for parameter in context.command.params:
        name = parameter.name or ""
        value = context.params.get(name)
        if name in without or value is None or value == parameter.get_default(context):
            continue
        if parameter.param_type_name == "argument":
            words.append(str(value))
        elif isinstance(value, bool):
            options.append(parameter.opts[0] if value else parameter.secondary_opts[0])
        else:
            for one in value if isinstance(value, list | tuple) else (value,):
                options += [parameter.opts[0], str(one)]
    return shlex.join([*words, *options])


@takes_options
def run(
    context: typer.Context,
    what: Annotated[
        str,
        typer.Argument(
            metavar="TASK|PLAN|WALK",
            help="A task, to be planned first, a plan, or a walk: names or files.",
            autocompletion=names_of("tasks", "plans", "walks"),
        ),
    ],
    *,
    words: RunOptions,
) -> None:
    """Carry a plan or a walk out on a simulated robot: every action or step, what became of it, and where it ended.

    `--set plant.backlash=1deg` changes the plant, other keys the task; `--noise usual` lets the plant differ from what is believed
    (docs/climbing.md). A file of `-o` is a log (.mcap, .csv), an animation (.gif, .html, .mp4) or a picture (.png, .svg, .pdf).
    """
    words.check()
    from ...trials.work import open_work
    from .carried_out import carry_out

    work = open_work(what, words.task, words.overrides or (), force=words.force)
    carry_out(work, words, repeat_words(context, NOT_REPEATED))
