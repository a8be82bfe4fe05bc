"""A plan of a robot in space as what is carried out in one go: motions of the body over its holds, and limbs that take other holds."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Self, TypeAlias

import numpy as np

from ....planning.problem.plan import Plan
from ....planning.problem.problem import Replay
from ....planning.problem.problems import plan_family
from ....types import Floats, Ints
from ..planning.records import HEIGHT, PITCH, ROLL
from ..planning.swing_loads import SwingLoads
from ..planning.task import SpatialTask
from .centred_loads import LoadCentre
from .plant import Pose


@dataclass(frozen=True, slots=True, eq=False)
class Standing:
    """A stance of a plan."""

    pose: Pose
    """Of the body."""
    joints: Floats
    """[rad] or [m], shape (n,)."""
    holds: Ints
    """Index of each limb's hold, shape (limbs,)."""
    loads: Floats
    """Wrenches of the contacts on the robot, world frame: force [N], moment about the tip [N m], shape (limbs, 6)."""
    along: float
    """On the guide [m] ..."""
    across: float
    """... beside it [m] ..."""
    height: float
    """... over it [m] ..."""
    yaw: float
    """... and about its normal [rad]."""
    level: bool
    """Whether the body neither pitches nor rolls on its guide."""
    stage: int
    """Goals that are met."""


@dataclass(frozen=True, slots=True, eq=False)
class BodyMotion:
    """The body over its holds, through one stance or several."""

    first: int
    """Number of the plan's action that it begins with, from 1."""
    way: tuple[Standing, ...]
    """The stance where it begins, and all that it comes through."""

    @property
    def start(self) -> Standing:
        """Where it begins."""
        return self.way[0]

    @property
    def end(self) -> Standing:
        """Where it ends."""
        return self.way[-1]

    @property
    def last(self) -> int:
        """Number of the plan's action that it ends with."""
        return self.first + len(self.way) - 2


@dataclass(frozen=True, slots=True, eq=False)
class Regrab:
    """A limb from its hold to another."""

    first: int
    """Number of the plan's action, from 1."""
    limb: int
    hold: int
    """Index of the hold that it takes."""
    before: Standing
    after: Standing
    loads: Floats
    """Wrenches while it swings, as `Standing.loads`; its own are zero."""

    @property
    def start(self) -> Standing:
        """Where it begins."""
        return self.before

    @property
    def end(self) -> Standing:
        """Where it ends."""
        return self.after

    @property
    def last(self) -> int:
        """The same number."""
        return self.first


Motion: TypeAlias = BodyMotion | Regrab


@dataclass(frozen=True, slots=True, eq=False)
class Course:
    """What a plan asks for, in order."""

    start: Standing
    motions: tuple[Motion, ...]

    @classmethod
    def of(cls, task: SpatialTask, plan: Plan, label: str = "plan") -> Self:
        """Of a plan; moves of the body that follow each other become one motion where it goes straight on.

        Raises:
            ClamberError: If an action is none of the task's.
        """
        replay: Replay = plan_family(task).problem(task).replay(plan.codes(task, label), go_on=True)
        centre = LoadCentre(task.robot, task.world)
        standings = [_centred(_standing(task, stance), centre) for stance in replay.stances]
        loads = SwingLoads(task)
        motions: list[Motion] = []
        for k, (before, after) in enumerate(pairwise(standings)):
            moved = np.flatnonzero(before.holds != after.holds)
            if moved.size:
                limb = int(moved[0])
                shared, bearing = loads.wrenches(replay.stances[k], limb), before.holds.copy()
                bearing[limb] = -1
                swinging = np.isfinite(shared).all()
                shared = centre(before.pose, before.joints, bearing, shared) if swinging else before.loads
                motions.append(Regrab(k + 1, limb, int(after.holds[limb]), before, after, shared))
            elif motions and isinstance(last := motions[-1], BodyMotion) and _straight_on(last.way, after):
                motions[-1] = BodyMotion(last.first, (*last.way, after))
            else:
                motions.append(BodyMotion(k + 1, (before, after)))
        return cls(standings[0], tuple(motions))

    def changed(self, standing: Callable[[Standing], Standing], regrab: Callable[[Regrab], Regrab]) -> "Course":
        """The same motions with other stances, and what else of regrabs is another then."""

        def motion(one: Motion) -> Motion:
            if isinstance(one, Regrab):
                return regrab(replace(one, before=standing(one.before), after=standing(one.after)))
            return replace(one, way=tuple(map(standing, one.way)))

        return Course(standing(self.start), tuple(map(motion, self.motions)))


def grabs(task: SpatialTask, plan: Plan) -> list[tuple[int, int]]:
    """Index of a limb and of its hold: those of the start, then those that the plan takes, in its order."""
    chosen = plan_family(task).problem(task).start[0]["hold"]
    names = task.robot.chains.limb_names
    held = [(limb, int(chosen[limb])) for limb in range(len(names)) if chosen[limb] >= 0]
    return held + [(names.index(str(one.limb)), one.hold - 1) for one in plan.actions if one.hold]


def _centred(standing: Standing, centre: LoadCentre) -> Standing:
    """A stance with the loads farthest from all limits."""
    loads = centre(standing.pose, standing.joints, standing.holds, standing.loads)
    return replace(standing, loads=loads)


def _standing(task: SpatialTask, stance: np.void) -> Standing:
    used = task.robot.chains.used
    limbs, most = used.shape
    turn = np.array(stance["turn"], np.float64).reshape(3, 3)
    return Standing(
        Pose(turn, np.array(stance["place"], np.float64)),
        np.asarray(stance["q"])[:limbs, :most][used],
        np.array(stance["hold"][:limbs], np.int32),
        np.array(stance["wrench"][:limbs], np.float64),
        along=float(stance["x"]),
        across=float(stance["y"]),
        height=task.start.height + task.step.height * int(stance["pose"][HEIGHT]),
        yaw=float(stance["angle"]),
        level=not stance["pose"][[PITCH, ROLL]].any(),
        stage=int(stance["stage"]),
    )


def _straight_on(way: Sequence[Standing], after: Standing) -> bool:
    """Whether the body goes on in the direction that it has gone, without a turn."""
    first, last = way[0].pose, way[-1].pose
    gone, more = last.position - first.position, after.pose.position - last.position
    if np.abs(after.pose.rotation - first.rotation).max() > 1e-9:
        return False
    size = float(np.linalg.norm(gone) * np.linalg.norm(more))
    return size > 0.0 and float(gone @ more) > (1.0 - 1e-9) * size
