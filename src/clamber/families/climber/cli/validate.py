"""`clamber validate`: make a climber's plan surer."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Final

import typer
from rich.console import Console

from ....interrupts import answer
from ....terminal.live_line import LiveLine
from ....terminal.name_completion import names_of
from ....terminal.options import CarriedOutIn, NoiseTexts, Overrides, Ray, Told, Workers, takes_options
from ....terminal.output import check_writable, print_json, stderr, stdout
from ....terminal.worker_options import executor_of
from ....viewing.text_table import plain_table

if TYPE_CHECKING:  # loads NumPy, which `--help` does without
    from ..trials.plan_repair import Lesson, ValidatedPlan, Went

FIRST_SEED: Final = 500_000
"""Of rehearsals, unless stated: far from those that trials begin with."""


class LessonsLine(LiveLine):
    """Follows rehearsals."""

    def __init__(self, console: Console, *, quiet: bool) -> None:
        super().__init__(console, quiet=quiet, doing="preparing the climbs")
        self._so_far = "the plan as it is"

    def update(self, best: "ValidatedPlan", tried: "Sequence[Lesson]") -> None:
        """Show how the best plan so far climbs, and how many changes were tried."""
        taken = sum(lesson.taken for lesson in tried)
        self._so_far = f"{_climbed(best)}; {len(tried)} changes tried, {taken} taken"
        self.show(f"{self._so_far}; looking for another way", now=True)

    def climbs(self, ended: int, asked: int, climbed: int) -> None:
        """Show how far the climbs by one plan are."""
        self.show(f"{self._so_far}; now {ended} of {asked} climbs, {climbed} whole", ended / asked)


def _print_lessons(
    console: Console, first: "ValidatedPlan", best: "ValidatedPlan", tried: "Sequence[Lesson]", written: Path | None
) -> None:
    """Print climbs before and after, a row for each change, and what still fails."""
    console.print(
        f"{_climbed(first)} before, {best.climbed} after; {len(first.plan.actions)} actions, now {len(best.plan.actions)}",
        style="bold",
    )
    if tried:
        table = plain_table("grab", "change", "actions", "climbed", "", right=("grab", "actions", "climbed"))
        for lesson in tried:
            table.add_row(
                str(lesson.step),
                lesson.what,
                str(lesson.length),
                f"{lesson.climbed} of {lesson.tried}",
                "taken" if lesson.taken else "",
            )
        console.print(table)
    for step, seeds in best.faults.items():
        where = f"step {step}, {best.plan.actions[step - 1].title}" if step else "before the first grab"
        console.print(f"still fails: {where}, {len(seeds)} of {len(best.trials)}")
    if written is not None:
        console.print(f"written: {written}")


def _climbed(plan: "ValidatedPlan") -> str:
    return f"{plan.climbed} of {len(plan.trials)} climbs"


@dataclass(frozen=True, slots=True)
class Rehearsing:
    """How often, and under what a plan is rehearsed."""

    n: Annotated[int, typer.Option("-n", min=1, help="Climbs of each rehearsal.")] = 24
    lessons: Annotated[int, typer.Option(min=0, help="Most changes that are tried.")] = 12
    seed: Annotated[int, typer.Option(min=0, help="Of a rehearsal's first climb.")] = FIRST_SEED
    noise: NoiseTexts = None
    task: CarriedOutIn = None
    overrides: Overrides = None
    seconds: Annotated[float, typer.Option(min=0.0, help="Most time for each search for another way.")] = 60.0


@takes_options
def validate(
    plan: Annotated[
        str, typer.Argument(metavar="PLAN", help="A climber's plan: name or file.", autocompletion=names_of("plans"))
    ],
    *,
    asked: Rehearsing,
    workers: Workers = None,
    ray: Ray = None,
    told: Told,
) -> None:
    """Climb by a plan under noise, change what fails most, keep the change if more climbs succeed, and again.

    Noise as in `clamber trials`. `-o` keeps the best plan so far, from the first rehearsal on; Ctrl-C ends with it.
    """
    check_writable(told.output)
    from ....terminal.compile_ahead import compile_ahead
    from ..trials.warm_up import CLIMBING

    compile_ahead(CLIMBING)
    from ....trials.work import open_work
    from ..trials.plan_repair import validate_plan as learned_by

    work = open_work(plan, asked.task, asked.overrides or (), force=True)
    if work.plan is None:
        raise typer.BadParameter(f"'{plan}' is a task; `clamber plan` makes a plan for it", param_hint="PLAN")
    executor = executor_of(ray, workers)
    executor.check()
    with LessonsLine(stderr(), quiet=told.quiet) as line:

        def tell(went: "Sequence[Went]") -> None:
            best, lesson = went[-1]
            line.update(best, [one for _, one in went if one is not None])
            if told.output is not None and (lesson is None or lesson.taken):
                best.plan.save(told.output)

        try:
            learned = learned_by(
                work,
                asked.noise or (),
                executor,
                range(asked.seed, asked.seed + asked.n),
                lessons=asked.lessons,
                seconds=asked.seconds,
                told=tell,
                ended=line.climbs,
            )
        except KeyboardInterrupt:
            answer()
            stderr().print(
                "interrupted before the plan had been climbed once as often as asked; nothing is known of it yet"
            )
            raise typer.Exit(130) from None
    if told.as_json:
        print_json(learned)
    else:
        _print_lessons(stdout(), learned.first, learned.best, learned.lessons, told.output)
    raise typer.Exit(130 if learned.interrupted else 0)
