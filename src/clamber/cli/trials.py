"""`clamber trials`: one plan or walk carried out many times, each time with another robot and world than believed."""

from typing import TYPE_CHECKING, Annotated

import typer

from .crew import CrewWords
from .name_completion import names_of
from .option_holder import shares
from .options import (
    PLAN_SECONDS,
    NoiseTexts,
    Overrides,
    PlannerName,
    PlanSeconds,
)
from .output import announce_compilation, print_json, stderr, stdout, tell_cuts

if TYPE_CHECKING:
    from pathlib import Path

    from ..experiments.climb.trial import TrialSetup


@shares(CrewWords)
def trials(
    what: Annotated[
        str,
        typer.Argument(
            metavar="TASK|PLAN|WALK",
            help="A task, to be planned once, a plan, or a walk: names or files.",
            autocompletion=names_of("tasks", "plans", "walks"),
        ),
    ],
    n: Annotated[int, typer.Option("-n", min=1, help="How many climbs.")] = 24,
    seed: Annotated[int, typer.Option(min=0, help="Of the first climb; each further one has the next.")] = 0,
    noise: NoiseTexts = None,
    task: Annotated[
        str | None,
        typer.Option(help="Carry the plan out in this task, in place of its own.", autocompletion=names_of("tasks")),
    ] = None,
    planner: PlannerName = "auto",
    seconds: PlanSeconds = PLAN_SECONDS,
    overrides: Overrides = None,
    replan: Annotated[bool, typer.Option(help="Plan again where a hold cannot be had.")] = True,
    force: Annotated[bool, typer.Option("--force", help="Carry out a plan that its checks refuse.")] = False,
    at_least: Annotated[
        str | None, typer.Option(help="Leave with 0 only if success is at least this with 97.5 % confidence.")
    ] = None,
    replay: Annotated[
        int | None, typer.Option(min=0, metavar="SEED", help="Climb this one trial again, for -o a log or a picture.")
    ] = None,
    *,
    words: CrewWords,
) -> None:
    """Climb many times under noise: how often it succeeds, why it fails, how long it takes, what matters.

    Each climb draws what is not as believed from its own seed (docs/climbing.md lists the keys and usual widths); `--noise none
    --noise friction=30%` leaves one of them. `-o` writes a picture (.png, .svg, .pdf), or with `--replay` what `clamber run` writes.
    """
    words.check()
    from ..tasks.walks import is_walk

    if is_walk(what):
        from .trials_walk import walk_trials_of

        for_climbs = {
            "--task": task is not None, "--planner": planner != "auto", "--seconds": seconds != PLAN_SECONDS, "--no-replan": not replan,
            "--force": force, "--replay": replay is not None, "--output": words.output is not None,
        }  # fmt: skip
        walk_trials_of(what, overrides or (), noise or (), range(seed, seed + n), _share(at_least), for_climbs, words)
        return
    from ..experiments.walk.planned import open_planned_walk
    from ..experiments.walk.run_walk import split_walk_settings

    planned = open_planned_walk(what, task, split_walk_settings(overrides or ())[0])
    if planned is not None:
        from .trials_walk import planned_walk_trials_of

        for_climbs = {
            "--no-replan": not replan,
            "--force": force,
            "--replay": replay is not None,
            "--output": words.output is not None,
        }
        planned_walk_trials_of(
            what, *planned, overrides or (), noise or (), planner, seconds, range(seed, seed + n), _share(at_least), for_climbs, words
        )  # fmt: skip
        return
    from ..experiments.climb.noise import named_noise, read_noise
    from ..experiments.climb.run_plan import open_climb
    from ..experiments.climb.trial import TrialSetup
    from ..experiments.climb.trial_summary import sum_up
    from ..experiments.climb.trials import NoPlanError, run_trials, with_plan
    from ..planning.planners import find_planner
    from .trials_text import TrialsLine, print_trials

    if words.output is not None:
        _check_suffix(words.output, replay)
    find_planner(planner)
    least = _share(at_least)
    widths = read_noise(named_noise("usual"), noise or ())
    announce_compilation(quiet=words.quiet)
    executor = words.executor
    if replay is None:
        executor.check()  # before a minute is spent on a plan
    chosen, plan, plant = open_climb(what, task, overrides or ())
    asked = TrialSetup(
        task=chosen, noise=widths, plan=plan, plant=plant, planner=planner, seconds=seconds, replan=replan, force=force
    )
    cuts: list[None] = []
    try:
        setup = with_plan(asked, words.store, what, cut=lambda: cuts.append(None))
    except NoPlanError as none:
        tell_cuts(len(cuts))
        stderr().print(str(none))
        raise typer.Exit(1) from None
    tell_cuts(len(cuts))
    if replay is not None:
        raise typer.Exit(_replay(setup, replay, words))
    with TrialsLine(stderr(), quiet=words.quiet) as line:
        told = run_trials(
            setup, range(seed, seed + n), executor=executor, store=words.store, resume=words.resume, told=line.update
        )  # fmt: skip
    summary = sum_up(told)
    if words.output is not None:
        from ..viewing.trials_plot import draw_trials

        draw_trials(summary, words.output)
    if words.as_json:
        print_json(summary.to_json() | {"trials": [trial.to_json() for trial in told.ended]})
    else:
        print_trials(stdout(), summary, words.output)
    if summary.n < summary.asked:
        raise typer.Exit(130)
    raise typer.Exit(0 if (summary.done == summary.n if least is None else summary.interval[0] >= least) else 1)


def _check_suffix(output: "Path", replay: int | None) -> None:
    from ..viewing.climb_run_view import check_run_suffix
    from ..viewing.output import CANVASES, check_suffix

    if replay is None:
        check_suffix(output, CANVASES)
    else:
        check_run_suffix(output)


def _share(text: str | None) -> float | None:
    """A share such as 98% or 0.98."""
    if text is None:
        return None
    from ..units import parse_quantity

    share = parse_quantity(text, "ratio")
    if not 0.0 <= share <= 1.0:
        raise typer.BadParameter(f"{text} must be 0 to 100 %", param_hint="--at-least")
    return share


def _replay(setup: "TrialSetup", seed: int, words: CrewWords) -> int:
    """One trial again; the exit code."""
    from ..experiments.climb.trial import climb_once
    from ..experiments.climb.trials import stored_trial
    from ..viewing.climb_run_view import write_run
    from .run_text import ClimbLine, print_run

    known, plans = stored_trial(setup, seed, words.store)
    with ClimbLine(stderr(), quiet=words.quiet) as line:
        run, trial, _ = climb_once(setup, seed, plans=plans, progress=line.update)
    if words.output is not None:
        write_run(run, words.output)
    if known is not None and known != trial:
        stderr().print(
            f"the store's trial {seed} went otherwise: another machine or other code; it ended {known.outcome}"
        )
    if words.as_json:
        print_json(run.to_json() | {"trial": trial.to_json()})
    else:
        print_run(stdout(), run, () if words.output is None else (words.output,))
    return 130 if run.report.reason == "interrupted" else 0 if run.report.done else 1
