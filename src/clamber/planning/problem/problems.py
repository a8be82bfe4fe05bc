"""From a task to its problem: what a family of robots says of its tasks, and how its plans are named, costed and measured."""

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Annotated, Any, ClassVar, Final, Literal

import numpy as np
from pydantic import Field, StrictStr

from ...errors import PlannerError
from ...family import family_of
from ...json_form import Count, Jsonable, in_json
from ...shown_units import SI, ShownUnits, units_of
from ...specs import spec
from ...tasks import Task
from ...tasks.library import check_task
from ...types import Ints
from .body_pose import PLANE, PoseAxis, PoseLattice, axis_names, plane_lattice
from .check import TICKS, Check
from .code_limits import CodeLimits
from .problem import CompiledProblem, Records

Finite = Annotated[float, Field(strict=True, allow_inf_nan=False)]


@spec
class PlannedAction(Jsonable):
    """What the robot is told to do in one step, every choice made."""

    kind: Literal["none", "move", "release", "grab"]
    limb: StrictStr | None = None
    """Name of the limb or frame; None where the action has none."""
    hold: Annotated[int, Field(strict=True, ge=1)] | None = None
    """Number of the hold that a grab takes; None for a grab that found no hold."""
    delta: Annotated[tuple[Finite, ...], Field(min_length=1)] | None = None
    """A move's change of the body's pose: x, y [m], angle [rad] in a plane; along, across, height [m], yaw, pitch, roll [rad] in space."""
    code: Annotated[int, Field(strict=True, ge=0)] | None = None
    """The thesis's number (0, 1..6, N00, NXX) with the hold that was taken; None where it has no number for this."""
    gene: StrictStr | None = None
    """What the action was before its hold was chosen, such as "192" or "nearest 2"."""

    @property
    def title(self) -> str:
        """The action in a few words, for tables and messages."""
        if self.kind == "none":
            return "none"
        if self.kind == "move" and self.delta is not None:
            axes = zip(axis_names(len(self.delta)), self.delta, strict=True)
            way = " ".join(f"{'+' if part > 0 else '-'}{axis}" for axis, part in axes if part)
            return f"{self.limb} {way}" if self.limb else way
        if self.kind == "grab":
            return f"{self.limb} grabs {self.gene or 'no hold' if self.hold is None else self.hold}"
        return f"{self.limb} releases"


class ActionError(Exception):
    """A planned action is none that the task's robot has; whoever knows the file turns it into a `SpecError`."""

    def __init__(self, key: str, allowed: str) -> None:
        super().__init__(key, allowed)
        self.key, self.allowed = key, allowed


SAME: Final = 1e-6
"""Moves that differ from a step by less than this part of it are that step."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PlanCost:
    """A cost, and the feature that counts it."""

    feature: str
    """"effort" adds up over actions; "peak" is the largest of any stance, the start included."""
    title: str
    size: float = 1.0
    """The cost per unit of the feature, in the cost's SI unit."""
    unit: str
    """What people read it in."""
    per_unit: float = 1.0
    """One of that in the cost's SI unit."""
    digits: int = 1
    """Behind the point."""

    def words(self, value: float) -> str:
        """The cost of a plan, told: title, number, unit."""
        return f"{self.title} {value / self.per_unit:.{self.digits}f}{f' {self.unit}' if self.unit else ''}"


def spent(problem: CompiledProblem, costs: Mapping[str, PlanCost], stances: Records) -> dict[str, float]:
    """Each cost of a plan, in its SI unit.

    Args:
        problem: The plan's problem.
        costs: Name of the cost -> the cost.
        stances: The plan's stances, the start first.
    """
    features = problem.measured(stances)
    out = {}
    for name, cost in costs.items():
        column = features[:, problem.features.index(cost.feature)]
        out[name] = cost.size * float(column.max() if cost.feature == "peak" else column[1:].sum())
    return out


@dataclass(frozen=True, slots=True)
class Dropped:
    """Modules a filter left out."""

    filter: str
    reason: str
    names: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Posed:
    """A task as a problem, and what its inventory's filters did."""

    problem: CompiledProblem
    full_size: int
    """Modules of the unfiltered inventory."""
    dropped: tuple[Dropped, ...] = ()

    def sized(self, length: int) -> "SizedInventory":
        """The inventory with the size of the search for plans of `length` actions."""
        names = tuple(self.problem.actions.names)
        return SizedInventory(len(names), self.full_size, names, self.dropped, length)


