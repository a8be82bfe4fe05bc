"""Many runs of a robot in space as a terminal shows them: what they say together, and why some ended early."""

from collections.abc import Sequence

import numpy as np
from rich.console import Console

from ....trials.held_out import seeds_in_words
from ....viewing.text_table import plain_table
from ....viewing.trials_text import print_causes, print_effects, print_faults
from ..trials.noise import SPATIAL_NOISE
from ..trials.trials import SpatialTrials

SPREAD = ("median", "5 %", "95 %", "least", "most")
ROWS = (
    ("body off its aim, as believed [mm]", "off", 1e-3, 1),
    ("not where it believes to be, at the end [mm]", "lost", 1e-3, 1),
    ("contacts that came off", "breaks", 1.0, 0),
    ("plans made on the way", "replans", 1.0, 0),
    ("time [s]", "seconds", 1.0, 0),
)


def print_spatial_trials(console: Console, trials: SpatialTrials, seeds: Sequence[int]) -> None:
    """Print how often runs came to their end, causes, and the spread of what is measured of them."""
    n = len(trials.ended)
    faults = trials.faults()
    low, high = trials.interval
    style = "bold green" if trials.done == n else "bold red"
    console.print(f"{trials.done} of {n} runs of '{trials.setup.name}' came to their end", style=style)
    console.print(f"95 % between {100 * low:.1f} and {100 * high:.1f} %")
    console.print(seeds_in_words(seeds))
    causes = trials.causes()
    if causes:
        print_causes(console, causes, "after actions")
    if faults:
        print_faults(console, faults)
    table = plain_table("", *SPREAD, right=SPREAD)
    for title, name, unit, digits in ROWS:
        values = trials.of(name) / unit
        if len(values):
            told = (*np.percentile(values, (50.0, 5.0, 95.0)), values.min(), values.max())
            table.add_row(title, *(f"{value:.{digits}f}" for value in told))
    console.print(table)
    effects = trials.effects()
    if effects:
        print_effects(console, effects, SPATIAL_NOISE)
    ran = float(trials.of("seconds").sum())
    if trials.wall_seconds > 0.0:
        console.print(
            f"{trials.wall_seconds:.0f} s of computing: {ran / trials.wall_seconds:.1f} times as fast as they happen"
        )
