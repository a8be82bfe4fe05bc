"""What all rivals share: a budget in single actions judged and in seconds, and the answer made of what they found."""

import time
from dataclasses import dataclass, field
from typing import Final

import numpy as np

from ...errors import PlannerError
from ...tasks import Task
from ...types import Ints
from ..problem.plan import Plan
from ..problem.plan_families import plan_family
from ..problem.problem import CompiledProblem
from ..problem.problems import pose_problem
from ..progress import Listener, Trying
from ..result import PlanResult, Status, furthest_of

MAX_CHECKS: Final = 2_000_000
"""Actions judged unless told otherwise: a second or two."""
LONGEST: Final = 400
"""Most actions of a plan, as in the genetic planner's profiles."""


@dataclass(slots=True)
class Hunt:
    """A rival at work: what it has spent and the best that it has."""

    planner: str
    task: Task
    seed: int
    max_checks: int
    seconds: float | None
    listener: Listener | None
    problem: CompiledProblem = field(init=False)
    started: float = field(init=False)
    checks: int = 0
    codes: Ints = field(default_factory=lambda: np.zeros(0, np.int32))
    """The shortest plan; without one, the way to the stance that is worth most."""
    value: float = -np.inf
    """What that stance is worth."""
    found: bool = False
    first_length: int | None = None
    first_checks: int | None = None
    interrupted: bool = False

    def __post_init__(self) -> None:
        self.started = time.monotonic()
        self.problem = pose_problem(self.task, threads=1).problem
        if self.problem.incomplete is not None:
            raise PlannerError(self.planner, self.task.name, self.problem.incomplete)
        if self.problem.is_done(self.problem.start):
            self.take(self.codes, 0.0, found=True)

    @property
    def is_over(self) -> bool:
        """Whether the budget is spent, or no shorter plan can be."""
        late = self.seconds is not None and time.monotonic() - self.started >= self.seconds
        return late or self.checks >= self.max_checks or self.longest <= 0

    @property
    def longest(self) -> int:
        """Most actions of a plan that would be news."""
        return len(self.codes) - 1 if self.found else LONGEST

    def take(self, codes: Ints, value: float, *, found: bool) -> None:
        """Keep a plan if it is better than what there is: it reaches the goal, with fewer actions, or leads further."""
        if found and self.first_length is None:
            self.first_length, self.first_checks = len(codes), self.checks
        better = (
            len(codes) < len(self.codes) if found and self.found else found or (not self.found and value > self.value)
        )
        if better:
            self.codes, self.value, self.found = codes.copy(), value, found

    def tell(self) -> None:
        """Report where the search is."""
        if self.listener is not None:
            self.listener(Trying(self.checks, self.value, len(self.codes) if self.found else None))

    def result(self, *, exhausted: int | None = None, spent: str = "the budget ran out") -> PlanResult:
        """The answer.

        Args:
            exhausted: Stances of the whole reachable space, if the search saw it all and there is no plan.
            spent: Why it stopped without a plan.
        """
        family = plan_family(self.task)
        status: Status = "found" if self.found else "stopped" if exhausted is None else "infeasible"
        if self.found:
            reason = f"reached every goal after {self.first_checks} actions judged"
        elif exhausted is not None:
            reason = f"all {exhausted} reachable stances were seen and none meets the goal"
        else:
            how = "interrupted" if self.interrupted else spent
            reason = f"{how} after {self.checks} actions judged without reaching the goal; this search proves nothing"
        replayed = self.problem.replay(self.codes)
        assert replayed.ok, "a rival's plan does not hold"
        return PlanResult(
            status=status,
            plan=Plan.of_codes(self.task, self.codes, seed=self.seed, planner=self.planner),
            task=self.task,
            reason=reason,
            evaluations=0,
            checks=self.checks,
            seconds=time.monotonic() - self.started,
            seed=self.seed,
            planner=self.planner,
            max_torque=float(np.max([family.torque(stance) for stance in replayed.stances[1:]], initial=0.0)),
            furthest=None if self.found else furthest_of(self.task, self.problem, self.codes),
            stances=exhausted,
            model="" if exhausted is None else family.model(self.task),
            first_length=self.first_length,
            first_checks=self.first_checks,
        )
