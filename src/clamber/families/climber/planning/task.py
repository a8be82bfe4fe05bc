"""The limbed climber's task: a robot on a board, where it starts, how it steps, what counts as allowed and as done."""

import math
from dataclasses import field
from typing import Annotated, Final, Literal

import numpy as np
from pydantic import Field, StrictBool, StrictInt, StrictStr

from ....errors import SpecError
from ....specs import Name, spec
from ....tasks import Task
from ....tasks.regions import GoalBox
from ....tasks.task_format import ReadTask
from ....types import Floats
from ....units import (
    INCH,
    Angle,
    ConeAngle,
    Length,
    NonNegativeForce,
    NonNegativeLength,
    Point,
    Polygon,
    PositivePower,
    PositiveTime,
    Quantity,
    Ratio,
)
from ..robot.robot import LimbedRobot
from ..statics.checks import DEFAULT_HARD
from ..world.board import Board

FREE: Final = 0
"""The hold number of a limb that holds nothing."""


@spec
class Step:
    """By how much one body move changes the pose."""

    length: Annotated[float, Quantity("length", at_least=1e-6)]
    """Of a move along x or y [m]."""
    angle: Annotated[float, Quantity("angle", at_least=1e-6)]
    """Of a turn of the body [rad]; divides a turn."""
    duration: PositiveTime = 1.0
    """Time that one action takes, for the energy of a plan [s]; chosen, nobody prints it."""


@spec
class Start:
    """Where the robot is before the first action, world frame."""

    x: Length
    """Body origin [m]."""
    y: Length
    """Body origin [m]."""
    theta: Angle = 0.0
    """Body angle [rad]."""
    holds: dict[str, Annotated[int, Field(strict=True, ge=0)]]
    """Limb name -> number of the hold it is on, or 0 if it is free; limbs not named are free."""
    in_use: StrictStr | None = None
    """The limb that moved last; None: the last limb of the robot that holds."""
    feet: dict[str, Point] = field(default_factory=dict)
    """Limb name -> place of a free limb's tip in the body frame [m]."""
    between: tuple[StrictInt, ...] = ()
    """Holds whose mean place is the body's origin, for `x` and `y` that are not given."""


@spec
class Keep:
    """A rule that a limb may use only holds in a box, world frame, edges included."""

    limb: StrictStr
    x_min: Length | None = None
    """Least x of its holds [m]."""
    x_max: Length | None = None
    """Largest x of its holds [m]."""
    y_min: Length | None = None
    """Least y of its holds [m]."""
    y_max: Length | None = None
    """Largest y of its holds [m]."""


