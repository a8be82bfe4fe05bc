"""`clamber validate`: make a climber's plan surer."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Final

import typer
from rich.console import Console

from ....terminal.live_line import LiveLine
from ....terminal.name_completion import names_of
from ....terminal.options import CarriedOutIn, NoiseTexts, Overrides, Ray, Told, Workers, takes_options
from ....terminal.output import announce_compilation, check_writable, print_json, stderr, stdout
from ....terminal.worker_options import executor_of
from ....viewing.text_table import plain_table

if TYPE_CHECKING:  # loads NumPy, which `--help` does without
    from ..trials.plan_repair import Lesson, ValidatedPlan

FIRST_SEED: Final = 500_000
"""Of rehearsals, unless stated: far from those that trials begin with."""


class LessonsLine(LiveLine):
    """Follows rehearsals."""

    def update(self, best: "ValidatedPlan", tried: "Sequence[Lesson]") -> None:
        """Show how the best plan so far climbs, and how many changes were tried."""
        self.show(f"{_climbed(best)}; {len(tried)} changes tried, {sum(lesson.taken for lesson in tried)} taken")


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
    announce_compilation(quiet=told.quiet)
    from ....terminal.compile_ahead import compile_ahead
    from ..trials.warm_up import CLIMBING

    compile_ahead(CLIMBING)
    from ....trials.work import open_work
    from ..trials.noise import named_noise, read_noise
    from ..trials.plan_repair import LearnedPlan, climbs_with, learn
    from ..trials.run_plan import climbing_task
    from ..trials.trial import TrialSetup, with_plan

    widths = read_noise(named_noise("usual"), asked.noise or ())
    work = open_work(plan, asked.task, asked.overrides or ())
    opened, first_plan, plant = climbing_task(work.item), work.plan, work.plant
    if first_plan is None:
        raise typer.BadParameter(f"'{plan}' is a task; `clamber plan` makes a plan for it", param_hint="PLAN")
    setup = with_plan(TrialSetup(task=opened, noise=widths, plan=first_plan, plant=plant, replan=False), label=plan)
    executor = executor_of(ray, workers)
    executor.check()
    went: list[tuple[ValidatedPlan, Lesson | None]] = []
    with LessonsLine(stderr(), quiet=told.quiet) as line:

        def tell(best: "ValidatedPlan", lesson: "Lesson | None") -> None:
            went.append((best, lesson))
            line.update(best, [one for _, one in went if one is not None])
            if told.output is not None and (lesson is None or lesson.taken):
                best.plan.save(told.output)

        interrupted = False
        try:
            learn(
                opened,
                first_plan,
                climbs_with(setup, executor),
                range(asked.seed, asked.seed + asked.n),
                lessons=asked.lessons,
                seconds=asked.seconds,
                told=tell,
            )
        except KeyboardInterrupt:
            interrupted = True
    if went:
        (first, _), (best, _) = went[0], went[-1]
        tried = [lesson for _, lesson in went if lesson is not None]
        if told.as_json:
            print_json(LearnedPlan(first, best, tried))
        else:
            _print_lessons(stdout(), first, best, tried, told.output)
    raise typer.Exit(130 if interrupted else 0)
