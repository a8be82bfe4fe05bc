"""`clamber trials` of a walk, or of a walker's task or plan: many seeds, and what they say together."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Annotated, Final

import numpy as np
import typer
from rich.console import Console

from ...execution.fault import check_faults
from ...families.walker.planning import load_walk
from ...families.walker.planning.task import WalkerTask
from ...families.walker.trials.faults import failing_of
from ...families.walker.trials.noise import named_walk_noise, read_walk_noise
from ...families.walker.trials.planned import careful, lay_plan, walk_of
from ...families.walker.trials.run_walk import walk_flaws
from ...families.walker.trials.trials import LEVEL, WalkCause, WalkSetup, WalkTrials, run_walk_trials
from ...json_form import INLINE
from ...planning.planners import find_planner
from ...planning.problem.plan import Plan
from ...trials.fault_trials import fault_rows
from ...trials.held_out import seeds_in_words
from ...trials.intervals import wilson_interval
from ...trials.plant_settings import split_settings
from ...units import DEGREE
from ..crew import CrewWords
from ..for_climbs import refuse_for_walk
from ..live_line import LiveLine
from ..output import announce_compilation, plain_table, print_json, stderr, stdout
from ..run.walk_plan import plan_walk
from .options import TrialsOptions
from .text import any_error, print_faults, share_range, some


@dataclass(frozen=True, slots=True)
class PrintedWalkTrials:
    """Many walks, of a walk or of a walker's plan."""

    trials: Annotated[WalkTrials, INLINE]
    held_out: bool
    """Whether all seeds are held out: none that any tuning may use."""


class WalkTrialsLine(LiveLine):
    """Follows many walks."""

    def update(self, trials: WalkTrials) -> None:
        """Show how many there are so far."""
        self.show(f"{len(trials.ended)} of {trials.asked} walks, {trials.done} to their end")


CLIMBS_ONLY: Final = ("replan", "force", "replay", "output")
"""Options of `trials` that neither a walk nor a walker's task has a use for."""
PLANS_ONLY: Final = ("task", "planner", "seconds")
"""Those that a walk has no use for, as it needs no plan."""


def walk_trials_of(what: str, asked: TrialsOptions, words: CrewWords) -> None:
    """Walk with every seed and print what came of it; leaves with 1 where a walk failed, or fewer than asked for succeed for sure.

    Args:
        what: The walk's name or file.
        asked: How, and how often.
        words: Who runs them, where they are kept, how they are told.
    """
    asked.check()
    refuse_for_walk(what, asked, (*PLANS_ONLY, *CLIMBS_ONLY))
    refuse_for_walk(what, words, CLIMBS_ONLY)
    sizes = read_walk_noise(named_walk_noise("usual"), asked.noise or ())
    for_walk, for_plant = split_settings(asked.overrides or ())
    walk = load_walk(what, for_walk)
    walk_flaws(walk, for_plant)  # what cannot be is told before workers start
    words.executor.check()
    announce_compilation(quiet=words.quiet)
    faults = tuple(asked.fault or ())
    check_faults(faults, failing_of(walk.robot).kinds)
    _try_and_tell(WalkSetup(walk, sizes, tuple(for_plant), faults=faults), asked, words)


def planned_walk_trials_of(
    what: str, task: WalkerTask, plan: Plan | None, asked: TrialsOptions, words: CrewWords
) -> None:
    """The same with a walker's task: planned once, or as the store has it planned, then walked with every seed.

    Args:
        what: The task's or plan's name or file.
        task: The task.
        plan: Its plan, which does not depend on the seeds; None: there is none yet.
        asked: How, and how often.
        words: Who runs them, where they are kept, how they are told.
    """
    asked.check()
    refuse_for_walk(what, asked, CLIMBS_ONLY)
    refuse_for_walk(what, words, CLIMBS_ONLY)
    find_planner(asked.planner)
    sizes = read_walk_noise(named_walk_noise("usual"), asked.noise or ())
    for_plant = tuple(split_settings(asked.overrides or ())[1])
    words.executor.check()  # before a minute is spent on a plan
    task = task if plan is not None else careful(task)
    faults = tuple(asked.fault or ())
    check_faults(faults, failing_of(task.robot).kinds)
    setup = WalkSetup(task, sizes, for_plant, plan, plan is None, faults)
    walk_flaws(walk_of(task), for_plant)
    plan = plan or setup.stored_plan(words.store)
    announce_compilation(quiet=words.quiet)
    plan = plan or plan_walk(task, asked.planner, seconds=asked.seconds, seed=0, quiet=words.quiet)
    lay_plan(task, plan, what)  # what it violates is told before workers start
    _try_and_tell(replace(setup, plan=plan), asked, words)


