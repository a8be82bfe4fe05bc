"""Many runs of a robot in space as a terminal shows them: what they say together, and why some ended early."""

from collections.abc import Sequence

from rich.console import Console

from ....viewing.trials_text import (
    print_causes,
    print_computing,
    print_effects,
    print_ended,
    print_faults,
    print_spreads,
)
from ..trials.noise import SPATIAL_NOISE
from ..trials.trials import SpatialTrials

ROWS = (
    ("body off its aim, as believed [mm]", "off", 1e-3, 1),
    ("not where it believes to be, at the end [mm]", "lost", 1e-3, 1),
    ("contacts that came off", "breaks", 1.0, 0),
    ("plans made on the way", "replans", 1.0, 0),
    ("time [s]", "seconds", 1.0, 0),
)


def print_spatial_trials(console: Console, trials: SpatialTrials, seeds: Sequence[int]) -> None:
    """Print how often runs came to their end, causes, and the spread of what is measured of them."""
    print_ended(console, trials, f"runs of '{trials.setup.name}'", seeds)
    causes, faults, effects = trials.causes(), trials.faults(), trials.effects()
    if causes:
        print_causes(console, causes, "after actions")
    if faults:
        print_faults(console, faults)
    print_spreads(console, ((title, trials.of(name) / unit, digits) for title, name, unit, digits in ROWS))
    if effects:
        print_effects(console, effects, SPATIAL_NOISE)
    print_computing(console, trials, 1)
