"""The limbed climber's task: a robot on a board, where it starts, how it steps, what counts as allowed and as done."""

import math
from collections.abc import Mapping
from dataclasses import field, replace
from typing import Annotated, Final, Literal

import numpy as np
from pydantic import Field, StrictBool, StrictInt, StrictStr

from ..errors import describe_choices
from ..files import Document, check_schema, content_hash
from ..robots.limbed import LimbedRobot, build_limbed
from ..specs import Name, build_spec, spec
from ..statics.checks import DEFAULT_HARD, LIMBED_CHECKS
from ..types import Json
from ..units import (
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
from ..worlds.board import Board, build_board, check_polygon

SCHEMA: Final = "clamber-task-1"
CHECK_NAMES: Final = tuple(check.name for check in LIMBED_CHECKS)
FREE: Final = 0
"""The hold number of a limb that holds nothing."""
DEFAULT_FOOT: Final = 0.6
"""A limb that starts free points straight out from its port, this share of its length [-]."""


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
    hard: tuple[StrictStr, ...] = DEFAULT_HARD
    """Names of the checks that forbid an action; the others only report."""
    allowed: tuple[StrictStr, ...] | None = None
    """Kinds or codes of the actions that may be used; None: all."""
    keep: tuple[Keep, ...] = ()
    """Boxes that limbs must keep to."""
    barred: dict[str, tuple[StrictInt, ...]] = field(default_factory=dict)
    """Limb -> numbers of holds that it may not use."""


@spec
class Goal:
    """A goal or sub-goal, world frame: all that is given must hold at once; boxes include their edges."""

    name: StrictStr = ""
    at: Point | None = None
    """In a file, short for a box of half a step each way about this point [m]."""
    x_min: Length | None = None
    """Least x of the body's origin [m]."""
    x_max: Length | None = None
    """Largest x of the body's origin [m]."""
    y_min: Length | None = None
    """Least y of the body's origin [m]."""
    y_max: Length | None = None
    """Largest y of the body's origin [m]."""
    theta_min: Angle | None = None
    """Least angle of the body [rad]."""
    theta_max: Angle | None = None
    """Largest angle of the body [rad]."""
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
class LimbedTask:
    """A task with everything resolved: SI units, free limbs placed, point goals as boxes."""

    name: str
    title: str
    robot: LimbedRobot
    world: Board
    start: Start
    step: Step
    goals: tuple[Goal, ...]
    """Sub-goals in order, then the goal."""
    rules: Rules
    seed: int = 0
    document: Json = field(default_factory=dict)
    """Robot, board and task as read, with overrides applied, plain data: a worker rebuilds the task from it."""
    hashes: Mapping[str, str] = field(default_factory=dict)
    """"robot", "board", "task" -> SHA-256 of that part of `document`."""


def build_limbed_task(document: Document) -> LimbedTask:
    """A task from its merged document: a task file with its robot and board in place of their names.

    Raises:
        SpecError: If any of the three breaks a rule, or they do not fit each other.
    """
    check_schema(document, SCHEMA)
    robot_document = document.section("robot", _label(document, "robot"))
    board_document = document.section("board", _label(document, "board"))
    robot, board = build_limbed(robot_document), build_board(board_document)
    stated = build_spec(TaskSpec, _with_place(document, board), without=("schema", "robot", "board", "labels"))
    _check_step(stated.step, document)
    _check_start(stated.start, robot, board, document)
    _check_rules(stated.rules, robot, board, document)
    keys = (*(f"subgoals.{index}" for index in range(len(stated.subgoals))), "goal")
    goals = tuple(_resolve(goal, stated.step) for goal in (*stated.subgoals, stated.goal))
    for key, goal in zip(keys, goals, strict=True):
        _check_goal(goal, key, robot, board, document)
    _check_centres(keys, goals, document)
    rest = {key: value for key, value in document.data.items() if key not in {"robot", "board", "labels"}}
    return LimbedTask(
        name=stated.name,
        title=stated.title,
        robot=robot,
        world=board,
        start=_placed(stated.start, robot),
        step=stated.step,
        goals=goals,
        rules=stated.rules,
        seed=stated.seed,
        document=document.data,
        hashes={
            "robot": content_hash(robot_document.data),
            "board": content_hash(board_document.data),
            "task": content_hash(rest),
        },
    )


def _with_place(document: Document, board: Board) -> Document:
    """The document with the start's `x` and `y`, where they are missing, from the holds that it is between."""
    start = document.data.get("start")
    between = start.get("between") if isinstance(start, dict) else None
    if not isinstance(start, dict) or not isinstance(between, list) or not between:
        return document
    places = {hold.number: (hold.x, hold.y) for hold in board.holds}
    for number in between:
        if number not in places:
            allowed = f"board '{board.name}' has no hold {number!r}; {_listed(set(places))}"
            raise document.problem("start.between", allowed)
    means = [math.fsum(places[number][axis] for number in between) / len(between) for axis in (0, 1)]
    place = {name: f"{mean!r} m" for name, mean in zip("xy", means, strict=True)}
    return Document(document.label, document.data | {"start": place | start}, document.overrides, document.folder)


def _label(document: Document, section: str) -> str:
    labels = document.data.get("labels")
    label = labels.get(section) if isinstance(labels, dict) else None
    return label if isinstance(label, str) else f"{document.label} [{section}]"


def _check_step(step: Step, document: Document) -> None:
    steps = math.tau / step.angle
    if abs(steps - round(steps)) > 1e-9 * steps:
        allowed = f"must divide a turn; {steps:.6g} steps fill one, so take '{360 / max(1, round(steps)):.6g} deg'"
        raise document.problem("step.angle", allowed)


def _check_start(start: Start, robot: LimbedRobot, board: Board, document: Document) -> None:
    numbers = {hold.number for hold in board.holds}
    _check_limbs(start.holds, "start.holds", robot, document)
    _check_limbs(start.feet, "start.feet", robot, document)
    seen: dict[int, str] = {}
    for limb, number in start.holds.items():
        if number == FREE:
            continue
        key = f"start.holds.{limb}"
        if number not in numbers:
            raise document.problem(key, f"board '{board.name}' has no such hold; {_listed(numbers)}, and 0 is free")
        if number in seen:
            raise document.problem(key, f"two limbs are on hold {number} ('{seen[number]}' too); give each its own")
        if limb in start.feet:
            raise document.problem(f"start.feet.{limb}", f"'{limb}' is on hold {number}; only free limbs have feet")
        seen[number] = limb
    if not seen:
        raise document.problem("start.holds", "all limbs are free; at least one must be on a hold")
    if start.in_use is not None:
        _check_limb(start.in_use, "start.in_use", robot, document)


def _check_rules(rules: Rules, robot: LimbedRobot, board: Board, document: Document) -> None:
    for name in rules.hard:
        if name not in CHECK_NAMES:
            raise document.problem("rules.hard", f"unknown check '{name}'; {describe_choices(name, CHECK_NAMES)}")
    if len(set(rules.hard)) < len(rules.hard):
        raise document.problem("rules.hard", "names a check twice")
    if rules.min_supports > len(robot.limbs):
        raise document.problem("rules.min_supports", f"must be at most the number of limbs, {len(robot.limbs)}")
    shortest = min(limb.length for limb in robot.limbs)
    for key, offset in (("reach_offset", rules.reach_offset), ("holding_offset", rules.holding_offset)):
        if offset >= shortest:
            raise document.problem(f"rules.{key}", f"must be less than the shortest limb, {shortest:.4g} m")
    for index, keep in enumerate(rules.keep):
        _check_limb(keep.limb, f"rules.keep.{index}.limb", robot, document)
        _check_order(keep, f"rules.keep.{index}", ("x", "y"), document)
    _check_limbs(rules.barred, "rules.barred", robot, document)
    known = {hold.number for hold in board.holds}
    for limb, numbers in rules.barred.items():
        if not known.issuperset(numbers):
            allowed = f"names holds that board '{board.name}' does not have; {_listed(known)}"
            raise document.problem(f"rules.barred.{limb}", allowed)


def _check_goal(goal: Goal, key: str, robot: LimbedRobot, board: Board, document: Document) -> None:
    angle_given = goal.theta_min is not None or goal.theta_max is not None
    given = goal.box != (-math.inf, math.inf, -math.inf, math.inf) or angle_given
    if not (given or goal.region or goal.holds or goal.turns is not None):
        raise document.problem(key, "asks for nothing; state x_min, x_max, y_min, y_max, at, region, holds or turns")
    if (goal.theta_min is None) != (goal.theta_max is None):
        raise document.problem(key, "states theta_min and theta_max both or neither")
    _check_order(goal, key, ("x", "y", "theta"), document)
    if (goal.turns is None) != (goal.centre is None):
        raise document.problem(key, "states 'turns' and 'centre' both or neither")
    if goal.turns == 0.0:
        raise document.problem(f"{key}.turns", "must not be 0; anticlockwise is positive")
    if goal.region is not None:
        check_polygon(goal.region, document, f"{key}.region")
    _check_limbs(goal.holds, f"{key}.holds", robot, document)
    numbers = {hold.number for hold in board.holds}
    for limb, number in goal.holds.items():
        if number not in numbers:
            raise document.problem(f"{key}.holds.{limb}", f"board '{board.name}' has no such hold; {_listed(numbers)}")
    nearest = _nearest(goal, board)
    if nearest > robot.longest_reach:
        raise document.problem(
            key,
            f"lies {nearest:.4g} m from the nearest hold, but robot '{robot.name}' reaches {robot.longest_reach:.4g} m",
        )


def _check_centres(keys: tuple[str, ...], goals: tuple[Goal, ...], document: Document) -> None:
    circled = [(key, goal.centre) for key, goal in zip(keys, goals, strict=True) if goal.centre is not None]
    for key, centre in circled[1:]:
        if centre != circled[0][1]:
            raise document.problem(
                f"{key}.centre", f"must be that of '{circled[0][0]}'; turns count about one centre a task"
            )


def _check_order(box: Goal | Keep, key: str, axes: tuple[str, ...], document: Document) -> None:
    for axis in axes:
        low, high = getattr(box, f"{axis}_min"), getattr(box, f"{axis}_max")
        if low is not None and high is not None and low > high:
            raise document.problem(f"{key}.{axis}_min", f"must be at most {axis}_max")


def _check_limbs(named: Mapping[str, object], key: str, robot: LimbedRobot, document: Document) -> None:
    for limb in named:
        if limb not in robot.limb_names:
            raise document.problem(f"{key}.{limb}", _unknown_limb(limb, robot))


def _check_limb(limb: str, key: str, robot: LimbedRobot, document: Document) -> None:
    if limb not in robot.limb_names:
        raise document.problem(key, _unknown_limb(limb, robot))


def _unknown_limb(limb: str, robot: LimbedRobot) -> str:
    return f"unknown limb; robot '{robot.name}' has {describe_choices(limb, robot.limb_names)}"


def _listed(numbers: set[int]) -> str:
    return f"it has {len(numbers)}, from {min(numbers)} to {max(numbers)}"


def _nearest(goal: Goal, board: Board) -> float:
    """Distance of the nearest hold from the goal's box, or from the box around its region [m]."""
    x_min, x_max, y_min, y_max = goal.box
    if goal.region is not None:
        xs, ys = zip(*goal.region, strict=True)
        x_min, x_max = max(x_min, min(xs)), min(x_max, max(xs))
        y_min, y_max = max(y_min, min(ys)), min(y_max, max(ys))
    x, y = board.positions().T
    away_x, away_y = (
        np.maximum(np.maximum(x_min - x, x - x_max), 0.0),
        np.maximum(np.maximum(y_min - y, y - y_max), 0.0),
    )
    return float(np.hypot(away_x, away_y).min())


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


def _placed(start: Start, robot: LimbedRobot) -> Start:
    """The start with every limb named: on its hold or free, and the free ones with a foot in the body frame."""
    holds = {limb.name: start.holds.get(limb.name, FREE) for limb in robot.limbs}
    feet = {
        limb.name: (
            limb.port_x + DEFAULT_FOOT * limb.length * math.cos(limb.port_angle),
            limb.port_y + DEFAULT_FOOT * limb.length * math.sin(limb.port_angle),
        )
        for limb in robot.limbs
        if holds[limb.name] == FREE
    }
    return replace(start, holds=holds, feet=feet | start.feet)
