"""A task, a plan or a walk carried out with many seeds, or with one of them again, and what is told of them."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import typer

from ...json_form import Jsonable, plain
from ...planning.progress import progress_text
from ...terminal.compile_ahead import compile_ahead
from ...terminal.live_line import LiveLine
from ...terminal.output import print_json, refuse_unused, stderr, stdout, tell_cuts
from ...terminal.worker_options import WorkerOptions
from ...trials.dynamics import NoPlanError, RunEvents, TrialsRequest
from ...trials.fault_trials import fault_rows
from ...trials.trial_runs import Paired, Setup, Trials, run_trials, stored_result, wilson_interval
from ...trials.work import Work
from ...types import Json
from ...viewing.trials_text import any_error, percent
from .command import TrialsOptions


@dataclass(frozen=True, slots=True, kw_only=True)
class Compared(Jsonable):
    """Two works tried with the same seeds."""

    first: Json
    """As `clamber trials` prints them."""
    second: Json
    paired: Paired


def try_out(works: Sequence[Work], asked: TrialsOptions, words: WorkerOptions) -> None:
    """Carry works out with every seed; leaves with 1 where one failed, or fewer than asked for succeed for sure.

    With faults a run may fail: then it leaves with 1 only where one raised; with two works it leaves with 0 unless a share is asked for.

    Args:
        works: What is carried out, and what it is compared with.
        asked: How, and how often.
        words: Who runs them, where they are kept, how they are told.
    """
    laws = asked.law, asked.against_law or asked.law
    requests = [_request(work, asked, words, law) for work, law in zip(works, laws, strict=False)]
    if asked.replay is None:
        words.executor.check()  # before a minute is spent on a plan
    tried = []
    for number, (work, request) in enumerate(zip(works, requests, strict=True)):
        store = words.store if number == 0 else _beside(words.store)
        tried.append(_tried(work, request, asked, replace(words, store=store)))
        if len(tried[-1].ended) < asked.n:
            break
    paired = tried[0].against(tried[1]) if len(tried) == 2 and tried[1].ended else None
    if words.as_json:
        told = [work.dynamics.trials_json(trials, asked.held_out) for work, trials in zip(works, tried, strict=False)]
        print_json(told[0] if paired is None else Compared(first=plain(told[0]), second=plain(told[1]), paired=paired))
    else:
        for work, trials in zip(works, tried, strict=False):
            work.dynamics.print_trials(stdout(), trials, asked.seeds)
        if paired is not None:
            stdout().print(paired.told())
    for work, trials, file in zip(works, tried, (words.output, _beside(words.output)), strict=False):
        if file is not None:
            work.dynamics.draw_trials(trials, file)
            if not words.as_json:
                stdout().print(f"written: {file}", soft_wrap=True)
    raise typer.Exit(max(_exit_code(trials, asked.least, lenient=len(works) > 1) for trials in tried))


def _beside(file: Path | None) -> Path | None:
    """Where what is compared is kept: beside what it is compared with."""
    return None if file is None else file.with_name(f"{file.stem}-against{file.suffix}")


def _request(work: Work, asked: TrialsOptions, words: WorkerOptions, law: str | None) -> TrialsRequest:
    """How a work is tried, after everything that can't be was refused."""
    dynamics = work.dynamics
    refuse_unused(asked, dynamics.unused(work.item), f"'{work.label}' is a {dynamics.kind}")
    if words.output is not None:
        from ...viewing.pictures import check_run_suffix

        (dynamics.check_picture if asked.replay is None else check_run_suffix)(words.output)
    request = TrialsRequest(
        planner=asked.planner,
        plan_seconds=asked.seconds,
        noise=tuple(asked.noise or ()),
        plant=work.plant,
        law=law,
        replan=asked.replan,
        force=asked.force,
        faults=tuple(asked.fault or ()),
    )
    work.check(request)
    return request


def _tried(work: Work, request: TrialsRequest, asked: TrialsOptions, words: WorkerOptions) -> Trials[Any, Any]:
    """Carry a work out with every seed, or leave with the one that is to be seen again."""
    dynamics = work.dynamics
    compile_ahead(*dynamics.compiled)
    with LiveLine(stderr(), quiet=words.quiet, doing=f"preparing the {dynamics.kind}") as line:
        if work.note and not words.quiet:
            line.say(work.note)
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
        if not trials.ended:
            line.say(f"interrupted before the first of {asked.n} had ended")
            raise typer.Exit(130)
        return trials


def _exit_code(trials: Trials[Any, Any], least: float | None, *, lenient: bool) -> int:
    n, done = len(trials.ended), trials.done
    if n < trials.asked:
        return 130
    if trials.setup.faults and least is None:
        return 1 if any_error(fault_rows(trials.ended)) else 0
    if lenient and least is None:
        return 0
    return 0 if (done == n if least is None else wilson_interval(done, n)[0] >= least) else 1


def _so_far(trials: Trials[Any, Any], past: str) -> str:
    n = len(trials.ended)
    return f"{n} of {trials.asked}: {trials.done} {past}, {percent(trials.done, n)}"


def _planned(work: Work, request: TrialsRequest, words: WorkerOptions, line: LiveLine) -> Setup[Any, Any]:
    """What every trial has in common, planned if it was not; leaves with 1 where there is no plan."""
    cuts: list[None] = []
    events = RunEvents(
        search=lambda moment: line.show(progress_text(moment)),
        cut=lambda: cuts.append(None),
        note=lambda told: None if words.quiet else line.say(told),
        step=line.show,
    )
    try:
        return work.dynamics.trials(work.item, work.plan, request, events, words.store, work.label)
    except NoPlanError as none:
        line.say(str(none))
        raise typer.Exit(1) from None
    finally:
        tell_cuts(len(cuts))


def _replay(work: Work, setup: Setup[Any, Any], seed: int, words: WorkerOptions, line: LiveLine) -> int:
    """A trial again; the exit code."""
    dynamics = work.dynamics
    kept = stored_result(setup, seed, words.store)
    run, trial = setup.again(seed, kept, line.show)
    if words.output is not None:
        from ...viewing.pictures import draw_run

        draw_run(run, words.output, line.counting("frame"))
    if kept is not None and setup.trial(kept, words.store) != trial:
        line.say(f"the store's trial {seed} went otherwise: another machine or other code")
    if words.as_json:
        print_json(dynamics.replay_json(run, trial))
    else:
        dynamics.print_run(stdout(), run)
        if words.output is not None:
            stdout().print(f"written: {words.output}", soft_wrap=True)
    return 130 if run.report.reason == "interrupted" else 0 if run.done else 1
