"""A task, a plan or a walk carried out once, and what is told of it."""

from pathlib import Path
from typing import Any

import typer

from ...interrupts import answer
from ...planning.progress import progress_text
from ...terminal.compile_ahead import compile_ahead
from ...terminal.live_line import LiveLine
from ...terminal.output import print_json, refuse_unused, stderr, stdout, tell_cuts
from ...trials.dynamics import NoPlanError, RunEvents, RunRequest
from ...trials.work import Work
from ...viewing.report.pages import open_report
from .command import RunOptions


def carry_out(work: Work, words: RunOptions, command: str) -> None:
    """Carry it out and say how it went; leaves with 1 where there is no plan, or where it did not come to its end.

    Args:
        work: What is carried out.
        words: How.
        command: What repeats the run, for its report.
    """
    dynamics = work.dynamics
    refuse_unused(words, dynamics.unused(work.item), f"'{work.label}' is a {dynamics.kind}")
    if words.outputs:
        from ...viewing.pictures import check_run_suffix

        for file in words.outputs:
            check_run_suffix(file)
    peg_error = () if words.peg_error is None else (f"peg_error={words.peg_error}",)
    noise = (*(words.noise or ()), *peg_error)
    with LiveLine(stderr(), quiet=words.quiet, doing=f"preparing the {dynamics.kind}") as line:
        asked = RunRequest(
            planner=words.planner,
            plan_seconds=words.seconds,
            noise=noise,
            plant=work.plant,
            seed=words.seed,
            law=words.law,
            replan=words.replan,
            force=words.force,
            motors=words.plant,
            log=words.log(line.say),
        )
        work.check(asked)
        if work.note and not words.quiet:
            line.say(work.note)
        if words.report is not None:
            open_report(words.report, dynamics.kind)
        compile_ahead(*dynamics.compiled)
        cuts: list[None] = []
        events = RunEvents(
            search=lambda moment: line.show(progress_text(moment)),
            cut=lambda: cuts.append(None),
            planned=lambda plan: None if words.save_plan is None else plan.save(words.save_plan),
            note=lambda told: None if words.quiet else line.say(told),
            step=line.show,
        )
        if work.plan is not None:
            events.planned(work.plan)
        try:
            run = dynamics.run(work.item, work.plan, asked, events, work.label)
        except NoPlanError as none:
            line.say(str(none))
            raise typer.Exit(1) from None
        except KeyboardInterrupt:  # of a run that has begun, its report tells
            answer()
            line.say("interrupted while it was planned; nothing has moved")
            raise typer.Exit(130) from None
        finally:
            tell_cuts(len(cuts))
    interrupted = _tell(work, words, run, command)
    raise typer.Exit(130 if interrupted else 0 if run.done else 1)


def _tell(work: Work, words: RunOptions, run: Any, command: str) -> bool:
    """Write the files of a run and print it; whether Ctrl-C cut the run or its drawing short."""
    missing = [file for file in words.outputs if file != words.growing]
    missing += [] if words.report is None else [words.report]
    interrupted: bool = run.report.reason == "interrupted"
    pages: list[Path] = []
    with LiveLine(stderr(), quiet=words.quiet) as line:
        try:
            _draw(words, run, command, missing, pages, line)
        except KeyboardInterrupt:  # the run is over, and what it came to is told all the same
            answer()
            line.say("interrupted while files were drawn; the run was over")
            interrupted = True
    written = [file for file in words.written(run.log_gap) if file not in missing] + pages
    if words.as_json:
        print_json(run)
        return interrupted
    console = stdout()
    work.dynamics.print_run(console, run)
    if run.log_gap is not None:
        console.print(str(run.log_gap), soft_wrap=True)
    for path in written:
        console.print(f"written: {path}", soft_wrap=True)
    if missing:
        console.print(f"not made, as it was interrupted: {', '.join(map(str, missing))}", soft_wrap=True)
    return interrupted


def _draw(words: RunOptions, run: Any, command: str, missing: list[Path], pages: list[Path], line: LiveLine) -> None:
    """Draw the files and pages that are missing, and strike them off; of a run that was interrupted no films and pages, which take long."""
    if not missing:
        return
    from ...viewing.pictures import ANIMATIONS, draw_run
    from ...viewing.report.run_page import write_run_report

    for file in tuple(missing):
        is_page = file == words.report
        if run.report.reason == "interrupted" and (is_page or file.suffix.lower() in ANIMATIONS):
            continue
        if is_page:
            pages.append(write_run_report(run, command, file))
        else:
            draw_run(run, file, line.counting(f"{file.name}: frame"))
        missing.remove(file)
