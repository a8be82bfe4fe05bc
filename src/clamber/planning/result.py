"""What a planner answers: a plan, or why there is none, and what the search cost."""

from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from ..actions.plan import Plan
from ..actions.plan_costs import spent
from ..actions.plan_families import plan_family
from ..actions.problem import CompiledProblem
from ..actions.verdict import Verdict, check_plan
from ..tasks import Task
from ..types import Ints, Json
from ..units import OZ_IN
from .genetic.evolve import Generation
from .genetic.learning import Macro

Status = Literal["optimal", "found", "infeasible", "bounded", "stopped"]


@dataclass(frozen=True, slots=True)
class Furthest:
    """How far a search without success came, and what stopped it there."""

    actions: int
    goals_met: int
    goals: int
    pose: Json
    """Body and holds."""
    stopped_by: dict[str, int]
    """Check -> how many of the inventory's modules it forbids at the furthest stance."""

    def to_json(self) -> Json:
        """Plain data."""
        return {
            "actions": self.actions,
            "goals_met": self.goals_met,
            "goals": self.goals,
            "pose": self.pose,
            "stopped_by": self.stopped_by,
        }


@dataclass(frozen=True, slots=True, kw_only=True)
class PlanResult:
    """A planner's answer. It proves itself: `check` replays the plan without the planner."""

    status: Status
    """optimal: proved to be the best plan by what was `minimized`; found: a plan; infeasible: proved that there is none;
    bounded: none has fewer than `lower_bound` actions, and the plan, if there is one (`has_plan`), is `gap` above that;
    stopped: none yet, and nothing proved."""
    plan: Plan
    """The plan; without success, the actions that lead furthest."""
    task: Task
    reason: str
    """In a sentence."""
    evaluations: int
    """Whole plans evaluated."""
    checks: int
    """Single actions judged."""
    seconds: float
    seed: int
    planner: str
    max_torque: float
    """Largest joint torque of the plan [N m]."""
    furthest: Furthest | None = None
    lower_bound: int | None = None
    """Proved: no plan has fewer actions."""
    minimized: tuple[str, ...] = ()
    """What a proof is about: costs in lexicographic order."""
    costs: dict[str, float] = field(default_factory=dict)
    """Of the plan: length (actions) and every cost of the robot's family, in SI units; empty unless minimized."""
    stances: int | None = None
    """Different stances that an exact search saw."""
    model: str = ""
    """The rules that a proof holds for."""
    first_length: int | None = None
    """Actions of the first plan found, before it was polished."""
    first_evaluations: int | None = None
    first_checks: int | None = None
    """Actions judged up to the first plan."""
    history: tuple[Generation, ...] = ()
    macros: tuple[Macro, ...] = field(default=())

    @property
    def length(self) -> int:
        """Actions of the plan."""
        return len(self.plan.actions)

    @property
    def has_plan(self) -> bool:
        """Whether the plan reaches the goal."""
        return self.status in ("optimal", "found") or (self.status == "bounded" and self.furthest is None)

    @property
    def gap(self) -> int | None:
        """Actions that the plan may have too many, at most; None without a plan, or without a bound below it."""
        return self.length - self.lower_bound if self.has_plan and self.lower_bound is not None else None

    def spent(self) -> dict[str, float]:
        """Every cost of the plan that its robot's family has, in SI units."""
        family = plan_family(self.task)
        problem = family.problem(self.task)
        return spent(problem, family.costs(self.task), problem.replay(self.plan.codes(self.task)).stances)

    def check(self) -> Verdict:
        """Replay the plan and recompute every margin."""
        return check_plan(self.task, self.plan)

    def to_json(self) -> Json:
        """Plain data: what `clamber plan --json` prints."""
        return {
            "status": self.status,
            "task": self.plan.task,
            "reason": self.reason,
            "actions": [action.to_json() for action in self.plan.actions],
            "codes": self.plan.numbers(),
            "length": self.length,
            "max_torque_Nm": self.max_torque,
            "max_torque_oz_in": self.max_torque / OZ_IN,
            "evaluations": self.evaluations,
            "checks": self.checks,
            "seconds": self.seconds,
            "seed": self.seed,
            "planner": self.planner,
            "lower_bound": self.lower_bound,
            "minimized": list(self.minimized),
            "costs": dict(self.costs),
            "gap": self.gap,
            "stances": self.stances,
            "model": self.model,
            "first_length": self.first_length,
            "first_evaluations": self.first_evaluations,
            "first_checks": self.first_checks,
            "furthest": None if self.furthest is None else self.furthest.to_json(),
            "macros": [
                {"name": macro.name, "length": len(macro.codes), "gain_m": macro.gain, "starts": macro.starts}
                for macro in self.macros
            ],
        }


def furthest_of(task: Task, problem: CompiledProblem, codes: Ints) -> Furthest:
    """Where a plan that misses the goal leads, and which checks stop the inventory's modules there."""
    family = plan_family(task)
    last = problem.replay(codes).stances[-1:]
    here = problem.rebind(problem.actions, last)
    stopped: dict[str, int] = {}
    for entry in range(len(problem.actions)):
        tried = here.replay(problem.actions.spell(np.array([entry], np.int32)))
        if not tried.ok:
            name = problem.checks[int(tried.reasons[-1])]
            stopped[name] = stopped.get(name, 0) + 1
    x, y, angle = family.pose(last[0])
    pose: Json = {"x_m": x, "y_m": y, "theta_rad": angle, "holds": family.holds(task, last[0])}
    ranked = dict(sorted(stopped.items(), key=lambda item: (-item[1], item[0])))
    return Furthest(len(codes), family.goals_met(last[0]), problem.goals, pose, ranked)
