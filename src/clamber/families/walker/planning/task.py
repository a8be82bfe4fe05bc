"""The two-frame walker's task: a robot on a ground, its start, its steps, what counts as allowed and as done."""

import math
from typing import Annotated, Final, Literal

from pydantic import StrictStr

from ....files import Document, check_schema
from ....specs import Name, build_spec, field_names, spec
from ....tasks.parts import parts_of
from ....tasks.regions import GoalBox
from ....tasks.task_format import SCHEMA, ReadTask, TaskFormat, check_angle, check_hard, hashes_of
from ....units import Angle, Length, NonNegativeLength, NonNegativeMass, Point, Quantity
from ..robot import WalkerRobot, build_walker
from ..statics.checks import WALKER_CHECKS
from ..world.ground import Ground, build_ground, read_ground

CHECK_NAMES: Final = tuple(check.name for check in WALKER_CHECKS)


@spec
class Step:
    """By how much one action slides or turns the lifted frame."""

    length: Annotated[float, Quantity("length", at_least=1e-6)]
    """Of a slide [m]."""
    angle: Annotated[float, Quantity("angle", at_least=1e-6)]
    """Of a turn [rad]; divides a turn."""


@spec
class Start:
    """Where the robot is before the first action."""

    x: Length
    """Origin of the Delta-frame, world frame [m]."""
    y: Length
    """Origin of the Delta-frame, world frame [m]."""
    theta: Angle = 0.0
    """Angle of the Delta-frame, world frame [rad]."""
    offset: Point = (0.0, 0.0)
    """Origin of the Y-frame, in the Delta-frame [m]."""
    twist: Angle = 0.0
    """Angle of the Y-frame, in the Delta-frame [rad]."""
    stands: Literal["delta", "y"] = "delta"
    """The frame whose feet are on the ground."""
    arm: tuple[Angle, ...] | None = None
    """Joint angles of the arm while the robot walks [rad]; None for those at rest."""
    payload: NonNegativeMass = 0.0
    """At the tool point of the arm [kg]."""


@spec
class Rules:
    """What the task allows."""

    clearance: NonNegativeLength = 0.0
    """Least distance of a standing foot's edge from any patch [m]."""
    stroke: NonNegativeLength = 0.0
    """Least distance of an actuator's length from either end of its range [m]."""
    balance: NonNegativeLength = 0.0
    """Least distance of the centre of mass from the sides of the support triangle [m]."""
    hard: tuple[StrictStr, ...] = CHECK_NAMES
    """Names of the checks that forbid an action; the others only report."""


@spec
class Goal(GoalBox):
    """A goal or sub-goal, world frame, with the Delta-frame as the body: all that is given must hold; boxes include their edges."""


@spec
class WalkerTaskSpec:
    """What a task file says beside its robot and its ground."""

    name: Name
    title: StrictStr = ""
    start: Start
    step: Step
    goal: Goal
    subgoals: tuple[Goal, ...] = ()
    """In the order in which they must be met, before `goal`."""
    rules: Rules = Rules()


@spec
class WalkerTask(ReadTask):
    """A task with everything resolved: SI units, point goals as boxes."""

    robot: WalkerRobot
    world: Ground
    start: Start
    step: Step
    goals: tuple[Goal, ...]
    """Sub-goals in order, then the goal."""
    rules: Rules


def build_walker_task(document: Document) -> WalkerTask:
    """A task from its merged document: a task file with its robot and ground in place of their names.

    Raises:
        SpecError: If any of the three breaks a rule, or they do not fit each other.
    """
    check_schema(document, SCHEMA)
    parts = parts_of(document, "ground")
    stated = build_spec(WalkerTaskSpec, document, without=("schema", *parts, "labels"))
    _check(stated, document)
    robot = build_walker(parts["robot"])
    _check_arm(stated.start, robot, document)
    return WalkerTask(
        name=stated.name,
        title=stated.title,
        robot=robot,
        world=build_ground(parts["ground"]),
        start=stated.start,
        step=stated.step,
        goals=tuple(goal.around_point(stated.step.length) for goal in (*stated.subgoals, stated.goal)),
        rules=stated.rules,
        document=document.data,
        hashes=hashes_of(document, parts),
    )


def _check(stated: WalkerTaskSpec, document: Document) -> None:
    check_angle(stated.step.angle, document)
    check_hard(stated.rules.hard, CHECK_NAMES, document)
    keys = (*(f"subgoals.{index}" for index in range(len(stated.subgoals))), "goal")
    for key, goal in zip(keys, (*stated.subgoals, stated.goal), strict=True):
        goal.check_ranges(key, document)
        if goal.at is None and goal.theta_min is None and not any(map(math.isfinite, goal.box)):
            raise document.problem(
                key, "asks for nothing; state x_min, x_max, y_min, y_max, at, or theta_min and theta_max"
            )


def _check_arm(start: Start, robot: WalkerRobot, document: Document) -> None:
    if robot.arm is None:
        if start.arm is not None:
            raise document.problem("start.arm", f"the robot '{robot.name}' has no arm")
        if start.payload > 0.0:
            raise document.problem("start.payload", f"the robot '{robot.name}' has no arm to carry it")
    elif start.arm is not None:
        if len(start.arm) != robot.arm.n_joints:
            raise document.problem("start.arm", f"must have {robot.arm.n_joints} angles, one for each joint")
        for joint, angle in enumerate(start.arm):
            low, high = robot.arm.lowest[joint], robot.arm.highest[joint]
            if not low <= angle <= high:
                raise document.problem(
                    f"start.arm.{joint}", f"must be in the joint's range, {low:.6g} to {high:.6g} rad"
                )


FILES: Final = TaskFormat(
    build_robot=build_walker,
    robot_spec=WalkerRobot,
    world_key="ground",
    read_world=read_ground,
    build=build_walker_task,
    task_spec=WalkerTaskSpec,
    task_keys=field_names(WalkerTaskSpec),
    robot_keys=tuple(name for name in field_names(WalkerRobot) if name != "sources"),
)
"""How files of walkers are read."""
