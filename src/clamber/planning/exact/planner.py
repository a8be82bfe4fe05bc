"""The exact planner as a whole: the best plan, or the proof that there is none, within a stated model and memory."""

from collections.abc import Sequence

from ...shown_units import units_of
from ...tasks import Task
from ..problem.plan import Plan
from ..problem.problems import listed_problem, plan_family, spent
from ..progress import Clock, Exploring, Listener
from ..result import PlanResult, Status, furthest_of
from .costs import COSTS, check_costs, describe_order
from .explore import Exploration, inform
from .minimize import Minimizer

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
        seconds: Most wall-clock time [s].
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