@spec
class Rules:
    """What the task allows; the page on the model says what each rule means."""

    force_rule: Literal["thesis", "min_torque", "min_norm"] = "thesis"
    """How the weight is split between the limbs that carry it."""
    support: Literal["strict", "atomic"] = "strict"
    """Whether the robot must be held while a limb swings from hold to hold."""
    max_hangs: Annotated[int, Field(strict=True, ge=-1, lt=2**31)] = -1
    """How often the robot may come to hang on one limb; -1: any number."""
    max_swing: Annotated[float, Quantity("angle", at_least=0.0, at_most=math.pi)] = math.pi
    """Most that the body turns about its hold as it comes to hang, or with one action while it hangs [rad]."""
    min_supports: Annotated[int, Field(strict=True, ge=1)] = 1
    """How many limbs must hold."""
    limb_in_use: Literal["idle", "carries"] = "idle"
    """Whether the limb that moved last carries weight while three or more hold."""
    reach_offset: NonNegativeLength = 0.0
    """Reach that a grab may not use [m]."""
    holding_offset: NonNegativeLength = 0.0
    """Reach that limbs may not use while they hold [m]."""
    offset_while_holding: StrictBool = False
    """Whether the offset of grabs also applies to limbs that hold."""
    replace_out_of_reach: StrictBool = False
    """Whether a hold out of reach is replaced by the nearest one."""
    branch: Literal["free", "kept"] = "free"
    """Whether a limb may change the side of its elbow while it holds."""
    clearance: NonNegativeLength = 6 * INCH
    """Least distance of the body's origin from any hold [m]."""
    inside: NonNegativeLength = 0.0
    """How far the body's origin lies inside the span of the holds that carry it (`stability`) [m]."""
    max_power: PositivePower | None = None
    """Largest electrical power of the joints that carry weight [W]; None: any."""
    hook_cone: ConeAngle = math.pi / 2
    """Half angle of end effectors that state none [rad]."""
    hook_pull: NonNegativeForce = 0.0
    """Pull along its grab direction that every end effector with a cone can be given [N]: a hook with less slips off."""
    hook_width: NonNegativeLength = 0.0
    """Width of a hook with its flare; 0: nothing is asked of holders and other holds (`holder_peg`) [m]."""
    hook_ahead: NonNegativeLength = 0.0
    """How far a hook reaches ahead of its hold's centre, along its grab direction [m]."""
    hook_way: NonNegativeLength = 0.0
    """From how far behind a hook comes straight onto its hold, and goes off again [m]."""
    hook_room: NonNegativeLength = 0.0
    """How far hooks, on their way, too, keep from other holds [m]."""
    hard: tuple[StrictStr, ...] = DEFAULT_HARD
    """Names of the checks that forbid an action; the others only report."""
    allowed: tuple[StrictStr, ...] | None = None
    """Kinds or codes of the actions that may be used; None: all."""
    keep: tuple[Keep, ...] = ()
    """Boxes that limbs must keep to."""
    barred: dict[str, tuple[StrictInt, ...]] = field(default_factory=dict)
    """Limb -> numbers of holds that it may not use."""


@spec
class Goal(GoalBox):
    """A goal or sub-goal, world frame: all that is given must hold at once; boxes include their edges."""

    region: Polygon | None = None
    """Corners of a region that the body's origin is in [m]."""
    holds: dict[str, StrictInt] = field(default_factory=dict)
    """Limb name -> number of the hold it is on."""
    hangs: StrictBool = True
    """Whether the robot may hang on one limb on the way to it, where the rules allow it."""
    turns: Ratio | None = None
    """Turns of the body's origin about `centre`, at least so many; anticlockwise positive [-]."""
    centre: Point | None = None
    """What the turns are about [m]."""

    def off(self, places: Floats) -> Floats:
        """How far places, shape (n, 2), are from the box, less what of it is not about the region, shape (n,) [m]."""
        x_min, x_max, y_min, y_max = self.box
        if self.region is not None:
            xs, ys = zip(*self.region, strict=True)
            x_min, x_max = max(x_min, min(xs)), min(x_max, max(xs))
            y_min, y_max = max(y_min, min(ys)), min(y_max, max(ys))
        x, y = places.T
        off_x = np.maximum(np.maximum(x_min - x, x - x_max), 0.0)
        off_y = np.maximum(np.maximum(y_min - y, y - y_max), 0.0)
        return np.asarray(np.hypot(off_x, off_y))


@spec
class TaskSpec:
    """What a task file says beside its robot and its board."""

    name: Name
    title: StrictStr = ""
    start: Start
    step: Step
    goal: Goal
    subgoals: tuple[Goal, ...] = ()
    """In the order in which they must be met, before `goal`."""
    rules: Rules = Rules()
    seed: Annotated[int, Field(strict=True, ge=0, lt=2**63)] = 0
    """Seeds what the task draws at random."""


@spec
class LimbedTask(ReadTask):
    """A task with everything resolved: SI units, free limbs placed, point goals as boxes."""

    robot: LimbedRobot
    world: Board
    start: Start
    step: Step
    goals: tuple[Goal, ...]
    """Sub-goals in order, then the goal."""
    rules: Rules
    seed: int = 0


def limbed(task: Task, label: str) -> LimbedTask:
    """A task as one of a limbed climber; a `SpecError` calls one of another family by the label."""
    if not isinstance(task, LimbedTask):
        raise SpecError(label, "robot", task.robot.name, "must be a limbed climber")
    return task
