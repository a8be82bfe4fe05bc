"""What a planner answers: a plan, or why there is none, and what the search cost."""

from dataclasses import dataclass, field
from operator import attrgetter
from typing import Annotated, Literal

import numpy as np

from ..json_form import HIDDEN, Count, Jsonable, Key, in_json
from ..notebook import Pictured
from ..tasks import Task
from ..types import Ints
from ..units import OZ_IN
from .genetic.evolve import Generation
from .genetic.learning import Macro
from .problem.body_pose import named_pose, on_map
from .problem.plan import Plan
from .problem.problem import CompiledProblem
from .problem.problems import PlannedAction, plan_family, spent
from .problem.verdict import Verdict, check_plan

Status = Literal["optimal", "found", "infeasible", "bounded", "stopped"]


@dataclass(frozen=True, slots=True)
class PlacedBody:
    """Where the body is, and on what."""

    x_m: float
    y_m: float
    theta_rad: float
    holds: dict[str, int]
    """Limb to the number of its hold, 0 if it is free; empty for robots without holds."""
    pose: dict[str, float]
    """Each coordinate of the body's pose, in the unit at the end of its name."""


@dataclass(frozen=True, slots=True)
class LearnedModule:
    """A learned module that the search had."""

    name: str
    length: Count
    """Actions."""
    gain_m: float
    """Progress of the body in one go [m]."""
    starts: Count
    """Of the starts that it was tried from, in how many it worked."""


@dataclass(frozen=True, slots=True)
class Furthest(Jsonable):
    """How far a search without success came, and what stopped it there."""

    actions: Count
    goals_met: Count
    goals: Count
    pose: PlacedBody
    stopped_by: dict[str, int]
    """Check -> how many of the inventory's modules it forbids at the furthest stance."""


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class PlanResult(Jsonable, Pictured):
    """A planner's answer. It proves itself: `check` replays the plan without the planner."""

    status: Status
    """optimal: proved to be the best plan by what was `minimized`; found: a plan; infeasible: proved that there is none;
    bounded: none has fewer than `lower_bound` actions, and the plan, if there is one, is `gap` above that;
    stopped: none yet, and nothing proved."""
    task: Annotated[Task, Key(get=attrgetter("name"), kind=str)]
    reason: str
    """In a sentence."""
    plan: Annotated[
        Plan,
        Key("actions", get=attrgetter("actions"), kind=tuple[PlannedAction, ...]),
        Key(
            "codes",
            get=Plan.numbers,
            kind=list[int] | None,
            meaning="The same in the thesis's numbers; null where an action has none.",
        ),
    ]
    """The plan; without success, the actions that lead furthest."""
    max_torque: Annotated[float, Key("max_torque_Nm"), Key("max_torque_oz_in", per=OZ_IN)]
    """Largest joint torque of the plan; 0 for robots without joint torques."""
    evaluations: Count
    """Whole plans evaluated; 0 where none are counted."""
    checks: Count
    """Single actions judged; 0 where none are counted."""
    seconds: float
    """Wall-clock time."""
    seed: int
    planner: str
    lower_bound: int | None = None
    """Proved: no plan has fewer actions."""
    minimized: tuple[str, ...] = ()
    """What a proof is about: costs in lexicographic order."""
    costs: dict[str, float] = field(default_factory=dict)
    """Of the plan: length (actions) and every cost of the robot's family, in SI units; empty unless minimized."""
    stances: int | None = None
    """Different stances that an exact search saw."""
    model: str = ""
    """The rules that a proof holds for; empty without one."""
    first_length: int | None = None
    """Actions of the first plan found, before it was polished."""
    first_evaluations: int | None = None
    first_checks: int | None = None
    """Actions judged up to the first plan."""
    furthest: Furthest | None = None
    """None where there is a plan."""
    history: Annotated[tuple[Generation, ...], HIDDEN] = ()
    macros: Annotated[tuple[Macro, ...], HIDDEN] = field(default=())

    def told(self) -> str:
        """How it ended, of what, by whom."""
        return f"{self.status}: {self.length} actions for {self.task.name!r} by {self.planner}, {self.seconds:.1f} s"

    @property
    @in_json(after="codes")
    def length(self) -> Count:
        """Actions of the plan."""
        return len(self.plan.actions)

    @property
    def has_plan(self) -> bool:
        """Whether the plan reaches the goal."""
        return self.status in ("optimal", "found") or (self.status == "bounded" and self.furthest is None)

    @property
    @in_json(after="costs")
    def gap(self) -> int | None:
        """Actions that the plan may have too many, at most; None without a plan, or without a bound below it."""
        return self.length - self.lower_bound if self.has_plan and self.lower_bound is not None else None

    @in_json(key="macros")
    def learned_modules(self) -> tuple[LearnedModule, ...]:
        """The learned modules that the search had."""
        return tuple(LearnedModule(each.name, len(each.codes), each.gain, each.starts) for each in self.macros)

    def spent(self) -> dict[str, float]:
        """Every cost of the plan that its robot's family has, in SI units."""
        family = plan_family(self.task)
        problem = family.problem(self.task)
        return spent(problem, family.costs(self.task), problem.replay(self.plan.codes(self.task)).stances)

    def check(self) -> Verdict:
        """Replay the plan and recompute every margin."""
        return check_plan(self.task, self.plan)


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
    axes, at = family.pose_axes, family.pose(task, last[0])
    pose = PlacedBody(*on_map(axes, at), family.holds(task, last[0]), named_pose(axes, at))
    ranked = dict(sorted(stopped.items(), key=lambda item: (-item[1], item[0])))
    return Furthest(len(codes), family.goals_met(last[0]), problem.goals, pose, ranked)
