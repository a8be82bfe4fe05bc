"""What a robot can ever reach: poses of its body, holds, goals, and what each place costs."""

from collections.abc import Callable
from dataclasses import dataclass
from operator import attrgetter
from pathlib import Path
from typing import Annotated, Any, Final, Literal

from ...errors import ClamberError, UnknownNameError, describe_choices
from ...family import family_of
from ...files import write_atomically
from ...json_form import HIDDEN, Count, Jsonable, Key, in_json
from ...notebook import Pictured
from ...tasks import Task
from ..problem.body_pose import PoseLattice
from ..problem.problems import listed_problem, normalisation_of, plan_family, without_hangs
from ..progress import Clock
from .exploration import Exploration, explore_breadth_first
from .table import Rim, Table, place_table, pose_table, rim_of


class LayerError(ClamberError):
    """A layer is asked for that the robot's model has nothing to say about."""

    def __init__(self, layer: str, family: str, allowed: tuple[str, ...]) -> None:
        super().__init__(layer, family, allowed)
        self.layer, self.family, self.allowed = layer, family, allowed

    def __str__(self) -> str:
        return (
            f"layer '{self.layer}': the model of the family '{self.family}' has no joint torques; "
            f"allowed are {describe_choices(self.layer, self.allowed)}"
        )


@dataclass(frozen=True, slots=True)
class Layer:
    """One thing that a map can show of every place."""

    column: str
    """Of the map's table; "least_" or "most_" and a cost of the family's stances, or one that every map has."""
    title: str
    """What the number is, for a reader of the picture."""
    good: bool
    """Whether more is better."""


LAYERS: Final[dict[str, Layer]] = {
    "force": Layer("least_torque_Nm", "largest joint torque of the easiest stance", False),
    "payload": Layer("most_payload_N", "extra weight that the best stance still carries", True),
    "power": Layer("least_power_W", "power that the cheapest stance takes", False),
    "margin": Layer("margin", "smallest margin of the best stance, as a share of what is limited", True),
    "steps": Layer("first_step", "actions of the shortest way there", False),
}
"""Name -> layer."""
COMMON: Final = ("margin", "first_step")
"""Columns that the maps of every family have."""


def layers_of(task: Task) -> tuple[str, ...]:
    """Names of the layers that a task's map has; the first is shown unless another is asked for."""
    stance_costs = family_of(task).plans.stance_costs
    return tuple(
        name
        for name, layer in LAYERS.items()
        if layer.column in COMMON or layer.column.partition("_")[2] in stance_costs
    )


def choose_layer(task: Task, name: str | None) -> str:
    """The layer of that name, or the family's first.

    Raises:
        UnknownNameError: If there is no such layer.
        LayerError: If the family hasn't got it.
    """
    allowed = layers_of(task)
    if name is None:
        return allowed[0]
    if name not in LAYERS:
        raise UnknownNameError("layer", name, allowed)
    if name not in allowed:
        raise LayerError(name, task.document["robot"]["family"], allowed)
    return name


MOST_STANCES: Final = 8_000_000
"""Stances kept unless told otherwise: under 1 GB for the climber, half as much again while it grows."""
Status = Literal["complete", "incomplete"]
_ENDS: Final = {
    "": "every reachable stance was seen",
    "memory": "out of memory for stances",
    "time": "out of time",
    "interrupt": "interrupted",
}


@dataclass(frozen=True, slots=True, kw_only=True)
class HoldUse(Jsonable):
    """One hold, and who can ever use it."""

    number: int
    limbs: dict[str, int]
    """Limb -> actions of the shortest way to holding it; limbs that never hold it are left out."""
    stances: Count
    """Reachable stances with a limb on it."""

    @in_json(after="number")
    def first_step(self) -> int | None:
        """Actions of the shortest way to a limb holding it; None: nobody ever does."""
        return min(self.limbs.values(), default=None)


