"""What a planner answers: a plan, or why there is none, and what the search cost."""

from dataclasses import dataclass, field
from typing import Literal

from clamber.actions.plan import Plan
from clamber.actions.verdict import Verdict, check_plan
from clamber.planning.genetic.evolve import Generation
from clamber.planning.genetic.learning import Macro
from clamber.tasks import Task
from clamber.types import Json
from clamber.units import OZ_IN

Status = Literal["found", "infeasible", "bounded", "stopped"]


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
    """found: a plan; infeasible: proved that there is none; bounded: a plan that may not be the best; stopped: none yet."""
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
    first_length: int | None = None
    """Actions of the first plan found, before it was polished."""
    first_evaluations: int | None = None
    history: tuple[Generation, ...] = ()
    macros: tuple[Macro, ...] = field(default=())

    @property
    def length(self) -> int:
        """Actions of the plan."""
        return len(self.plan.actions)

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
            "first_length": self.first_length,
            "first_evaluations": self.first_evaluations,
            "furthest": None if self.furthest is None else self.furthest.to_json(),
            "macros": [
                {"name": macro.name, "length": len(macro.codes), "gain_m": macro.gain, "starts": macro.starts}
                for macro in self.macros
            ],
        }