def _try_and_tell(setup: WalkSetup, asked: TrialsOptions, words: CrewWords) -> None:
    least = asked.least
    with WalkTrialsLine(stderr(), quiet=words.quiet) as line:
        trials = run_walk_trials(
            setup, asked.seeds, executor=words.executor, store=words.store, resume=words.resume, told=line.update
        )
    if words.as_json:
        print_json(PrintedWalkTrials(trials, asked.held_out))
    else:
        print_walk_trials(stdout(), trials, asked.seeds)
    if len(trials.ended) < trials.asked:
        raise typer.Exit(130)
    if setup.faults and least is None:
        raise typer.Exit(1 if any_error(fault_rows(trials.ended)) else 0)
    raise typer.Exit(0 if (trials.done == trials.asked if least is None else trials.interval[0] >= least) else 1)


def print_walk_trials(console: Console, trials: WalkTrials, seeds: Sequence[int]) -> None:
    """Print how often walks came to their end, and the spread of what is measured of them."""
    n = len(trials.ended)
    low, high = trials.interval
    style = "bold green" if trials.done == n else "bold red"
    console.print(f"{trials.done} of {n} walks '{trials.setup.name}' came to their end", style=style)
    console.print(f"95 % between {100 * low:.1f} and {100 * high:.1f} %")
    console.print(seeds_in_words(seeds))
    low, high = wilson_interval(trials.balanced, n)
    console.print(
        f"{trials.balanced} of {n} kept their balance throughout: 95 % between {100 * low:.1f} and {100 * high:.1f} %"
    )
    causes = trials.causes()
    if causes:
        print_walk_causes(console, causes)
    if trials.setup.faults:
        print_faults(console, fault_rows(trials.ended))
    lost = [trial.seed for trial in trials.ended if trial.done and not (trial.margin or 0.0) > 0.0]
    if lost:
        console.print(f"came to their end without a margin of balance at some tick: seeds {some(lost)}")
    table = plain_table("", "median", "5 %", "95 %", "least", "most", right=("median", "5 %", "95 %", "least", "most"))
    rows = (
        ("tilt [deg]", "tilt", DEGREE, 3), ("margin [mm]", "margin", 1e-3, 1), ("off [mm]", "off", 1e-3, 1),
        ("heading off [deg]", "turned", DEGREE, 2), ("time [s]", "seconds", 1.0, 0), ("kicks", "kicks", 1.0, 0),
        ("held over [m]", "held_way", 1.0, 3), ("held, farthest [mm]", "held_error", 1e-3, 2),
    )  # fmt: skip
    for title, name, unit, digits in rows:
        values = trials.of(name) / unit
        if name == "margin" and len(values) < n:
            title = f"{title}, of {len(values)}"
        if len(values):
            told = (*np.percentile(values, (50.0, 5.0, 95.0)), values.min(), values.max())
            table.add_row(title, *(f"{value:.{digits}f}" for value in told))
    console.print(table)
    if trials.setup.levels:
        low, high = wilson_interval(trials.level, n)
        console.print(
            f"{trials.level} of {n} came to their end with the plate never more than {LEVEL / DEGREE:g} deg from level: "
            f"95 % between {100 * low:.1f} and {100 * high:.1f} %"
        )
    walked = float(trials.of("seconds").sum())
    if trials.wall_seconds > 0.0:
        console.print(
            f"{trials.wall_seconds:.0f} s of computing: {walked / trials.wall_seconds:.0f} times as fast as they happen"
        )


def print_walk_causes(console: Console, causes: Sequence[WalkCause]) -> None:
    """Print a row for each way in which walks ended early, and the reason of the commonest."""
    table = plain_table("failed", "times", "of all, 95 %", "steps", "seeds", right=("times",))
    for cause in causes:
        table.add_row(cause.words, str(cause.n), share_range(cause.interval), some(cause.steps), some(cause.seeds))
    console.print(table)
    console.print(f"seed {causes[0].seeds[0]}: {causes[0].reason}", soft_wrap=True)
