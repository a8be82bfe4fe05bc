"""`clamber trials` of a walk, or of a walker's task or plan: many seeds, and what they say together."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
import typer
from rich.console import Console

from ..experiments.intervals import wilson_interval
from ..experiments.walk.trials import LEVEL, WalkCause, WalkTrials
from ..units import DEGREE
from .crew import CrewWords
from .live_line import LiveLine
from .output import announce_compilation, plain_table, print_json, stderr, stdout
from .plan_text import ProgressLine
from .trials_text import share_range, some

if TYPE_CHECKING:
    from ..actions.plan import Plan
    from ..experiments.walk.trials import WalkSetup
    from ..tasks.walker import WalkerTask


class WalkTrialsLine(LiveLine):
    """Follows many walks."""

    def update(self, trials: WalkTrials) -> None:
        """Show how many there are so far."""
        self.show(f"{len(trials.ended)} of {trials.asked} walks, {trials.done} to their end")


def walk_trials_of(
    what: str,
    settings: Sequence[str],
    noise: Sequence[str],
    seeds: Sequence[int],
    least: float | None,
    climbs_only: Mapping[str, bool],
    words: CrewWords,
) -> None:
    """Walk with every seed and print what came of it; leaves with 1 where a walk failed, or fewer than `least` for sure succeed.

    Args:
        what: The walk's name or file.
        settings: Texts "key=value" of walk and plant.
        noise: Texts "key=size", on top of the usual ones.
        seeds: One walk each.
        least: Share of success that is asked for; None: all.
        climbs_only: Options that only climbs have -> whether they are given.
        words: Who runs them, where they are kept, how they are told.
    """
    from ..experiments.walk.noise import named_walk_noise, read_walk_noise
    from ..experiments.walk.run_walk import split_walk_settings, walk_flaws
    from ..experiments.walk.trials import WalkSetup
    from ..tasks.walks import load_walk

    _refuse(what, climbs_only)
    sizes = read_walk_noise(named_walk_noise("usual"), noise)
    for_walk, for_plant = split_walk_settings(settings)
    walk = load_walk(what, for_walk)
    walk_flaws(walk, for_plant)  # what cannot be is told before workers start
    words.executor.check()
    announce_compilation(quiet=words.quiet)
    _try_and_tell(WalkSetup(walk, sizes, tuple(for_plant)), seeds, least, words)


def planned_walk_trials_of(
    what: str,
    task: "WalkerTask",
    plan: "Plan | None",
    settings: Sequence[str],
    noise: Sequence[str],
    planner: str,
    seconds: float,
    seeds: Sequence[int],
    least: float | None,
    climbs_only: Mapping[str, bool],
    words: CrewWords,
) -> None:
    """The same with a walker's task: planned once, or as the store has it planned, then walked with every seed.

    Args:
        what: The task's or plan's name or file.
        task: The task.
        plan: Its plan; None: there is none yet.
        settings: Texts "key=value" of task and plant.
        noise: Texts "key=size", on top of the usual ones.
        planner: How to search.
        seconds: For which the planner may search [s].
        seeds: One walk each; the plan does not depend on them.
        least: As for `walk_trials_of`, as are `climbs_only` and `words`.
    """
    from dataclasses import replace

    from ..errors import UnknownNameError
    from ..experiments.walk.noise import named_walk_noise, read_walk_noise
    from ..experiments.walk.planned import careful, lay_plan, walk_of
    from ..experiments.walk.run_walk import split_walk_settings, walk_flaws
    from ..experiments.walk.trials import WalkSetup
    from ..planning.planners import PLANNERS, plan_task

    _refuse(what, climbs_only)
    if planner not in PLANNERS:
        raise UnknownNameError("planner", planner, tuple(PLANNERS))
    sizes = read_walk_noise(named_walk_noise("usual"), noise)
    for_plant = tuple(split_walk_settings(settings)[1])
    words.executor.check()  # before a minute is spent on a plan
    task = task if plan is not None else careful(task)
    setup = WalkSetup(task, sizes, for_plant, plan, plan is None)
    walk_flaws(walk_of(task), for_plant)
    plan = plan or setup.stored_plan(words.store)
    announce_compilation(quiet=words.quiet)
    if plan is None:
        with ProgressLine(stderr(), quiet=words.quiet) as line:
            result = plan_task(task, planner, seed=0, seconds=seconds, progress=line.update)
        if not result.has_plan:
            stderr().print(f"no plan for '{task.name}' that can bear to be walked: {result.reason}; nothing has moved")
            raise typer.Exit(1)
        plan = result.plan
    lay_plan(task, plan, what)  # what it violates is told before workers start
    _try_and_tell(replace(setup, plan=plan), seeds, least, words)


def _refuse(what: str, climbs_only: Mapping[str, bool]) -> None:
    for option, given in climbs_only.items():
        if given:
            raise typer.BadParameter(f"'{what}' is a walk, and this is for climbs", param_hint=option)


def _try_and_tell(setup: "WalkSetup", seeds: Sequence[int], least: float | None, words: CrewWords) -> None:
    from ..experiments.walk.trials import run_walk_trials

    with WalkTrialsLine(stderr(), quiet=words.quiet) as line:
        trials = run_walk_trials(
            setup, seeds, executor=words.executor, store=words.store, resume=words.resume, told=line.update
        )
    if words.as_json:
        print_json(trials.to_json())
    else:
        print_walk_trials(stdout(), trials)
    if len(trials.ended) < trials.asked:
        raise typer.Exit(130)
    raise typer.Exit(0 if (trials.done == trials.asked if least is None else trials.interval[0] >= least) else 1)


def print_walk_trials(console: Console, trials: WalkTrials) -> None:
    """Print how often walks came to their end, and the spread of what is measured of them."""
    n = len(trials.ended)
    low, high = trials.interval
    style = "bold green" if trials.done == n else "bold red"
    console.print(f"{trials.done} of {n} walks '{trials.setup.name}' came to their end", style=style)
    console.print(f"95 % between {100 * low:.1f} and {100 * high:.1f} %")
    low, high = wilson_interval(trials.balanced, n)
    console.print(
        f"{trials.balanced} of {n} kept their balance throughout: 95 % between {100 * low:.1f} and {100 * high:.1f} %"
    )
    causes = trials.causes()
    if causes:
        print_walk_causes(console, causes)
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
