"""How each planner did: shares, medians and gaps over any part of the contest, and whether anything contradicts a proof."""

import math
from collections.abc import Collection
from dataclasses import dataclass
from statistics import median

from .contest import Contest, Trial, Truth
from .rows import median_or_nothing

PROVED = ("infeasible",)


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
        told=sum(trial.status in PROVED and within(contest, trial) for trial in closed),
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
        elif trial.status in PROVED and truth.feasible:
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
