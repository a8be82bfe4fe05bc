"""The two-frame walker's task: a robot on a ground, its start, its steps, what counts as allowed and as done."""

import math
from collections.abc import Mapping
from dataclasses import field, replace
from typing import Annotated, Final, Literal

from pydantic import StrictStr

from ..errors import describe_choices
from ..files import Document, check_schema, content_hash
from ..robots.walker import WalkerRobot, build_walker
from ..specs import Name, build_spec, spec
from ..statics.walker_checks import WALKER_CHECKS
from ..types import Json
from ..units import Angle, Length, NonNegativeLength, NonNegativeMass, Point, Quantity
from ..worlds.ground import Ground, build_ground

SCHEMA: Final = "clamber-task-1"
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
class Goal:
    """A goal or sub-goal for the Delta-frame, world frame: all that is given must hold; boxes include their edges."""

    name: StrictStr = ""
    at: Point | None = None
    """In a file, short for a box of half a step each way about this point [m]."""
    x_min: Length | None = None
    """Least x of the Delta-frame's origin [m]."""
    x_max: Length | None = None
    """Largest x of the Delta-frame's origin [m]."""
    y_min: Length | None = None
    """Least y of the Delta-frame's origin [m]."""
    y_max: Length | None = None
    """Largest y of the Delta-frame's origin [m]."""
    theta_min: Angle | None = None
    """Least angle of the Delta-frame [rad]."""
    theta_max: Angle | None = None
    """Largest angle of the Delta-frame [rad]."""

    @property
    def box(self) -> tuple[float, float, float, float]:
        """x_min, x_max, y_min, y_max [m]; infinite where open."""
        low, high = -math.inf, math.inf
        return (
            low if self.x_min is None else self.x_min,
            high if self.x_max is None else self.x_max,
            low if self.y_min is None else self.y_min,
            high if self.y_max is None else self.y_max,
        )


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
class WalkerTask:
    """A task with everything resolved: SI units, point goals as boxes."""

    name: str
    title: str
    robot: WalkerRobot
    world: Ground
    start: Start
    step: Step
    goals: tuple[Goal, ...]
    """Sub-goals in order, then the goal."""
    rules: Rules
    document: Json = field(default_factory=dict)
    """Robot, ground and task as read, with overrides applied, plain data: a worker rebuilds the task from it."""
    hashes: Mapping[str, str] = field(default_factory=dict)
    """"robot", "ground", "task" -> SHA-256 of that part of `document`."""


def build_walker_task(document: Document) -> WalkerTask:
    """A task from its merged document: a task file with its robot and ground in place of their names.

    Raises:
        SpecError: If any of the three breaks a rule, or they do not fit each other.
    """
    check_schema(document, SCHEMA)
    robot_document = document.section("robot", _label(document, "robot"))
    ground_document = document.section("ground", _label(document, "ground"))
    stated = build_spec(WalkerTaskSpec, document, without=("schema", "robot", "ground", "labels"))
    _check(stated, document)
    rest = {key: value for key, value in document.data.items() if key not in {"robot", "ground", "labels"}}
    robot = build_walker(robot_document)
    _check_arm(stated.start, robot, document)
    return WalkerTask(
        name=stated.name,
        title=stated.title,
        robot=robot,
        world=build_ground(ground_document),
        start=stated.start,
        step=stated.step,
        goals=tuple(_resolve(goal, stated.step) for goal in (*stated.subgoals, stated.goal)),
        rules=stated.rules,
        document=document.data,
        hashes={
            "robot": content_hash(robot_document.data),
            "ground": content_hash(ground_document.data),
            "task": content_hash(rest),
        },
    )


def _label(document: Document, section: str) -> str:
    labels = document.data.get("labels")
    label = labels.get(section) if isinstance(labels, dict) else None
    return label if isinstance(label, str) else f"{document.label} [{section}]"


def _check(stated: WalkerTaskSpec, document: Document) -> None:
    steps = math.tau / stated.step.angle
    if abs(steps - round(steps)) > 1e-9 * steps:
        allowed = f"must divide a turn; {steps:.6g} steps fill one, so take '{360 / max(1, round(steps)):.6g} deg'"
        raise document.problem("step.angle", allowed)
    for name in stated.rules.hard:
        if name not in CHECK_NAMES:
            raise document.problem("rules.hard", f"unknown check '{name}'; {describe_choices(name, CHECK_NAMES)}")
    if len(set(stated.rules.hard)) < len(stated.rules.hard):
        raise document.problem("rules.hard", "names a check twice")
    keys = (*(f"subgoals.{index}" for index in range(len(stated.subgoals))), "goal")
    for key, goal in zip(keys, (*stated.subgoals, stated.goal), strict=True):
        _check_goal(goal, key, document)


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


def _check_goal(goal: Goal, key: str, document: Document) -> None:
    if (goal.theta_min is None) != (goal.theta_max is None):
        raise document.problem(key, "states theta_min and theta_max both or neither")
    if goal.at is None and goal.theta_min is None and not any(map(math.isfinite, goal.box)):
        raise document.problem(
            key, "asks for nothing; state x_min, x_max, y_min, y_max, at, or theta_min and theta_max"
        )
    for axis in ("x", "y", "theta"):
        low, high = getattr(goal, f"{axis}_min"), getattr(goal, f"{axis}_max")
        if low is not None and high is not None and low > high:
            raise document.problem(f"{key}.{axis}_min", f"must be at most {axis}_max")


def _resolve(goal: Goal, step: Step) -> Goal:
    """The goal with a point as a box of half a step each way, cut with the box that it states besides."""
    if goal.at is None:
        return goal
    half, (x, y) = step.length / 2.0, goal.at
    x_min, x_max, y_min, y_max = goal.box
    return replace(
        goal,
        x_min=max(x_min, x - half),
        x_max=min(x_max, x + half),
        y_min=max(y_min, y - half),
        y_max=min(y_max, y + half),
    )
