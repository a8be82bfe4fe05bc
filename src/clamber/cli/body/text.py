"""Comparisons on the body's bench as people read them."""

import math
from collections.abc import Sequence
from typing import Final

from rich.console import Console

from ...families.climber.trials.body_bench import BodyRun
from ...families.climber.trials.body_measures import BodyMeasures
from ...families.climber.trials.body_scenario import BodyScenario
from ...families.climber.trials.body_trials import PushTrial
from ...viewing.text_table import plain_table

COLUMNS: Final = {
    "radial_rms": ("radial rms\nmm", 1e3, 2),
    "behind_rms": ("off aim rms\nmm", 1e3, 2),
    "x_max": ("x max\nmm", 1e3, 1),
    "y_max": ("y max\nmm", 1e3, 1),
    "turn_max": ("turned max\ndeg", math.degrees(1.0), 2),
    "rest": ("rest off\nmm", 1e3, 1),
    "off_max": ("tip off peg\nmm", 1e3, 1),
}
"""Measure -> title, scale and digits."""
TELLING: Final = {
    "circle": ("radial_rms", "behind_rms", "turn_max"),
    "push-up": ("behind_rms", "x_max", "y_max", "turn_max", "rest", "off_max"),
    "push": ("x_max", "y_max", "turn_max", "rest", "off_max"),
}
"""Scenario -> what tells controls apart."""


def print_bodies(
    console: Console, runs: Sequence[BodyRun], measured: Sequence[BodyMeasures], scenario: BodyScenario
) -> None:
    """Print a table: a control a row."""
    keys = TELLING[scenario.kind]
    titles = [COLUMNS[key][0] for key in keys]
    table = plain_table("control", "Kp", *titles, "hooks", right=tuple(titles))
    for run, one in zip(runs, measured, strict=True):
        gains = run.entry.gains
        whole = ", ".join(f"{value:.4g}" for value in gains.kp)
        kp = f"{gains.leg_kp:.4g} a limb" if gains.scheme == "leg-by-leg" else whole
        table.add_row(run.entry.label, kp, *(_cell(one, key) for key in keys), _hooks(one.unhooked_at))
    console.print(table)


def print_trials(console: Console, label: str, trials: Sequence[PushTrial]) -> None:
    """Print what became of many pushes."""
    off = [trial for trial in trials if trial.measures.unhooked_at is not None]
    stayed = [trial.measures for trial in trials if trial.measures.unhooked_at is None]
    console.print(f"{label}: hooks stayed on in {len(stayed)} of {len(trials)} pushes")
    if stayed:
        most = max(one.x_max for one in stayed)
        mean = sum(one.x_max for one in stayed) / len(stayed)
        console.print(f"  moved along the push by {1e3 * mean:.1f} mm in the mean, {1e3 * most:.1f} mm at most")
    if off:
        console.print(f"  came off: seeds {', '.join(str(trial.seed) for trial in off[:20])}")


def _cell(one: BodyMeasures, key: str) -> str:
    value, (_, scale, digits) = getattr(one, key), COLUMNS[key]
    return "-" if value is None or not math.isfinite(value) else f"{scale * value:.{digits}f}"


def _hooks(when: float | None) -> str:
    return "on" if when is None else f"off at {when:.2f} s"
