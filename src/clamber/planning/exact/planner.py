"""The exact planner as a whole: the best plan, or the proof that there is none, within a stated model and memory."""

from collections.abc import Callable, Sequence
from dataclasses import replace

from ...shown_units import units_of
from ...tasks import Task
from ..problem.plan import Plan
from ..problem.problem import CompiledProblem
from ..problem.problems import listed_problem, plan_family, spent
from ..progress import Clock, Exploring, Listener
from ..result import PlanResult, Status, furthest_of
from .costs import COSTS, Aim, check_costs, describe_order
from .explore import Exploration, explore, inform

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


MOST_STANCES = 8_000_000
"""Stances kept unless told otherwise: about 2 GB for the climber, at 250 bytes each; half as much again while it grows."""


def plan_exact(
    task: Task,
    *,
    seed: int = 0,
    seconds: float | None = None,
    threads: int | None = None,
    max_stances: int = MOST_STANCES,
    minimize: Sequence[str] = ("length",),
    progress: Listener | None = None,
) -> PlanResult:
    """Find the best plan, or prove that there is none.

    Args:
        task: What to plan.
        seed: Only written down: nothing here is drawn at random.
        seconds: Most time [s].
        threads: The search itself runs on one; replays take as many as given.
        max_stances: Memory: most stances kept. Running out is a result ("bounded").
        minimize: Costs in lexicographic order: "length" and the costs of the robot's family.
        progress: Called now and then.

    Returns:
        "optimal", "infeasible" (every reachable stance was seen), or "bounded" with the proved lower bound and the best plan known.

    Raises:
        PlannerError: If the task allows actions that exact search can't list one by one.
        CostError: If the robot's family has no such cost.
    """
    clock = Clock(seconds)
    check_costs("minimize", minimize, task)
    plain = listed_problem(task, "exact", threads=threads)

    def tell(stances: int, bound: float, cost: str) -> None:
        if progress is not None:
            progress(Exploring(stances, bound, cost, units_of(task.document).torque))

    informed, granted = inform(plain, clock.left)
    searches = Minimizer(informed, most_stances=max_stances, seconds=granted, tell=tell)
    seen = searches.least(minimize)
    proved = seen
    if seen.exhausted:
        # The bound may have ruled the goal out at once. The proof stands, but what can be reached, and what stops it, is still to be seen.
        searches = Minimizer(plain, most_stances=max_stances, seconds=clock.left, tell=tell)
        seen = searches.least(("length",))
    family = plan_family(task)
    status: Status = "optimal" if proved.found else "infeasible" if proved.exhausted else "bounded"
    stances = plain.replay(seen.codes).stances
    return PlanResult(
        status=status,
        plan=Plan.of_codes(task, seen.codes, seed=seed, planner="exact"),
        task=task,
        reason=_reason(proved, seen, minimize, status),
        evaluations=0,
        checks=searches.checks,
        seconds=clock.spent,
        seed=seed,
        planner="exact",
        max_torque=max((family.torque(stance) for stance in stances[1:]), default=0.0),
        furthest=None if seen.ways else furthest_of(task, plain, seen.codes),
        lower_bound=int(proved.lower_bound) if minimize[0] == "length" and not proved.exhausted else None,
        minimized=tuple(minimize),
        costs={"length": len(seen.codes)} | spent(plain, family.costs(task), stances) if seen.ways else {},
        stances=searches.stances,
        model=family.model(task),
    )


def _reason(proved: Exploration, seen: Exploration, minimize: Sequence[str], status: Status) -> str:
    unit = "actions" if minimize[0] == "length" else f"{minimize[0]} ({COSTS[minimize[0]]})"
    if status == "optimal":
        what = (
            f"no plan has fewer than {len(seen.codes)} actions" if minimize == ("length",) else describe_order(minimize)
        )
        return f"{what} ({seen.stances} stances seen)"
    if status == "infeasible":
        closed = ", ".join(f"{name} {n}" for name, n in sorted(seen.forbidden.items(), key=lambda item: -item[1]))
        if seen.exhausted:
            return (
                f"all {seen.stances} reachable stances were seen and none meets the goal; actions forbidden: {closed}"
            )
        return (
            f"no stance meets the goal even without forces, from reach and joint limits alone; {seen.stances} of the "
            f"reachable stances were seen; actions forbidden: {closed}"
        )
    why = "interrupted" if seen.interrupted else "out of time or memory"
    bound = f"{seen.lower_bound:.4g} {unit}"
    if seen.ways:
        return f"{why} after {seen.stances} stances: the plan is not proved best; no plan has less than {bound}"
    return f"{why} after {seen.stances} stances: a plan has at least {bound}, if there is one"
