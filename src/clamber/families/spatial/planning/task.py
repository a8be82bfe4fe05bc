"""The task of a robot in space: a robot in a world, its start, the lattice of its poses, what counts as allowed and as done."""

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Annotated, Final

from pydantic import Field, StrictBool, StrictStr

from ....files import Document, check_schema
from ....specs import Name, build_spec, field_names, spec
from ....tasks.parts import parts_of
from ....tasks.regions import check_order
from ....tasks.task_format import SCHEMA, ReadTask, TaskFormat, check_angle, check_hard, hashes_of
from ....units import Angle, Length, NonNegativeLength, PositiveAngle, PositiveLength, Quantity
from ..robot.handling import Payload
from ..robot.robot import RobotSpec, SpatialRobot, build_robot, whole_document
from ..world.library import read_world
from ..world.world import World, build_world
from .checks import SPATIAL_CHECKS

CHECK_NAMES: Final = tuple(check.name for check in SPATIAL_CHECKS)
MOST_STEPS: Final = 1000
"""Steps of height and tilt either way: keys of stances keep them in 16 bits."""
Force = tuple[
    Annotated[float, Quantity("force")], Annotated[float, Quantity("force")], Annotated[float, Quantity("force")]
]
Share = Annotated[float, Quantity("ratio", at_least=0.0, at_most=0.9)]
Steps = Annotated[int, Field(strict=True, ge=0, le=MOST_STEPS)]


@spec
class Lattice:
    """By how much one step moves or turns the body."""

    length: Annotated[float, Quantity("length", at_least=1e-4)]
    """Along and across the guide [m]."""
    height: PositiveLength
    """Out of the surface [m]."""
    angle: PositiveAngle
    """About the body's normal [rad]; divides a turn."""
    tilt: Angle = 0.0
    """Of pitch and of roll [rad]; 0: the body keeps to the guide's normal."""
    heights: Steps = 2
    """Most steps of height above and below `start.height`."""
    tilts: Steps = 2
    """Most steps of pitch and roll either way."""
    far: Annotated[int, Field(strict=True, ge=2, le=9)] = 3
    """Steps of the longer of the two moves along and across."""
    follow: StrictBool = False
    """Whether height and tilt of the body follow the smooth surface that is fitted to the holds."""
    nearest: Annotated[int, Field(strict=True, ge=1, le=64)] = 5
    """Holds that a limb may choose from at a stance: those whose posture is nearest the nominal one and that lie towards the goal."""


@spec
class Start:
    """Where the body is before the first action."""

    along: Length = 0.0
    """Along the guide [m]."""
    across: Length = 0.0
    """Across it, to its left [m]."""
    height: Length
    """Of the body's origin over the guide [m]."""
    yaw: Angle = 0.0
    """Of the body's x from the guide's direction, about the normal [rad]."""
    pitch: Angle = 0.0
    """About the body's y, after the yaw [rad]; with 90 deg on a guide that goes straight up a body that would stand on end lies level."""
    roll: Angle = 0.0
    """About the body's x, after the pitch [rad]."""
    holds: Mapping[str, Annotated[int, Field(strict=True, ge=1)]] | None = None
    """Limb -> number of its hold; None: those nearest the nominal tips on which the robot stands best."""

    @property
    def x(self) -> float:
        """Along the guide [m]."""
        return self.along

    @property
    def y(self) -> float:
        """Across the guide [m]."""
        return self.across

    @property
    def theta(self) -> float:
        """About the normal [rad]."""
        return self.yaw


@spec
class Goal:
    """Where the body is to be on its guide: all that is given must hold at once; boxes include their edges."""

    name: StrictStr = ""
    along_min: Length | None = None
    along_max: Length | None = None
    across_min: Length | None = None
    across_max: Length | None = None
    yaw_min: Angle | None = None
    yaw_max: Angle | None = None

    @property
    def x_min(self) -> float | None:
        """Least place along the guide [m]; so for the others."""
        return self.along_min

    @property
    def x_max(self) -> float | None:
        """Largest place along."""
        return self.along_max

    @property
    def y_min(self) -> float | None:
        """Least place across."""
        return self.across_min

    @property
    def y_max(self) -> float | None:
        """Largest place across."""
        return self.across_max

    @property
    def box(self) -> tuple[float, float, float, float]:
        """Least and largest place along, least and largest across [m]; infinite where open."""
        low, high = -math.inf, math.inf
        return (
            low if self.along_min is None else self.along_min,
            high if self.along_max is None else self.along_max,
            low if self.across_min is None else self.across_min,
            high if self.across_max is None else self.across_max,
        )


