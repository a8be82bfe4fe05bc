"""How each planner did, as tables of words: shares, medians and gaps, for the terminal, for Markdown, and trial by trial as CSV."""

import math
from collections.abc import Collection, Sequence
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from statistics import median

from ..files import csv_text, write_atomically
from ..trials.measured import Row, median_or_nothing
from .contest import Contest, Trial, Truth


@dataclass(frozen=True, slots=True, kw_only=True)
class Standing:
    """One planner on some of the boards."""

    contender: str
    trials: int
    """On boards that have a plan."""
    solved: int
    """Of these, with a plan within the allowance."""
    gaps: tuple[float, ...]
    """Length over the optimum, less one, of every plan that was found [-]."""
    cost: float
    """Actions judged up to the first plan, median over `trials`; NaN where half of them found none."""
    seconds: float
    """Of a whole trial, median, over boards with and without a plan [s]."""
    hopeless: int
    """Trials on boards that have none."""
    told: int
    """Of these, with the proof that there is none, within the allowance."""

    @property
    def gap(self) -> float:
        """The median gap; NaN without plans."""
        return median(self.gaps) if self.gaps else math.nan

    @property
    def worst_gap(self) -> float:
        """The largest gap; NaN without plans."""
        return max(self.gaps, default=math.nan)


def within(contest: Contest, trial: Trial) -> bool:
    """Whether a trial came to its answer within the allowance."""
    counts = next(contender for contender in contest.contenders if contender.name == trial.contender).counts
    return trial.cost <= contest.allowance.checks if counts else trial.seconds <= contest.allowance.patience


def standing(
    contest: Contest, contender: str, truths: dict[str, Truth], cases: Collection[str] | None = None
) -> Standing:
    """One planner's standing on some boards (None: all)."""
    mine = [trial for trial in contest.of(contender) if cases is None or trial.case in cases]
    open_ones = [trial for trial in mine if truths[trial.case].feasible]
    closed = [trial for trial in mine if truths[trial.case].feasible is False]
    solved = [trial for trial in open_ones if trial.length is not None and within(contest, trial)]
    gaps = [_gap(trial, truths[trial.case]) for trial in solved]
    paid = [float(trial.cost) if trial in solved else None for trial in open_ones]
    return Standing(
        contender=contender,
        trials=len(open_ones),
        solved=len(solved),
        gaps=tuple(gap for gap in gaps if gap is not None),
        cost=median_or_nothing(paid),
        seconds=median([trial.seconds for trial in mine]) if mine else math.nan,
        hopeless=len(closed),
        told=sum(trial.status == "infeasible" and within(contest, trial) for trial in closed),
    )


def _gap(trial: Trial, truth: Truth) -> float | None:
    if trial.length is None or not truth.shortest:
        return None
    return trial.length / truth.shortest - 1.0


def contradictions(contest: Contest, truths: dict[str, Truth]) -> list[str]:
    """Plans shorter than a proved bound, plans or proofs where the opposite is proved, and planners that failed: there must be none."""
    wrong = []
    for trial in contest.trials:
        truth = truths[trial.case]
        where = f"{trial.contender} on {trial.case}, seed {trial.seed}"
        if trial.status == "failed":
            wrong.append(f"{where}: {trial.reason}")
        elif trial.length is not None and truth.feasible is False:
            wrong.append(f"{where}: a plan of {trial.length} actions, where none was proved to exist")
        elif trial.length is not None and truth.shortest is not None and trial.length < truth.shortest:
            wrong.append(f"{where}: {trial.length} actions, fewer than the proved {truth.shortest}")
        elif trial.status == "infeasible" and truth.feasible:
            wrong.append(f"{where}: proved that there is no plan, where there is one")
    return wrong


def groups(contest: Contest, by: str) -> dict[str, list[str]]:
    """The boards by `size` or `density`, in the set's order."""
    found: dict[str, list[str]] = {}
    for case in contest.cases:
        found.setdefault(getattr(case, by), []).append(case.name)
    return dict(sorted(found.items(), key=lambda item: -1.0 if item[0] == "thesis" else float(item[0])))


def ranking(contest: Contest, truths: dict[str, Truth]) -> list[Standing]:
    """All planners: most boards solved first, then the smaller gap, then the cheaper."""
    told = [standing(contest, contender.name, truths) for contender in contest.contenders]
    return sorted(told, key=_order)


def _order(one: Standing) -> tuple[float, float, float]:
    share = one.solved / one.trials if one.trials else 0.0
    return (-share, _last(one.gap), _last(one.cost))


def _last(value: float) -> float:
    return value if math.isfinite(value) else math.inf


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
    """The contest as rows."""
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
    names = [field.name for field in fields(Trial)]
    write_atomically(path, csv_text([names, *(asdict(trial).values() for trial in contest.trials)]))
