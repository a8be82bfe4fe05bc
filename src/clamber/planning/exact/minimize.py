"""Exact searches in a row: the best plan in a lexicographic order of up to three costs."""

from collections.abc import Callable, Sequence
from dataclasses import replace

from ..problem.problem import CompiledProblem
from ..progress import Clock
from .costs import COSTS, Aim
from .explore import Exploration, explore

Tell = Callable[[int, float, str], None]
UNDER = 1.0 - 1e-9
"""A limit that a plan just misses is this part of its largest value."""


class Minimizer:
    """Runs searches that share a problem, memory and time; adds up what they cost."""

    def __init__(
        self, problem: CompiledProblem, *, most_stances: int, seconds: float | None = None, tell: Tell | None = None
    ) -> None:
        self.problem = problem
        self.most_stances = most_stances
        self.tell = tell
        self.checks = 0
        self.stances = 0
        """Of the largest search."""
        self._clock = Clock(seconds)

    def run(self, aim: Aim) -> Exploration:
        """One search."""

        def tell(stances: int, bound: float) -> None:
            if self.tell is not None:
                self.tell(stances, bound, aim.first)

        seen = explore(self.problem, most_stances=self.most_stances, seconds=self._clock.left, tell=tell, aim=aim)
        self.checks += seen.checks
        self.stances = max(self.stances, seen.stances)
        return seen

    def least(self, order: Sequence[str], *, most_peak: float | None = None) -> Exploration:
        """The best plan by an order of costs.

        A largest value doesn't add up, so what is best after it can't be found by going on from what is best so far: where it comes
        first, its least value becomes a limit for the costs behind it. Where it comes third, its limit falls until the first two grow.

        Args:
            order: One to three different costs of `COSTS`.
            most_peak: No action may have more, in the unit of the feature "peak".

        Returns:
            The search that settled it; one that ended early leaves the best plan known and the bound on the first cost.
        """
        first, *rest = order
        if COSTS[first] == "peak":
            easiest = self.run(Aim(first=first, most_peak=most_peak))
            if not easiest.found or not rest:
                return easiest
            limit = easiest.ways[0].first * (1.0 + 1e-12)
            settled = self.least(rest, most_peak=limit)
            best = settled if settled.ways else easiest  # out of time: only the largest value is proved
            return replace(best, lower_bound=easiest.lower_bound, found=settled.found)
        if not rest:
            return self.run(Aim(first=first, most_peak=most_peak))
        both = self.run(Aim(first=first, second=rest[0], most_peak=most_peak))
        if not both.found or len(rest) == 1:
            return both
        if COSTS[rest[0]] == "peak":
            limit = both.ways[0].second * (1.0 + 1e-12)
            settled = self.run(Aim(first=first, second=rest[1], most_peak=limit))
            return settled if settled.found else replace(both, found=False)
        return self._easiest_of_equals(both, first, rest[0], most_peak)

    def _easiest_of_equals(self, both: Exploration, first: str, second: str, most_peak: float | None) -> Exploration:
        """Of the plans that two added-up costs don't tell apart, the one of least peak."""
        best = both
        while True:
            peak = self.peak(best)
            lower = peak * UNDER if most_peak is None else min(most_peak, peak * UNDER)
            tried = self.run(
                Aim(first=first, second=second, most_peak=lower, at_most=both.ways[0].first * (1.0 + 1e-9))
            )
            if not tried.found and not tried.exhausted:
                return replace(best, found=False)
            if not tried.found or tried.ways[0].second > both.ways[0].second * (1.0 + 1e-9):
                return best
            best = tried

    def peak(self, seen: Exploration) -> float:
        """The largest value of the best plan, the start stance included, in the unit of the feature "peak"."""
        stances = self.problem.replay(seen.codes).stances
        return float(self.problem.measured(stances)[:, self.problem.features.index("peak")].max())
