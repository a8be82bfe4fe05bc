"""`clamber run`: carry a plan or a walk out in contact dynamics."""

from pathlib import Path
from typing import Annotated

import typer

from .name_completion import names_of
from .options import PLAN_SECONDS, AsJson, NoiseTexts, Overrides, PlannerName, PlanSeconds, Quiet
from .output import announce_compilation, check_writable, print_json, stderr, stdout, tell_cuts
from .repeat import repeat_words
from .run_report import RunReport

NOT_REPEATED = ("output", "save_plan", "report", "as_json", "quiet")
"""Options that change nothing of a run."""


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
    task: Annotated[
        str | None,
        typer.Option(help="Carry the plan out in this task, in place of its own.", autocompletion=names_of("tasks")),
    ] = None,
    planner: PlannerName = "auto",
    seconds: PlanSeconds = PLAN_SECONDS,
    overrides: Overrides = None,
    noise: NoiseTexts = None,
    peg_error: Annotated[str | None, typer.Option(help="Short for --noise peg_error=..., such as 3mm.")] = None,
    seed: Annotated[int, typer.Option(min=0, help="Of planner and noise.")] = 0,
    replan: Annotated[bool, typer.Option(help="Plan again where a hold cannot be had.")] = True,
    plant: Annotated[
        str, typer.Option(help="What moves: torques, volts, or the ADDRESS of `clamber plant serve`.")
    ] = "torques",
    force: Annotated[
        bool, typer.Option("--force", help="Carry out a plan that its checks refuse; the log says so.")
    ] = False,
    output: Annotated[
        list[Path] | None,
        typer.Option("--output", "-o", metavar="FILE", help="File to write; more than once for more."),
    ] = None,
    save_plan: Annotated[Path | None, typer.Option(metavar="FILE", help="Keep the plan (.json).")] = None,
    report: Annotated[
        Path | None,
        typer.Option(metavar="DIR", help="Write pages there: what was planned, what happened, where it was close."),
    ] = None,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Carry a plan or a walk out on a simulated robot: every action or step, what became of it, and where it ended.

    `--set plant.backlash=1deg` changes the plant, other keys the task; `--noise usual` lets the plant differ from what is believed
    (docs/climbing.md). A file of `-o` is a log (.mcap, .csv), an animation (.gif, .html, .mp4) or a picture (.png, .svg, .pdf).
    """
    outputs = list(dict.fromkeys(output or ()))
    telling = RunReport(report, repeat_words(context, NOT_REPEATED))
    for file in (*outputs, save_plan):
        check_writable(file)
    from ..tasks.walks import is_walk

    if is_walk(what):
        from .run_walk import run_walk_file

        for_climbs = {
            "--task": task is not None, "--planner": planner != "auto", "--seconds": seconds != PLAN_SECONDS,
            "--peg-error": peg_error is not None, "--no-replan": not replan, "--plant": plant != "torques", "--force": force,
            "--save-plan": save_plan is not None,
        }  # fmt: skip
        run_walk_file(
            what, overrides or (), noise or (), seed, outputs, for_climbs, telling, as_json=as_json, quiet=quiet
        )
        return
    from ..experiments.walk.planned import open_planned_walk
    from ..experiments.walk.run_walk import split_walk_settings

    planned = open_planned_walk(what, task, split_walk_settings(overrides or ())[0])
    if planned is not None:
        from .run_planned_walk import run_planned_walk

        for_climbs = {
            "--peg-error": peg_error is not None,
            "--no-replan": not replan,
            "--plant": plant != "torques",
            "--force": force,
        }
        run_planned_walk(
            what, *planned, overrides or (), noise or (), planner, seconds, seed, outputs, save_plan, for_climbs, telling,
            as_json=as_json, quiet=quiet,
        )  # fmt: skip
        return
    from ..experiments.climb.plants import check_plant, is_remote

    check_plant(plant)
    from ..experiments.climb.noise import NO_NOISE, check_noise, read_noise
    from ..experiments.climb.planning import plan_to_climb, replanner
    from ..experiments.climb.rehearsal import rehearse
    from ..experiments.climb.run_plan import climbing_flaws, open_climb, run_plan
    from ..planning.planners import find_planner
    from ..viewing.climb_run_view import check_run_suffix, write_run
    from .run_text import ClimbLine, print_run

    for file in outputs:
        check_run_suffix(file)
    telling.open("climb")
    find_planner(planner)
    deviations = read_noise(NO_NOISE, [*(noise or ()), *(() if peg_error is None else (f"peg_error={peg_error}",))])
    announce_compilation(quiet=quiet)
    chosen, plan, for_plant = open_climb(what, task, overrides or ())
    if for_plant and is_remote(plant):
        raise typer.BadParameter(f"{for_plant[0].partition('=')[0]} is the server's to set", param_hint="--set plant.")
    flaws = climbing_flaws(chosen, for_plant)
    check_noise(deviations, chosen.robot, flaws)
    cuts: list[None] = []

    def cut() -> None:
        cuts.append(None)

    if plan is None:
        plan = plan_to_climb(
            chosen,
            planner,
            seconds=seconds,
            seed=seed,
            cut=cut,
            rehearse=lambda task, plan: rehearse(task, plan, flaws),
        )
    if plan is None:
        tell_cuts(len(cuts))
        stderr().print(f"no plan for '{chosen.name}' that hooks can be trusted with; nothing has moved")
        raise typer.Exit(1)
    again = replanner(planner, seconds=seconds, seed=seed, cut=cut) if replan else None
    if save_plan is not None:
        plan.save(save_plan)
    streamed = next((file for file in outputs if file.suffix.lower() == ".mcap"), None)
    with ClimbLine(stderr(), quiet=quiet) as line:
        run = run_plan(
            chosen, plan, flaws, noise=deviations, seed=seed, force=force, replan=again, progress=line.update,
            label=what, log=streamed, plant=plant,
        )  # fmt: skip
    tell_cuts(len(cuts))
    for file in outputs:
        if file != streamed:
            write_run(run, file)
    page = telling.of_climb(run)
    if as_json:
        print_json(run.to_json())
    else:
        print_run(stdout(), run, (*outputs, *page))
    raise typer.Exit(130 if run.report.reason == "interrupted" else 0 if run.report.done else 1)
