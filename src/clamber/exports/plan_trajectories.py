"""Joint trajectories of plans: where the robot rests after each action. How it moves in between is the controller's to say."""

import math
from collections.abc import Callable
from typing import Any, Final

import numpy as np

from ..actions.plan_families import plan_family
from ..actions.plan_source import OpenedPlan
from ..actions.problem import Replay
from ..actions.walker_problem import outline
from ..robots.limbed import Joint
from ..tasks.limbed import LimbedTask
from ..tasks.walker import WalkerTask
from ..types import Floats
from ..viewing.geometry import joint_angles, stance_posture
from .joint_trajectory import JointTrajectory
from .run_trajectories import ACTUATORS, PLACE


def plan_trajectory(opened: OpenedPlan) -> JointTrajectory:
    """The joints of a plan, a point for its start and for the stance after each action, at rest in all of them.

    Violations are no hindrance: the trajectory says where the plan leads, `clamber check` whether it holds.

    Raises:
        SpecError: If the plan has an action that its task has not.
    """
    task = opened.task
    codes = opened.plan.codes(task, opened.label)
    replay = plan_family(task).problem(task).replay(codes, go_on=True)
    return FAMILIES[task.document["robot"]["family"]](task, replay)


def climb_stances(task: LimbedTask, replay: Replay) -> JointTrajectory:
    """Joints of a climber; efforts are the static torques of each stance."""
    limbs, rows = task.robot.limbs, len(replay.stances)
    angles = np.empty((rows, len(limbs), 2))
    for k, stance in enumerate(replay.stances):
        posture = stance_posture(task.robot, task.world, stance)
        for i, limb in enumerate(limbs):
            chain = tuple(complex(*point) for point in posture.chains[i])
            for j, (joint, angle) in enumerate(
                zip((limb.shoulder, limb.elbow), joint_angles(limb, posture.angle, chain), strict=True)
            ):
                angles[k, i, j] = in_range(joint, angle)
    names = tuple(f"{limb.name}_{joint}" for limb in limbs for joint in ("shoulder", "elbow"))
    time = np.arange(rows, dtype=np.float64) * task.step.duration
    torques = np.array(replay.stances["torques"][:, : len(limbs)]).reshape(rows, -1)
    return _resting(names, (False,) * len(names), time, angles.reshape(rows, -1), torques)


def walk_stances(task: WalkerTask, replay: Replay) -> JointTrajectory:
    """Joints of a walker: the Y-frame in the Delta-frame, and the actuators that move it; plans say nothing of legs."""
    rows = []
    for stance in replay.stances:
        (x, y, heading), own = stance["pose"]
        away = complex(own[0] - x, own[1] - y) * complex(math.cos(heading), -math.sin(heading))
        ends = outline(task, stance).actuators
        lengths = np.hypot(*(ends[:, 1] - ends[:, 0]).T)
        rows.append((away.real, away.imag, math.remainder(own[2] - heading, math.tau), *lengths))
    names = (*PLACE, *ACTUATORS)
    time = np.cumsum(replay.stances["duration"])
    return _resting(names, tuple(name != PLACE[2] for name in names), time - time[0], np.array(rows), None)


FAMILIES: Final[dict[str, Callable[[Any, Replay], JointTrajectory]]] = {"limbed": climb_stances, "walker": walk_stances}
"""Family of the robot -> what makes a trajectory of its plans."""


def in_range(joint: Joint, angle: float) -> float:
    """The angle by whole turns brought nearest to the middle of a joint's range [rad]."""
    middle = 0.5 * (joint.lower + joint.upper)
    return middle + math.remainder(angle - middle, math.tau)


def _resting(
    names: tuple[str, ...], sliding: tuple[bool, ...], time: Floats, positions: Floats, effort: Floats | None
) -> JointTrajectory:
    still = np.zeros_like(positions)
    return JointTrajectory(names, sliding, time, positions, still, still, effort)
