"""`clamber trials` of a walk: many seeds, and what they say together."""

from collections.abc import Mapping, Sequence

import numpy as np
import typer
from rich.console import Console

from ..experiments.walk.trials import WalkTrials
from ..units import DEGREE
from .crew import CrewWords
from .live_line import LiveLine
from .output import plain_table, print_json, stderr, stdout


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
    from ..experiments.walk.trials import run_walk_trials
    from ..tasks.walks import load_walk

    for option, given in climbs_only.items():
        if given:
            raise typer.BadParameter(f"'{what}' is a walk, and this is for climbs", param_hint=option)
    sizes = read_walk_noise(named_walk_noise("usual"), noise)
    for_walk, for_plant = split_walk_settings(settings)
    walk = load_walk(what, for_walk)
    walk_flaws(walk, for_plant)  # what cannot be is told before workers start
    executor = words.executor
    executor.check()
    with WalkTrialsLine(stderr(), quiet=words.quiet) as line:
        trials = run_walk_trials(
            walk,
            sizes,
            seeds,
            executor=executor,
            plant=for_plant,
            store=words.store,
            resume=words.resume,
            told=line.update,
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
    console.print(f"{trials.done} of {n} walks '{trials.walk.name}' came to their end", style=style)
    console.print(f"95 % between {100 * low:.1f} and {100 * high:.1f} %; balanced throughout: {trials.balanced} of {n}")
    for trial in trials.ended:
        if not trial.done:
            console.print(f"  seed {trial.seed}: {trial.reason}", soft_wrap=True)
    table = plain_table("", "median", "5 %", "95 %", "least", "most", right=("median", "5 %", "95 %", "least", "most"))
    rows = (
        ("tilt [deg]", "tilt", DEGREE, 3), ("margin [mm]", "margin", 1e-3, 1), ("off [mm]", "off", 1e-3, 1),
        ("heading off [deg]", "turned", DEGREE, 2), ("time [s]", "seconds", 1.0, 0), ("kicks", "kicks", 1.0, 0),
        ("held over [m]", "held_way", 1.0, 3), ("held, farthest [mm]", "held_error", 1e-3, 2),
    )  # fmt: skip
    for title, name, unit, digits in rows:
        values = trials.of(name) / unit
        if len(values):
            told = (*np.percentile(values, (50.0, 5.0, 95.0)), values.min(), values.max())
            table.add_row(title, *(f"{value:.{digits}f}" for value in told))
    console.print(table)
    walked = float(trials.of("seconds").sum())
    if trials.wall_seconds > 0.0:
        console.print(
            f"{trials.wall_seconds:.0f} s of computing: {walked / trials.wall_seconds:.0f} times as fast as they happen"
        )
