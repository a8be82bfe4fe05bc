"""The contest as tables of words: headings and rows, for the terminal, for Markdown, and trial by trial as CSV."""

import csv
import io
import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass, fields
from pathlib import Path

from ..files import write_atomically
from .contest import Contest, Trial, Truth
from .rows import Row
from .standing import Standing, contradictions, groups, ranking, standing


@dataclass(frozen=True, slots=True, kw_only=True)
class Table:
    """Headings and rows; all columns but the first hold numbers."""

    title: str
    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]

    def markdown(self) -> str:
        """As Markdown."""
        rule = "|---|" + "---:|" * (len(self.columns) - 1)
        lines = [f"| {' | '.join(row)} |" for row in (self.columns, *self.rows)]
        return "\n".join([f"**{self.title}**", "", lines[0], rule, *lines[1:]])


def tables(contest: Contest) -> list[Table]:
    """All planners on all boards, then by the number of holds and by their density."""
    truths = contest.truths()
    order = ranking(contest, truths)
    return [_overall(contest, truths, order)] + [
        _by(contest, truths, order, by, title)
        for by, title in (
            ("size", "By number of holds: boards solved, median gap"),
            ("density", "By holds per square metre: boards solved, median gap"),
        )
    ]


def _overall(contest: Contest, truths: dict[str, Truth], order: Sequence[Standing]) -> Table:
    feasible = sum(truth.feasible is True for truth in truths.values())
    hopeless = sum(truth.feasible is False for truth in truths.values())
    unknown = len(truths) - feasible - hopeless
    boards = f"{len(truths)} boards: {feasible} have a plan, {hopeless} have none" + (
        f", {unknown} are open" if unknown else ""
    )
    rows = [
        (
            one.contender,
            f"{_share(one.solved, one.trials)}",
            _thousands(one.cost),
            _percent(one.gap),
            _percent(one.worst_gap),
            _share(one.told, one.hopeless),
            f"{one.seconds:.2f}",
        )
        for one in order
    ]
    columns = ("planner", "solved", "checks to 1st plan", "gap", "worst gap", "none: told", "s")
    return Table(title=boards, columns=columns, rows=tuple(rows))


def _by(contest: Contest, truths: dict[str, Truth], order: Sequence[Standing], by: str, title: str) -> Table:
    parts = groups(contest, by)
    counts = {name: sum(truths[case].feasible is True for case in cases) for name, cases in parts.items()}
    shown = {name: cases for name, cases in parts.items() if counts[name]}
    rows = []
    for one in order:
        cells = [standing(contest, one.contender, truths, cases) for cases in shown.values()]
        rows.append((one.contender, *(f"{_share(cell.solved, cell.trials)} {_percent(cell.gap)}" for cell in cells)))
    return Table(title=title, columns=("planner", *(f"{name} ({counts[name]})" for name in shown)), rows=tuple(rows))


def _share(some: int, all_: int) -> str:
    return f"{100.0 * some / all_:.0f} %" if all_ else "-"


def _percent(value: float) -> str:
    return f"+{100.0 * value:.0f} %" if math.isfinite(value) else "-"


def _thousands(value: float) -> str:
    return f"{value:,.0f}".replace(",", " ") if math.isfinite(value) else "-"


def rows_of(contest: Contest) -> list[Row]:
    """The contest as a benchmark's rows."""
    truths = contest.truths()
    limit = f"within {contest.allowance.checks} checks"
    rows = []
    for one in ranking(contest, truths):
        name = one.contender
        rows += [
            Row(f"{name}: of {one.trials} trials on boards with a plan, solved {limit}", one.solved, "trials"),
            Row(f"{name}: actions judged up to the first plan, median", one.cost, "checks"),
            Row(f"{name}: length above the optimum, median", 100.0 * one.gap, "%"),
            Row(f"{name}: length above the optimum, largest", 100.0 * one.worst_gap, "%"),
            Row(f"{name}: of {one.hopeless} trials on boards without one, proved so {limit}", one.told, "trials"),
            Row(f"{name}: time of a trial, median", one.seconds, "s"),
        ]
    proved = [
        trial for trial in contest.trials if trial.status in ("optimal", "infeasible") and trial.contender == "exact"
    ]
    rows.append(Row(f"exact, without that limit: of {len(contest.cases)} boards, proved", len(proved), "boards"))
    rows.append(
        Row("answers that contradict a proof, or failures", len(contradictions(contest, truths)), "trials", "0")
    )
    return rows


def save_markdown(contest: Contest, path: Path) -> None:
    """Write the tables as Markdown, whole or not at all."""
    write_atomically(path, "\n\n".join(table.markdown() for table in tables(contest)) + "\n")


def save_trials(contest: Contest, path: Path) -> None:
    """Write every trial as a line of CSV, whole or not at all."""
    text = io.StringIO()
    table = csv.writer(text, lineterminator="\n")
    names = [field.name for field in fields(Trial)]
    table.writerow(names)
    for trial in contest.trials:
        told = asdict(trial)
        table.writerow(["" if told[name] is None else told[name] for name in names])
    write_atomically(path, text.getvalue())
