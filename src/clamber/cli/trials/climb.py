"""`clamber trials` of a climber's task or plan: many seeds, or one of them again."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from ...execution.fault import FAULTS, check_faults
from ...families.climber.trials.noise import named_noise, read_noise
from ...families.climber.trials.run_plan import ClimbRun, open_climb
from ...families.climber.trials.trial import ClimbTrial, TrialSetup, climb_once
from ...families.climber.trials.trial_summary import TrialSummary, sum_up
from ...families.climber.trials.trials import NoPlanError, run_trials, stored_trial, with_plan
from ...json_form import INLINE
from ...planning.planners import find_planner
from ..compile_ahead import CLIMBING, compile_ahead
from ..crew import CrewWords
from ..output import announce_compilation, print_json, stderr, stdout, tell_cuts
from .options import TrialsOptions
from .text import TrialsLine, any_error, print_trials


@dataclass(frozen=True, slots=True)
class ClimbTrials:
    """Many climbs of one plan."""

    summary: Annotated[TrialSummary, INLINE]
    held_out: bool
    """Whether all seeds are held out: none that any tuning may use."""
    trials: list[ClimbTrial]


@dataclass(frozen=True, slots=True)
class ReplayedTrial:
    """`--replay SEED`: one climb of the trials again."""

    run: Annotated[ClimbRun, INLINE]
    trial: ClimbTrial


def climb_trials_of(what: str, asked: TrialsOptions, words: CrewWords) -> None:
    """Climb with every seed and print what came of it; leaves with 1 where a climb failed, or fewer than asked for succeed for sure.

    With faults a climb may fail: then it leaves with 1 only where one raised.

    Args:
        what: The task's or plan's name or file.
        asked: How, and how often.
        words: Who runs them, where they are kept, how they are told.
    """
    if words.output is not None:
        _check_suffix(words.output, asked.replay)
    find_planner(asked.planner)
    asked.check()
    least = asked.least
    setup = _planned(what, asked, words)
    if asked.replay is not None:
        raise typer.Exit(_replay(setup, asked.replay, words))
    with TrialsLine(stderr(), quiet=words.quiet) as line:
        told = run_trials(
            setup, asked.seeds, executor=words.executor, store=words.store, resume=words.resume, told=line.update
        )  # fmt: skip
    summary = sum_up(told)
    if words.output is not None:
        from ...families.climber.pictures.charts import draw_trials

        draw_trials(summary, words.output)
    if words.as_json:
        print_json(ClimbTrials(summary, asked.held_out, told.ended))
    else:
        print_trials(stdout(), summary, asked.seeds, words.output)
    if summary.n < summary.asked:
        raise typer.Exit(130)
    if setup.faults and least is None:
        raise typer.Exit(1 if any_error(summary.faults) else 0)
    raise typer.Exit(0 if (summary.done == summary.n if least is None else summary.interval[0] >= least) else 1)


def _check_suffix(output: Path, replay: int | None) -> None:
    from ...viewing.output import CANVASES, check_suffix
    from ...viewing.pictures import check_run_suffix

    if replay is None:
        check_suffix(output, CANVASES)
    else:
        check_run_suffix(output)


def _planned(what: str, asked: TrialsOptions, words: CrewWords) -> TrialSetup:
    """What every trial has in common, planned if it was not; leaves with 1 where there is no plan."""
    widths = read_noise(named_noise("usual"), asked.noise or ())
    announce_compilation(quiet=words.quiet)
    compile_ahead(CLIMBING)
    if asked.replay is None:
        words.executor.check()  # before a minute is spent on a plan
    task, plan, plant = open_climb(what, asked.task, asked.overrides or ())
    check_faults(asked.fault or (), tuple(FAULTS))
    setup = TrialSetup(
        task=task, noise=widths, plan=plan, plant=plant, planner=asked.planner, seconds=asked.seconds,
        replan=asked.replan, force=asked.force, faults=tuple(asked.fault or ()),
    )  # fmt: skip
    cuts: list[None] = []
    try:
        planned = with_plan(setup, words.store, what, cut=lambda: cuts.append(None))
    except NoPlanError as none:
        tell_cuts(len(cuts))
        stderr().print(str(none))
        raise typer.Exit(1) from None
    tell_cuts(len(cuts))
    return planned


def _replay(setup: TrialSetup, seed: int, words: CrewWords) -> int:
    """One trial again; the exit code."""
    from ...viewing.pictures import draw_run
    from ..run.text import ClimbLine, print_run

    known, plans = stored_trial(setup, seed, words.store)
    with ClimbLine(stderr(), quiet=words.quiet) as line:
        run, trial, _ = climb_once(setup, seed, plans=plans, progress=line.update)
    if words.output is not None:
        draw_run(run, words.output)
    if known is not None and known != trial:
        stderr().print(
            f"the store's trial {seed} went otherwise: another machine or other code; it ended {known.outcome}"
        )
    if words.as_json:
        print_json(ReplayedTrial(run, trial))
    else:
        print_run(stdout(), run, () if words.output is None else (words.output,))
    return 130 if run.report.reason == "interrupted" else 0 if run.report.done else 1