@dataclass(frozen=True, slots=True, kw_only=True)
class GoalReach(Jsonable):
    """One goal, and whether any reachable stance is where it asks for; goals before it and turns are not asked."""

    name: str
    stances: Count
    """Reachable stances where it asks for."""
    first_step: int | None
    """Actions of the shortest way there; None: nobody gets there."""


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Reach(Jsonable, Pictured):
    """The reachable space of a task, as far as it was seen."""

    status: Status
    """complete: every stance that can be reached was seen; incomplete: memory, time or Ctrl-C came first."""
    task: Annotated[Task, Key(get=attrgetter("name"), kind=str)]
    reason: str
    """In a sentence."""
    model: str
    """The rules that the answer holds for."""
    without_hangs: bool
    """Whether hangs were left out though the task allows them."""
    stances: Count
    """Different stances."""
    poses: Annotated[Table, Key(get=len, kind=Count)]
    steps: Count
    """Actions of the shortest way to the stance that is farthest in actions."""
    checks: Count
    """Actions judged."""
    seconds: float
    goals: tuple[GoalReach, ...]
    """Sub-goals in order, then the goal."""
    holds: tuple[HoldUse, ...]
    forbidden: dict[str, int]
    """Check -> actions it forbade."""
    closed_by: dict[str, int]
    """Check -> forbidden body moves to places that nobody reaches: what closes the edge of the map; empty while incomplete."""
    places: Table
    """Column to its values, a place of the body each: its two axes, such as `x_m`, `y_m`, then `stances`, `first_step` and so on;
    "inf" where nothing limits."""
    rim: Annotated[Rim, HIDDEN]
    """Places that could be tried and were not reached; while incomplete, not reached so far."""
    lattice: Annotated[PoseLattice, HIDDEN]
    """Of the body's poses; places are those of its first two axes."""

    def told(self) -> str:
        """What was seen of which task."""
        return f"{self.status} for {self.task.name!r}: {self.reason}"

    @property
    @in_json(after="holds")
    def never_used(self) -> tuple[int, ...]:
        """Numbers of the holds that no limb can ever hold; none is known before everything was seen."""
        return tuple(hold.number for hold in self.holds if self.status == "complete" and not hold.limbs)

    @property
    @in_json(after="seconds")
    def goal_reached(self) -> bool:
        """Whether some reachable stance is where the last goal asks for."""
        return self.goals[-1].stances > 0

    def save_table(self, path: Path) -> None:
        """Write the poses as CSV, whole or not at all.

        Raises:
            FileError: If the file can't be written.
        """
        write_atomically(path, self.poses.to_csv())


def find_reach(
    task: Task,
    *,
    hangs: bool = False,
    max_stances: int = MOST_STANCES,
    seconds: float | None = None,
    threads: int | None = None,
    progress: Callable[[int, int, int], None] | None = None,
) -> Reach:
    """See every stance that a robot can reach from its start, whatever its goals, and what it costs to be there.

    Args:
        task: The task; its goals stop nothing.
        hangs: Whether hangs count as the task's rules have them. They take the body off the lattice of steps, so that with any number
            of them the space has no end; without this they are left out.
        max_stances: Memory: most stances kept. Running out is a result ("incomplete").
        seconds: Most time [s].
        threads: The answer doesn't depend on them; None for one a core.
        progress: Called now and then with stances, poses tried and actions from the start.

    Returns:
        The reachable space.

    Raises:
        PlannerError: If the task allows actions that can't be listed one by one.
        StartError: If the start stance violates a hard check.
    """
    clock = Clock(seconds)
    posed = task if hangs else without_hangs(task)
    problem = listed_problem(posed, "reach", threads=1)
    holds: tuple[Any, ...] = getattr(task.world, "holds", ())
    lattice = plan_family(posed).lattice(posed, problem)
    seen = explore_breadth_first(
        problem,
        normalisation_of(posed),
        lattice,
        holds=len(holds),
        most_stances=max_stances,
        seconds=seconds,
        threads=threads,
        tell=progress,
    )
    poses = pose_table(seen, problem.stance_costs, problem.checks, lattice)
    places = place_table(poses, lattice)
    rim = rim_of(seen, places, problem.checks)
    why = f"{_ENDS[seen.ended]}: {seen.stances} stances, {len(poses)} poses, {len(places)} places"
    return Reach(
        task=task,
        status="incomplete" if seen.ended else "complete",
        reason=why,
        stances=seen.stances,
        steps=seen.depth,
        poses=poses,
        places=places,
        rim=rim,
        lattice=lattice,
        holds=_holds(task, holds, seen),
        goals=_goals(task, seen),
        checks=seen.judged,
        forbidden=_ranked(problem.checks, seen.forbidden.tolist()),
        closed_by={} if seen.ended else _ranked(problem.checks, rim.forbidden.sum(axis=0).tolist()),
        seconds=clock.spent,
        model=plan_family(posed).model(posed),
        without_hangs=posed != task,
    )


def _ranked(names: tuple[str, ...], counts: list[int]) -> dict[str, int]:
    """The checks that count, the most frequent first."""
    return dict(sorted(((name, n) for name, n in zip(names, counts, strict=True) if n), key=lambda item: -item[1]))


def _holds(task: Any, holds: tuple[Any, ...], seen: Exploration) -> tuple[HoldUse, ...]:
    return tuple(
        HoldUse(
            number=hold.number,
            limbs={
                name: int(seen.first_used[i, h])
                for i, name in enumerate(task.robot.limb_names)
                if seen.first_used[i, h] >= 0
            },
            stances=int(seen.used[:, h].sum()),
        )
        for h, hold in enumerate(holds)
    )


def _goals(task: Any, seen: Exploration) -> tuple[GoalReach, ...]:
    return tuple(
        GoalReach(name=goal.name, stances=int(n), first_step=int(first) if n else None)
        for goal, n, first in zip(task.goals, seen.met, seen.first_met, strict=True)
    )
