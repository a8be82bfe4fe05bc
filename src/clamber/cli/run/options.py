"""The options of `clamber run`."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

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
)
from ...terminal.output import check_writable

if TYPE_CHECKING:
    from ...execution.log_stream import LogGap, WantedLog


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