@spec
class Rules:
    """What the task allows."""

    need: Share = 0.05
    """Share of every strength and torque that is kept in reserve [-]."""
    jump: PositiveAngle = 0.7
    """Most that a joint of a limb on a hold may move between two stances [rad], or the same in metres for a slide."""
    lift: NonNegativeLength = 0.03
    """Height of the path of a swinging end effector over its holds [m]."""
    clearance: NonNegativeLength = 0.0
    """Least distance of links and base from solids [m]."""
    hard: tuple[StrictStr, ...] = CHECK_NAMES
    """Names of the checks that forbid an action; the others only report."""
    push: Force = (0.0, 0.0, 0.0)
    """Force on the body's origin, such as that of wind or of a tool, world frame [N]."""


@spec
class SpatialTaskSpec:
    """What a task file says beside its robot and its world."""

    name: Name
    title: StrictStr = ""
    start: Start
    step: Lattice
    goal: Goal
    subgoals: tuple[Goal, ...] = ()
    """In the order in which they must be met, before `goal`."""
    rules: Rules = Rules()
    payload: Payload | None = None
    """What the base carries in this task, in place of the robot's own payload."""


@spec
class SpatialTask(ReadTask):
    """A task with everything resolved, SI."""

    robot: SpatialRobot
    world: World
    start: Start
    step: Lattice
    goals: tuple[Goal, ...]
    """Sub-goals in order, then the goal."""
    rules: Rules


def build_task(document: Document) -> SpatialTask:
    """A task from its merged document: a task file with its robot and world in place of their names.

    Raises:
        SpecError: If any of the three breaks a rule, or they do not fit each other.
    """
    check_schema(document, SCHEMA)
    parts = parts_of(document, "world")
    # its limbs may have been given other contacts than its file's
    parts["robot"] = carrier = whole_document(parts["robot"])
    document = replace(document, data=document.data | {"robot": carrier.data})
    stated = build_spec(SpatialTaskSpec, document, without=("schema", *parts, "labels"))
    check_angle(stated.step.angle, document)
    check_hard(stated.rules.hard, CHECK_NAMES, document)
    keys = (*(f"subgoals.{index}" for index in range(len(stated.subgoals))), "goal")
    for key, goal in zip(keys, (*stated.subgoals, stated.goal), strict=True):
        check_order(goal, key, ("along", "across", "yaw"), document)
        if (goal.yaw_min is None) != (goal.yaw_max is None):
            raise document.problem(key, "states yaw_min and yaw_max both or neither")
        if goal.yaw_min is None and not any(map(math.isfinite, goal.box)):
            raise document.problem(
                key, "asks for nothing; state along_min, along_max, across_min, across_max, or yaw_min and yaw_max"
            )
    if stated.payload is not None:
        carrier = replace(carrier, data=carrier.data | {"payload": document.data["payload"]})
    robot, world = build_robot(carrier), build_world(parts["world"])
    _check_holds(stated.start, robot, world, document)
    return SpatialTask(
        name=stated.name,
        title=stated.title,
        robot=robot,
        world=world,
        start=stated.start,
        step=stated.step,
        goals=(*stated.subgoals, stated.goal),
        rules=stated.rules,
        document=document.data,
        hashes=hashes_of(document, parts),
    )


def _check_holds(start: Start, robot: SpatialRobot, world: World, document: Document) -> None:
    if start.holds is None:
        return
    names = robot.chains.limb_names
    for limb, hold in start.holds.items():
        if limb not in names:
            raise document.problem(f"start.holds.{limb}", f"unknown limb; the robot has {', '.join(names)}")
        if hold > len(world.holds):
            raise document.problem(f"start.holds.{limb}", f"must be 1 to {len(world.holds)}, a hold of the world")
    for limb in names:
        if limb not in start.holds:
            raise document.problem(f"start.holds.{limb}", "must be given: every limb begins on a hold")
    if len(set(start.holds.values())) < len(names):
        raise document.problem("start.holds", "names a hold twice")


FILES: Final = TaskFormat(
    build_robot=build_robot,
    robot_spec=RobotSpec,
    world_key="world",
    read_world=read_world,
    build=build_task,
    task_spec=SpatialTaskSpec,
    task_keys=field_names(SpatialTaskSpec),
    robot_keys=(*field_names(RobotSpec), "contacts"),
)
"""How files of robots in space are read."""