@dataclass(frozen=True, slots=True)
class SizedInventory(Jsonable):
    """The modules that a plan can be made of, and the search sizes D = N^m (thesis 2.2.1)."""

    modules: Count
    full_size: Count
    """Before the filters."""
    names: tuple[str, ...]
    dropped: tuple[Dropped, ...]
    length: Count
    """Actions of a plan, for the size of the search."""

    @property
    @in_json()
    def log10_before(self) -> float:
        """Logarithm of how many plans of that length there are before the filters."""
        return self.length * math.log10(self.full_size)

    @property
    @in_json()
    def log10_after(self) -> float:
        """The same after them."""
        return self.length * math.log10(self.modules)


class PlanFamily(ABC):
    """How plans of one family are named, replayed and reported; tasks and stances are the family's own."""

    checks: ClassVar[tuple[Check, ...]]
    """In the order of a replay's margins."""
    stance_costs: ClassVar[tuple[str, ...]] = ()
    """What can be told of being in a stance, each with its unit at the end."""

    @abstractmethod
    def posed(self, task: Any, threads: int | None, filters: bool) -> Posed:
        """The task as a problem with the hard checks alone, its inventory filtered if asked for."""

    @abstractmethod
    def limits(self, task: Any) -> CodeLimits:
        """The codes that are actions of a task, and the indices that its stances may have."""

    def without_hangs(self, task: Any) -> Any:
        """The same task with no hangs allowed; most families have none."""
        return task

    @abstractmethod
    def sizes(self, task: Any) -> Mapping[str, float]:
        """Check -> the size that its margin is a share of, in its own unit; counts have none, for they are never tight."""

    units: ShownUnits = SI
    """In which margins are shown."""

    @abstractmethod
    def problem(self, task: Any) -> CompiledProblem:
        """The task with every check evaluated, for replays."""

    def hard(self, task: Any) -> tuple[str, ...]:
        """Names of the checks that forbid an action."""
        names: tuple[str, ...] = task.rules.hard
        return names

    @abstractmethod
    def action(self, task: Any, code: int, after: np.void, gene: str | None) -> PlannedAction:
        """A packed code as a named action, its hold read from the stance that it led to."""

    @abstractmethod
    def code(self, task: Any, action: PlannedAction) -> int:
        """The packed code of a named action; raises `ActionError` where the task has no such action."""

    @abstractmethod
    def module(self, task: Any, code: int) -> str:
        """Name of a packed code as a module of the inventory."""

    pose_axes: ClassVar[tuple[PoseAxis, ...]] = PLANE
    """Coordinates of a body's pose, in the order of `pose`, of the kernel `body_pose` and of a move's `delta`."""

    @abstractmethod
    def pose(self, task: Any, stance: np.void) -> tuple[float, ...]:
        """The body's pose, a number [m] or [rad] for each of `pose_axes`."""

    def lattice(self, task: Any, problem: CompiledProblem) -> PoseLattice:
        """The lattice of the body's poses that moves lead to."""
        return plane_lattice(task, int(problem.params.record["turn_ticks"]) // TICKS)

    def move_delta(self, task: Any, argument: int) -> tuple[float, ...]:
        """What the body move of argument 0..5 (+x -x +y -y +theta -theta) changes, in a plane: [m, m, rad]."""
        delta = [0.0, 0.0, 0.0]
        delta[argument >> 1] = (1.0 - 2.0 * (argument & 1)) * (task.step.angle if argument >= 4 else task.step.length)
        return tuple(delta)

    def move_argument(self, task: Any, delta: tuple[float, ...] | None) -> int:
        """Which argument 0..5 stands for a body's move in a plane; raises `ActionError` where none does."""
        length, angle = task.step.length, task.step.angle
        if delta is not None and len(delta) == 3:
            for argument in range(6):
                off = np.abs(np.subtract(delta, self.move_delta(task, argument)))
                if np.all(off <= SAME * np.array((length, length, angle))):
                    return argument
        allowed = f"must be one step along one axis: {length:.6g} m in x or y, or {angle:.6g} rad, either way"
        raise ActionError("delta", allowed)

    def holds(self, task: Any, stance: np.void) -> dict[str, int]:
        """Limb name -> number of its hold, 0 if it is free; empty where nothing is held."""
        return {}

    def taken(self, task: Any, stance: np.void) -> int | None:
        """Number of the hold that the last action took, None if it took none."""
        return None

    def model(self, task: Any) -> str:
        """The rules that a proof about a task holds for."""
        return f"hard checks {', '.join(self.hard(task))}"

    def costs(self, task: Any) -> Mapping[str, PlanCost]:
        """What a plan may be asked to have little of, beside its actions: name -> cost; one adds up, one is a largest value."""
        return {}

    def power(self, stance: np.void) -> float | None:
        """Electrical power that holding the stance takes [W]; None where the model has no motors' losses."""
        return None

    def duration(self, task: Any) -> float:
        """Time that one action takes [s], for its energy; 0 in models without forces."""
        return 0.0

    def torque(self, stance: np.void) -> float:
        """Largest joint torque [N m]; 0 in models without forces."""
        return 0.0

    def nearest(self, task: Any, problem: CompiledProblem, stances: Records, asked: Ints) -> list[int | None]:
        """What each "nearest" among the codes `asked` takes from the stance before it: hold numbers, shape (n,)."""
        return [None] * len(asked)

    def goals_met(self, stance: np.void) -> int:
        """Goals met, in order."""
        return int(stance["stage"])


def plan_family(task: Task) -> PlanFamily:
    """How plans of a task's family are named, replayed and reported."""
    return family_of(task).plans


def code_limits(task: Task) -> CodeLimits:
    """The codes that are actions of a task, and the indices that its stances may have."""
    return family_of(task).plans.limits(task)


def without_hangs(task: Task) -> Task:
    """The same task with no hangs allowed."""
    bare: Task = family_of(task).plans.without_hangs(task)
    return bare


def last_goal_only(task: Task) -> Task:
    """The same task without its sub-goals."""
    bare: Any = task  # each family's task has goals of its own type
    last: Task = replace(bare, goals=bare.goals[-1:])
    return last


def first_goal_only(task: Task) -> Task:
    """The same task up to its first goal."""
    near: Any = task  # each family's task has goals of its own type
    first: Task = replace(near, goals=near.goals[:1])
    return first


def pose_problem(task: Task, *, threads: int | None = None, filters: bool = True) -> Posed:
    """A task as a problem with the hard checks alone, for planners.

    Args:
        task: The task.
        threads: Threads for batches; None for one a core.
        filters: Whether the inventory's filters are applied.

    Raises:
        OptionError: If it is no task.
    """
    return family_of(check_task(task)).plans.posed(task, threads, filters)


def goal_step(problem: CompiledProblem, codes: Ints, stances: Records) -> int:
    """Actions of a plan up to the first of its stances that meets the goal; all of them where none does."""
    return next((i for i in range(len(stances)) if problem.is_done(stances[i : i + 1])), len(codes))


def listed_problem(task: Task, planner: str, *, threads: int | None = None) -> CompiledProblem:
    """A task as a problem whose actions can be listed one by one, as every planner but the genetic one needs it.

    Raises:
        PlannerError: If the task allows actions that can't be listed.
    """
    problem = pose_problem(task, threads=threads).problem
    if problem.incomplete is not None:
        raise PlannerError(planner, task.name, problem.incomplete)
    return problem


NOTHING_LIMITS: Final = 1e8
"""Larger margins mean that nothing limits."""


@dataclass(frozen=True, slots=True)
class Normalisation:
    """What a task's margins are measured against."""

    checks: tuple[Check, ...]
    """In the order of a replay's margins."""
    hard: tuple[str, ...]
    """Names of the checks that forbid an action."""
    sizes: Mapping[str, float]
    """Check -> the size that its margin is a share of, in its own unit; counts have none, for they are never tight."""
    units: ShownUnits = SI
    """In which margins are shown."""


def normalisation_of(task: Task) -> Normalisation:
    """The yardsticks of a task."""
    plans = family_of(task).plans
    return Normalisation(plans.checks, plans.hard(task), plans.sizes(task), units_of(task.document))
