"""Planned walks: a walker's task under rules that can bear to be carried out, its plan, and the walk that carries it out."""

from typing import Final

import numpy as np

from ....errors import SpecError
from ....planning.problem.codes import Code
from ....planning.problem.plan import Plan
from ....planning.problem.problem import Replay
from ....planning.problem.problems import plan_family
from ....tasks.library import change_task
from ....types import Floats, Ints
from ..control.gait import Limits
from ..execution.footstep_plan import PlannedCourse, PlannedStep
from ..execution.walking import Lay
from ..planning import Walk
from ..planning.task import WalkerTask
from ..planning.walk import WalkStart
from ..statics.stance import DELTA


def planned_steps(codes: Ints, replay: Replay) -> tuple[PlannedStep, ...]:
    """The steps of a plan; a frame that is lifted and put down where it was makes none.

    Args:
        codes: The plan's actions, shape (n,).
        replay: The plan carried out in its task, of `n` actions.
    """
    steps: list[PlannedStep] = []
    corners: list[Floats] = []
    last: int | None = None
    for code, before, after in zip(codes.tolist(), replay.stances[:-1], replay.stances[1:], strict=True):
        swing = 1 - int(before["stands"])
        kind = Code.of(code).kind
        if kind == "move":
            if code == last:
                corners.pop()
            corners.append(np.array(after["pose"][swing]))
        elif kind == "release" and corners:
            steps.append(PlannedStep(swing, np.array(corners), np.array(before["pose"][1 - swing])))
            corners = []
        last = code
    if corners:
        end = replay.stances[-1]
        swing = 1 - int(end["stands"])
        steps.append(PlannedStep(swing, np.array(corners), np.array(end["pose"][1 - swing])))
    return tuple(steps)


def plan_start(replay: Replay) -> Floats:
    """Pose of the Delta-frame at a plan's start: x, y [m], heading [rad], shape (3,)."""
    return np.array(replay.stances[0]["pose"][DELTA])


BALANCE: Final = 0.03
"""Plans that are walked keep the centre of mass so far inside the standing feet [m]: 20 mm that the walk asks for, and its errors ..."""
CLEARANCE: Final = 0.02
"""... and feet so far from patches and edges [m]: dead reckoning is a centimetre off after two metres ..."""
STROKE: Final = 0.006
"""... and leave so much of the actuators' strokes at either end [m]."""
GUARD: Final = 0.02
"""What they leave of the guard against singular postures that walks keep to [-]."""


def careful(task: WalkerTask) -> WalkerTask:
    """A task that asks for more than its checks do, so that a plan that holds in it can bear to be carried out."""
    rules, guard = task.rules, min(task.robot.mechanism.guard, Limits().guard - GUARD)
    changed = change_task(
        task,
        [
            f"rules.balance={max(rules.balance, BALANCE)!r} m",
            f"rules.clearance={max(rules.clearance, CLEARANCE)!r} m",
            f"rules.stroke={max(rules.stroke, STROKE)!r} m",
            f"mechanism.guard={guard!r}",
        ],
    )
    assert isinstance(changed, WalkerTask)  # the robot stays what it is
    return changed


def walk_of(task: WalkerTask) -> Walk:
    """The walk of a task, without its way: robot, ground and start."""
    start, robot = task.start, task.robot
    rest = () if robot.arm is None else robot.arm.rest
    return Walk(
        name=task.name,
        title=task.title,
        robot=robot,
        ground=task.world,
        start=WalkStart(x=start.x, y=start.y, heading=start.theta, offset=start.offset, twist=start.twist),
        way=(),
        arm=rest if start.arm is None else start.arm,
        payload=start.payload,
    )


def lay_plan(task: WalkerTask, plan: Plan, label: str = "plan") -> Lay:
    """How a plan is laid out as a course from where the robot stands.

    Args:
        task: The task that the plan holds in.
        plan: The plan.
        label: What errors call it.

    Raises:
        SpecError: If the plan has actions that the task has not, or one of them violates a hard check; it names step and check.
    """
    codes = plan.codes(task, label)
    replay = plan_family(task).problem(task).replay(codes)
    if not replay.ok:
        step = int(np.argmax(replay.reasons >= 0))
        check = plan_family(task).checks[int(replay.reasons[step])]
        short = (
            f"violates the hard check '{check.name}' by {-replay.margins[step, replay.reasons[step]]:.4g} {check.unit}"
        )
        raise SpecError(label, f"actions.{step}", plan.actions[step].title, f"{short}; nothing has moved")
    steps, start = planned_steps(codes, replay), plan_start(replay)

    def lay(pose: Floats) -> PlannedCourse:
        return PlannedCourse(steps, start, pose, radius=task.robot.legs.radius_delta)

    return lay
