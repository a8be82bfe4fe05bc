"""`clamber trials`: one plan or walk carried out many times, each time with another robot and world than believed."""

from dataclasses import dataclass
from typing import Annotated

import typer

from ...terminal.name_completion import names_of
from ...terminal.options import (
    PLAN_SECONDS,
    BodyLawName,
    CarriedOutIn,
    Faults,
    NoiseTexts,
    Overrides,
    PlannerName,
    PlanSeconds,
    Replan,
    takes_options,
)
from ...terminal.worker_options import WorkerOptions


@dataclass(frozen=True, slots=True)
class TrialsOptions:
    """Options of `clamber trials`, as they came: what is carried out, and how often."""

    n: Annotated[int, typer.Option("-n", min=1, help="How many climbs.")] = 24
    seed: Annotated[
        int,
        typer.Option(
            min=0, help="Of the first climb; each further one has the next. From 1000006000 on: held out, for rates."
        ),
    ] = 0
    noise: NoiseTexts = None
    fault: Faults = None
    task: CarriedOutIn = None
    planner: PlannerName = "auto"
    seconds: PlanSeconds = PLAN_SECONDS
    overrides: Overrides = None
    law: BodyLawName = None
    replan: Replan = True
    force: Annotated[bool, typer.Option("--force", help="Carry out a plan that its checks refuse.")] = False
    at_least: Annotated[
        str | None, typer.Option(help="Leave with 0 only if success is at least this with 97.5 % confidence.")
    ] = None
    against: Annotated[
        str | None,
        typer.Option(
            metavar="TASK|PLAN|WALK",
            help="Try this with the same seeds, and compare (sign test).",
            autocompletion=names_of("tasks", "plans", "walks"),
        ),
    ] = None
    against_law: Annotated[
        str | None,
        typer.Option(metavar="NAME", help="Law of what is compared; without --against, the same by this law."),
    ] = None
    replay: Annotated[
        int | None, typer.Option(min=0, metavar="SEED", help="Climb this one trial again, for -o a log or a picture.")
    ] = None

    @property
    def seeds(self) -> range:
        """One trial each."""
        return range(self.seed, self.seed + self.n)

    @property
    def held_out(self) -> bool:
        """Whether no tuning may have used the seeds.

        Raises:
            HeldOutError: If that is true of some only.
        """
        from ...trials.held_out import are_held_out

        return are_held_out(self.seeds)

    @property
    def least(self) -> float | None:
        """Share of success that is asked for with confidence; None: all are to succeed.

        Raises:
            BadParameter: If it is no share.
        """
        return None if self.at_least is None else _share(self.at_least)

    @property
    def compares(self) -> bool:
        """Whether two works or laws are tried."""
        return self.against is not None or self.against_law is not None

    def check(self) -> None:
        """Refuse what can't be, before anything is planned.

        Raises:
            BadParameter: If `at_least` is no share, or one run is to be compared.
            HeldOutError: If some seeds are held out and some are not.
        """
        if self.at_least is not None:
            _share(self.at_least)
        if self.compares and self.replay is not None:
            raise typer.BadParameter("compares many runs; --replay is one", param_hint="--against, --against-law")
        from ...trials.held_out import are_held_out

        are_held_out(self.seeds)


def _share(text: str) -> float:
    from ...units import parse_quantity

    share = parse_quantity(text, "ratio")
    if not 0.0 <= share <= 1.0:
        raise typer.BadParameter(f"{text} must be 0 to 100 %", param_hint="--at-least")
    return share


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
    words: WorkerOptions,
) -> None:
    """Climb many times under noise: how often it succeeds, why it fails, how long it takes, what matters.

    Each climb draws what is not as believed from its own seed (docs/climbing.md lists the keys and usual widths); `--noise none
    --noise friction=30%` leaves one of them. `-o` writes a picture (.png, .svg, .pdf), or with `--replay` what `clamber run` writes.
    """
    words.check()
    from ...trials.work import open_work
    from .carried_out import try_out

    asked.check()
    named = [what, asked.against or what] if asked.compares else [what]
    works = [open_work(each, asked.task, asked.overrides or (), force=asked.force) for each in named]
    try_out(works, asked, words)
