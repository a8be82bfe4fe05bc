"""Many climbs as people read them: a live line on the way, then success, causes, times and what of the noise matters."""

from collections.abc import Sequence
from pathlib import Path

from rich.console import Console

from ...execution.fault import FAULTS
from ...families.climber.trials.noise import NOISE
from ...families.climber.trials.sensitivity import VERDICTS, Effect, Third
from ...families.climber.trials.trial_summary import Cause, Spread, TrialSummary
from ...families.climber.trials.trials import Trials
from ...trials.fault_trials import ENDINGS, FaultRow
from ...trials.held_out import seeds_in_words
from ...trials.intervals import wilson_interval
from ..live_line import LiveLine
from ..output import plain_table

MOST_NAMED = 6
"""Seeds and steps of a cause that are named; the rest is in the JSON."""


class TrialsLine(LiveLine):
    """Follows many climbs."""

    def update(self, trials: Trials) -> None:
        """Show how many climbs ended, and how."""
        n, done = len(trials.ended), trials.done
        self.show(f"{n} of {trials.asked}: {done} climbed, {_percent(done, n)}")


def print_trials(console: Console, summary: TrialSummary, seeds: Sequence[int], written: Path | None) -> None:
    """Print success with its interval, a row for each cause of failure, times, and a row for each key of the noise."""
    n, done = summary.n, summary.done
    early = f" (of {summary.asked} asked for)" if n < summary.asked else ""
    console.print(f"{done} of {n} climbs of '{summary.task}' succeeded{early}: {_percent(done, n)}", style="bold")
    console.print(seeds_in_words(seeds))
    console.print(f"noise: {summary.noise}")
    for objection in summary.forced:
        console.print(f"forced in spite of {objection}")
    if summary.causes:
        print_causes(console, summary.causes)
    if summary.seconds is not None:
        console.print(f"time of a climb: {_times(summary.seconds)}")
    if summary.per_rung is not None:
        console.print(f"for each 6 in of way: {_times(summary.per_rung)}")
    if summary.short is not None:
        middle, high = (1e3 * part for part in (summary.short.median, summary.short.high))
        console.print(f"body from the goal at the end: {middle:.0f} mm (95 %: at most {high:.0f} mm)")
    if summary.pushes is not None:
        console.print(
            f"pushes for each grab: {summary.pushes:.2f}; moves that did not arrive: {summary.stalled}; "
            f"climbs with a new plan: {summary.replanned}"
        )
    if summary.recovered:
        console.print(
            f"hooks that came off and were brought back: {summary.recovered}, in {summary.recovering} climbs, "
            f"{summary.saved} of which succeeded"
        )
    if summary.speed is not None:
        console.print(f"{summary.speed:.0f} times as fast as it happens, each worker")
    if summary.faults:
        print_faults(console, summary.faults)
    if summary.effects:
        _print_effects(console, summary.effects)
    if written is not None:
        console.print(f"written: {written}", soft_wrap=True)


def print_causes(console: Console, causes: tuple[Cause, ...]) -> None:
    """Print a row for each way in which climbs ended early, and the reason of the commonest."""
    table = plain_table("failed", "times", "of all, 95 %", "steps", "seeds", right=("times",))
    for cause in causes:
        table.add_row(cause.words, str(cause.n), share_range(cause.interval), some(cause.steps), some(cause.seeds))
    console.print(table)
    console.print(f"seed {causes[0].seeds[0]}: {causes[0].reason}")


def _print_effects(console: Console, effects: tuple[Effect, ...]) -> None:
    """Success by thirds of each key, and where it fails more, if that can be told."""
    if all(effect.verdict == "too few" for effect in effects):
        console.print(f"{VERDICTS['too few']} what of the noise matters")
        return
    thirds = ("low third", "middle", "high")
    table = plain_table("success [%] by", "drawn", *thirds, right=thirds)
    for effect in effects:
        table.add_row(effect.key, _reach(effect), *[*map(_third, effect.thirds), "", ""][:3])
    console.print(table)
    clear = [effect for effect in effects if effect.verdict != "none"]
    for effect in clear:
        console.print(f"{effect.key} {VERDICTS[effect.verdict]} (p = {effect.p:.2g})")
    if not clear:
        console.print("no key stands out (rank tests at 5 % over all of them)")


def _third(third: Third) -> str:
    low, high = third.interval
    return f"{100.0 * third.done / third.n:.0f} ({100.0 * low:.0f}-{100.0 * high:.0f})"


def _reach(effect: Effect) -> str:
    kind = NOISE[effect.key]
    low, high = effect.thirds[0].low / kind.scale, effect.thirds[-1].high / kind.scale
    return f"{low:.2g}..{high:.2g} {kind.unit}"


def _percent(done: int, n: int) -> str:
    if n == 0:
        return "nothing to tell"
    return f"{100.0 * done / n:.1f} % ({share_range(wilson_interval(done, n))}, 95 %)"


def share_range(interval: tuple[float, float]) -> str:
    """An interval of a share, such as "92.6 to 100.0 %"."""
    low, high = interval
    return f"{100.0 * low:.1f} to {100.0 * high:.1f} %"


def _times(spread: Spread) -> str:
    return f"{spread.median:.1f} s (5 to 95 %: {spread.low:.1f} to {spread.high:.1f} s)"


def some(numbers: Sequence[int]) -> str:
    """The first few numbers of many."""
    shown = ", ".join(map(str, numbers[:MOST_NAMED]))
    return f"{shown} ..." if len(numbers) > MOST_NAMED else shown


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
