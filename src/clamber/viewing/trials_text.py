"""Shares, causes, faults and what of the noise matters of many runs as a terminal shows them."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Final

import numpy as np
from rich.console import Console

from ..execution.fault import FAULTS
from ..trials.fault_trials import ENDINGS, FaultRow
from ..trials.held_out import seeds_in_words
from ..trials.noise import NoiseKind
from ..trials.sensitivity import VERDICTS, Effect, Third
from ..trials.trial_runs import Trials, wilson_interval
from ..types import Floats
from .text_table import plain_table

MOST_NAMED: Final = 6
"""Seeds and steps of a cause that are named; the rest is in the JSON."""


def percent(done: int, n: int) -> str:
    """A share with its interval, such as "95.8 % (79.8 to 99.3 %, 95 %)"."""
    if n == 0:
        return "nothing to tell"
    return f"{100.0 * done / n:.1f} % ({share_range(wilson_interval(done, n))}, 95 %)"


def print_ended(console: Console, trials: Trials[Any, Any], of: str, seeds: Sequence[int]) -> None:
    """Print how many of some trials, such as "runs of 'ladder'", came to their end, with the interval of their share."""
    n = len(trials.ended)
    style = "bold green" if trials.done == n else "bold red"
    console.print(f"{trials.done} of {n} {of} came to their end", style=style)
    console.print(between(trials.interval))
    console.print(seeds_in_words(seeds))


def print_spreads(console: Console, rows: Iterable[tuple[str, Floats, int]]) -> None:
    """Print the spread of what was measured: title, values, digits; nothing of what has no values."""
    columns = ("median", "5 %", "95 %", "least", "most")
    table = plain_table("", *columns, right=columns)
    for title, values, digits in rows:
        if len(values):
            told = (*np.percentile(values, (50.0, 5.0, 95.0)), values.min(), values.max())
            table.add_row(title, *(f"{value:.{digits}f}" for value in told))
    console.print(table)


def print_computing(console: Console, trials: Trials[Any, Any], digits: int) -> None:
    """Print how long trials took, and how much faster than what they simulate."""
    simulated = float(trials.of("seconds").sum())
    if trials.wall_seconds > 0.0:
        speed = f"{simulated / trials.wall_seconds:.{digits}f}"
        console.print(f"{trials.wall_seconds:.0f} s of computing: {speed} times as fast as they happen")


def between(interval: tuple[float, float]) -> str:
    """An interval of a share, such as "95 % between 92.6 and 100.0 %"."""
    low, high = interval
    return f"95 % between {100.0 * low:.1f} and {100.0 * high:.1f} %"


def share_range(interval: tuple[float, float]) -> str:
    """An interval of a share, such as "92.6 to 100.0 %"."""
    low, high = interval
    return f"{100.0 * low:.1f} to {100.0 * high:.1f} %"


def some(numbers: Sequence[int]) -> str:
    """The first few numbers of many."""
    shown = ", ".join(map(str, numbers[:MOST_NAMED]))
    return f"{shown} ..." if len(numbers) > MOST_NAMED else shown


def print_causes(console: Console, causes: Sequence[Any], steps: str = "steps") -> None:
    """Print a row for each way in which runs ended early (such as a `trial_runs.Cause`), and the reason of the commonest."""
    table = plain_table("failed", "times", "of all, 95 %", steps, "seeds", right=("times",))
    for cause in causes:
        table.add_row(cause.words, str(cause.n), share_range(cause.interval), some(cause.steps), some(cause.seeds))
    console.print(table)
    console.print(f"seed {causes[0].seeds[0]}: {causes[0].reason}", soft_wrap=True)


def any_error(rows: Sequence[FaultRow]) -> bool:
    """Whether a trial raised."""
    return any(row.endings["error"] for row in rows)


def print_faults(console: Console, rows: Sequence[FaultRow]) -> None:
    """Print how trials with each kind of fault ended, how many noticed it, and how soon."""
    table = plain_table("fault", "n", *ENDINGS, "noticed", "after [s]", right=("n", *ENDINGS, "noticed", "after [s]"))
    for row in rows:
        delay = "" if row.delay is None else f"{row.delay:.2f}"
        table.add_row(row.kind, str(row.n), *(str(row.endings[name]) for name in ENDINGS), str(row.noticed), delay)
    console.print(table)
    for row in rows:
        if row.kind in FAULTS:
            console.print(f"{row.kind}: {FAULTS[row.kind].words}", soft_wrap=True)


def print_effects(console: Console, effects: Sequence[Effect], kinds: Mapping[str, NoiseKind]) -> None:
    """Print success by thirds of each key, and where it fails more, if that can be told."""
    if all(effect.verdict == "too few" for effect in effects):
        console.print(f"{VERDICTS['too few']} what of the noise matters")
        return
    thirds = ("low third", "middle", "high")
    table = plain_table("success [%] by", "drawn", *thirds, right=thirds)
    for effect in effects:
        table.add_row(effect.key, _reach(effect, kinds[effect.key]), *[*map(_third, effect.thirds), "", ""][:3])
    console.print(table)
    clear = [effect for effect in effects if effect.verdict != "none"]
    for effect in clear:
        console.print(f"{effect.key} {VERDICTS[effect.verdict]} (p = {effect.p:.2g})")
    if not clear:
        console.print("no key stands out (rank tests at 5 % over all of them)")


def _third(third: Third) -> str:
    low, high = third.interval
    return f"{100.0 * third.done / third.n:.0f} ({100.0 * low:.0f}-{100.0 * high:.0f})"


def _reach(effect: Effect, kind: NoiseKind) -> str:
    low, high = effect.thirds[0].low / kind.scale, effect.thirds[-1].high / kind.scale
    return f"{low:.2g}..{high:.2g} {kind.unit}"
