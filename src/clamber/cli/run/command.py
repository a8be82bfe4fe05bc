"""`clamber run`: carry a plan or a walk out in contact dynamics."""

import shlex
from collections.abc import Callable, Container
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ...terminal.name_completion import names_of
from ...terminal.options import (
    PLAN_SECONDS,
    AsJson,
    BodyLawName,
    CarriedOutIn,
    NoiseTexts,
    Overrides,
    PlannerName,
    PlanSeconds,
    Quiet,
    Replan,
    takes_options,
)
from ...terminal.output import check_writable

if TYPE_CHECKING:
    from ...execution.log_stream import LogGap, WantedLog

NOT_REPEATED = ("output", "save_plan", "report", "as_json", "quiet")
"""Options that change no run."""


@dataclass(frozen=True, slots=True)
class RunOptions:
    """Options of `clamber run`, as they came."""

    task: CarriedOutIn = None
    planner: PlannerName = "auto"
    seconds: PlanSeconds = PLAN_SECONDS
    overrides: Overrides = None
    noise: NoiseTexts = None
    peg_error: Annotated[str | None, typer.Option(help="Short for --noise peg_error=..., such as 3mm.")] = None
    seed: Annotated[int, typer.Option(min=0, help="Of planner and noise.")] = 0
    law: BodyLawName = None
    replan: Replan = True
    plant: Annotated[str, typer.Option(help="What moves: torques, volts, or the ADDRESS of `clamber plant serve`.")] = (
        "torques"
    )
    force: Annotated[
        bool, typer.Option("--force", help="Carry out a plan that its checks refuse; the log says so.")
    ] = False
    output: Annotated[
        list[Path] | None,
        typer.Option("--output", "-o", metavar="FILE", help="File to write; more than once for more."),
    ] = None
    save_plan: Annotated[Path | None, typer.Option(metavar="FILE", help="Keep the plan (.json).")] = None
    report: Annotated[
        Path | None,
        typer.Option(metavar="DIR", help="Write pages there: what was planned, what happened, where it was close."),
    ] = None
    as_json: AsJson = False
    quiet: Quiet = False

    def check(self) -> None:
        """Make sure that files can be written before anything runs."""
        for file in (*self.outputs, self.save_plan):
            check_writable(file)

    @property
    def outputs(self) -> tuple[Path, ...]:
        """Files to write, each once."""
        return tuple(dict.fromkeys(self.output or ()))

    @property
    def growing(self) -> Path | None:
        """The log that is written as the robot moves; the other files are written at the end."""
        return next((file for file in self.outputs if file.suffix.lower() == ".mcap"), None)

    def log(self, tell: Callable[[str], None]) -> "WantedLog | None":
        """That log, and who is told if it cannot be written to its end."""
        from ...execution.log_stream import WantedLog

        return None if self.growing is None else WantedLog(self.growing, tell)

    def written(self, gap: "LogGap | None") -> tuple[Path, ...]:
        """The files that are whole at the end of a run."""
        return tuple(file for file in self.outputs if gap is None or file != self.growing)


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
