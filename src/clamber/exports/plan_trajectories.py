"""Joint trajectories of plans: where the robot rests after each action. How it moves in between is the controller's to say."""

from ..family import NotOfFamilyError, family_of
from ..planning.problem.plan_families import plan_family
from ..planning.problem.plan_source import OpenedPlan
from .joint_trajectory import JointTrajectory


def plan_trajectory(opened: OpenedPlan) -> JointTrajectory:
    """The joints of a plan, a point for its start and for the stance after each action, at rest in all of them.

    Violations are no hindrance: the trajectory says where the plan leads, `clamber check` whether it holds.

    Raises:
        SpecError: If the plan has an action that its task has not.
    """
    task = opened.task
    codes = opened.plan.codes(task, opened.label)
    replay = plan_family(task).problem(task).replay(codes, go_on=True)
    trajectories = family_of(task).trajectories
    if trajectories is None:
        raise NotOfFamilyError(family_of(task).title, "joint trajectories")
    return trajectories.plan(task, replay)
