"""A task, a plan or a walk carried out with many seeds, or with one of them again, and what is told of them."""

from typing import Any

import typer

from ...planning.planners import find_planner
from ...planning.progress import progress_text
from ...terminal.compile_ahead import compile_ahead
from ...terminal.live_line import LiveLine
from ...terminal.output import announce_compilation, print_json, refuse_unused, stderr, stdout, tell_cuts
from ...terminal.worker_options import WorkerOptions
from ...trials.dynamics import NoPlanError, RunEvents, TrialsRequest
from ...trials.fault_trials import fault_rows
from ...trials.trial_runs import Setup, Trials, run_trials, stored_result, wilson_interval
from ...trials.work import Work
from ...viewing.trials_text import any_error, percent
from .command import TrialsOptions


def try_out(work: Work, asked: TrialsOptions, words: WorkerOptions) -> None:
    """Carry it out with every seed; leaves with 1 where one failed, or fewer than asked for succeed for sure.

    With faults a run may fail: then it leaves with 1 only where one raised.

    Args:
        work: What is carried out.
        asked: How, and how often.
        words: Who runs them, where they are kept, how they are told.
    """
    dynamics = work.dynamics
    refuse_unused(asked, dynamics.unused(work.item), f"'{work.label}' is a {dynamics.kind}")
    if words.output is not None:
        from ...viewing.pictures import check_run_suffix

        (dynamics.check_picture if asked.replay is None else check_run_suffix)(words.output)
    find_planner(asked.planner)
    request = TrialsRequest(
        planner=asked.planner,
        plan_seconds=asked.seconds,
        noise=tuple(asked.noise or ()),
        plant=work.plant,
        replan=asked.replan,
        force=asked.force,
        faults=tuple(asked.fault or ()),
    )
    dynamics.check(work.item, request)
    if asked.replay is None:
        words.executor.check()  # before a minute is spent on a plan
    announce_compilation(quiet=words.quiet)
    compile_ahead(*dynamics.compiled)
    with LiveLine(stderr(), quiet=words.quiet, doing=f"preparing the {dynamics.kind}") as line:
        setup = _planned(work, request, words, line)
        if asked.replay is not None:
            raise typer.Exit(_replay(work, setup, asked.replay, words, line))
        line.show(f"0 of {asked.n} {dynamics.past}, the first ones are on their way", 0.0, now=True)
        trials = run_trials(
            setup,
            asked.seeds,
            executor=words.executor,
            store=words.store,
            resume=words.resume,
            told=lambda trials: line.show(
                _so_far(trials, dynamics.past), len(trials.ended) / trials.asked, now=len(trials.ended) == 1
            ),
        )
    if words.output is not None:
        dynamics.draw_trials(trials, words.output)
    if words.as_json:
        print_json(dynamics.trials_json(trials, asked.held_out))
    else:
        dynamics.print_trials(stdout(), trials, asked.seeds)
        if words.output is not None:
            stdout().print(f"written: {words.output}", soft_wrap=True)
    raise typer.Exit(_exit_code(trials, asked.least))


def _exit_code(trials: Trials[Any, Any], least: float | None) -> int:
    n, done = len(trials.ended), trials.done
    if n < trials.asked:
        return 130
    if trials.setup.faults and least is None:
        return 1 if any_error(fault_rows(trials.ended)) else 0
    return 0 if (done == n if least is None else wilson_interval(done, n)[0] >= least) else 1


def _so_far(trials: Trials[Any, Any], past: str) -> str:
    n = len(trials.ended)
    return f"{n} of {trials.asked}: {trials.done} {past}, {percent(trials.done, n)}"


def _planned(work: Work, request: TrialsRequest, words: WorkerOptions, line: LiveLine) -> Setup[Any, Any]:
    """What every trial has in common, planned if it was not; leaves with 1 where there is no plan."""
    cuts: list[None] = []
    events = RunEvents(
        search=lambda moment: line.show(progress_text(moment)), step=line.show, cut=lambda: cuts.append(None)
    )
    try:
        return work.dynamics.trials(work.item, work.plan, request, events, words.store, work.label)
    except NoPlanError as none:
        line.say(str(none))
        raise typer.Exit(1) from None
    finally:
        tell_cuts(len(cuts))


def _replay(work: Work, setup: Setup[Any, Any], seed: int, words: WorkerOptions, line: LiveLine) -> int:
    """One trial again; the exit code."""
    dynamics = work.dynamics
    kept = stored_result(setup, seed, words.store)
    run, trial = setup.again(seed, kept, line.show)
    if words.output is not None:
        from ...viewing.pictures import draw_run

        draw_run(run, words.output)
    if kept is not None and setup.trial(kept, words.store) != trial:
        line.say(f"the store's trial {seed} went otherwise: another machine or other code")
    if words.as_json:
        print_json(dynamics.replay_json(run, trial))
    else:
        dynamics.print_run(stdout(), run)
        if words.output is not None:
            stdout().print(f"written: {words.output}", soft_wrap=True)
    return 130 if run.report.reason == "interrupted" else 0 if run.done else 1
