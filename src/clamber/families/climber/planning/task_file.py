"""A limbed climber's task from its file: what is left out filled in, point goals as boxes, all of it checked."""

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Final

from ....errors import describe_choices
from ....files import Document, check_schema
from ....specs import build_spec, field_names
from ....tasks.parts import parts_of
from ....tasks.regions import check_order, check_polygon
from ....tasks.task_format import SCHEMA, TaskFormat, check_angle, check_hard, hashes_of
from ..robot.robot import LimbedRobot, build_limbed
from ..statics.checks import LIMBED_CHECKS
from ..world.board import SHORT_KEYS, Board, build_board, listed_board
from ..world.library import read_board
from .task import FREE, Goal, LimbedTask, Rules, Start, TaskSpec

CHECK_NAMES: Final = tuple(check.name for check in LIMBED_CHECKS)


def check_start(start: Start, robot: LimbedRobot, board: Board, document: Document) -> None:
    """Make sure that every limb named is the robot's, and that each hold of the start is the board's and has one limb.

    Raises:
        SpecError: Otherwise.
    """
    numbers = {hold.number for hold in board.holds}
    _check_limbs(start.holds, "start.holds", robot, document)
    _check_limbs(start.feet, "start.feet", robot, document)
    seen: dict[int, str] = {}
    for limb, number in start.holds.items():
        if number == FREE:
            continue
        key = f"start.holds.{limb}"
        if number not in numbers:
            raise document.problem(key, f"board '{board.name}' has no such hold; {listed(numbers)}, and 0 is free")
        if number in seen:
            raise document.problem(key, f"two limbs are on hold {number} ('{seen[number]}' too); give each its own")
        if limb in start.feet:
            raise document.problem(f"start.feet.{limb}", f"'{limb}' is on hold {number}; only free limbs have feet")
        seen[number] = limb
    if not seen:
        raise document.problem("start.holds", "all limbs are free; at least one must be on a hold")
    if start.in_use is not None:
        _check_limb(start.in_use, "start.in_use", robot, document)


def check_rules(rules: Rules, robot: LimbedRobot, board: Board, document: Document) -> None:
    """Make sure that rules name checks, limbs and holds that there are, and can be met at all.

    Raises:
        SpecError: Otherwise.
    """
    check_hard(rules.hard, CHECK_NAMES, document)
    if rules.min_supports > len(robot.limbs):
        raise document.problem("rules.min_supports", f"must be at most the number of limbs, {len(robot.limbs)}")
    shortest = min(limb.length for limb in robot.limbs)
    for key, offset in (("reach_offset", rules.reach_offset), ("holding_offset", rules.holding_offset)):
        if offset >= shortest:
            raise document.problem(f"rules.{key}", f"must be less than the shortest limb, {shortest:.4g} m")
    for index, keep in enumerate(rules.keep):
        _check_limb(keep.limb, f"rules.keep.{index}.limb", robot, document)
        check_order(keep, f"rules.keep.{index}", ("x", "y"), document)
    _check_limbs(rules.barred, "rules.barred", robot, document)
    known = {hold.number for hold in board.holds}
    for limb, numbers in rules.barred.items():
        if not known.issuperset(numbers):
            allowed = f"names holds that board '{board.name}' does not have; {listed(known)}"
            raise document.problem(f"rules.barred.{limb}", allowed)


def check_goal(goal: Goal, key: str, robot: LimbedRobot, board: Board, document: Document) -> None:
    """Make sure that a goal asks for something that the robot could come to on the board; `key` is where the document has it.

    Raises:
        SpecError: Otherwise.
    """
    angle_given = goal.theta_min is not None or goal.theta_max is not None
    given = goal.box != (-math.inf, math.inf, -math.inf, math.inf) or angle_given
    if not (given or goal.region or goal.holds or goal.turns is not None):
        raise document.problem(key, "asks for nothing; state x_min, x_max, y_min, y_max, at, region, holds or turns")
    goal.check_ranges(key, document)
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
            raise document.problem(f"{key}.holds.{limb}", f"board '{board.name}' has no such hold; {listed(numbers)}")
    nearest = _nearest(goal, board)
    if nearest > robot.longest_reach:
        raise document.problem(
            key,
            f"lies {nearest:.4g} m from the nearest hold, but robot '{robot.name}' reaches {robot.longest_reach:.4g} m",
        )


def check_centres(keys: tuple[str, ...], goals: tuple[Goal, ...], document: Document) -> None:
    """Make sure that all turns are about one place; `keys` are where the document has the goals.

    Raises:
        SpecError: Otherwise.
    """
    circled = [(key, goal.centre) for key, goal in zip(keys, goals, strict=True) if goal.centre is not None]
    for key, centre in circled[1:]:
        if centre != circled[0][1]:
            raise document.problem(
                f"{key}.centre", f"must be that of '{circled[0][0]}'; turns count about one centre a task"
            )


def _check_limbs(named: Mapping[str, object], key: str, robot: LimbedRobot, document: Document) -> None:
    for limb in named:
        _check_limb(limb, f"{key}.{limb}", robot, document)


def _check_limb(limb: str, key: str, robot: LimbedRobot, document: Document) -> None:
    if limb not in robot.limb_names:
        known = describe_choices(limb, robot.limb_names)
        raise document.problem(key, f"unknown limb; robot '{robot.name}' has {known}")


def listed(numbers: set[int]) -> str:
    """How many holds there are, and between which numbers, in words."""
    return f"it has {len(numbers)}, from {min(numbers)} to {max(numbers)}"


def _nearest(goal: Goal, board: Board) -> float:
    """Distance of the nearest hold from the goal's box, or from the box around its region [m]."""
    return float(goal.off(board.positions()).min())


DEFAULT_FOOT: Final = 0.6
"""A limb that starts free points straight out from its port, this share of its length [-]."""


def build_limbed_task(document: Document) -> LimbedTask:
    """A task from its merged document: a task file with its robot and board in place of their names.

    Raises:
        SpecError: If any of the three breaks a rule, or they do not fit each other.
    """
    check_schema(document, SCHEMA)
    parts = parts_of(document, "board")
    robot, board = build_limbed(parts["robot"]), build_board(parts["board"])
    stated = build_spec(TaskSpec, _with_place(document, board), without=("schema", *parts, "labels"))
    check_angle(stated.step.angle, document)
    check_start(stated.start, robot, board, document)
    check_rules(stated.rules, robot, board, document)
    keys = (*(f"subgoals.{index}" for index in range(len(stated.subgoals))), "goal")
    goals = tuple(goal.around_point(stated.step.length) for goal in (*stated.subgoals, stated.goal))
    for key, goal in zip(keys, goals, strict=True):
        check_goal(goal, key, robot, board, document)
    check_centres(keys, goals, document)
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
        hashes=hashes_of(document, parts),
    )


def _with_place(document: Document, board: Board) -> Document:
    """The document with the start's `x` and `y`, where they are missing, from the holds that it is between."""
    start = document.data.get("start")
    between = start.get("between") if isinstance(start, dict) else None
    if not isinstance(start, dict) or not isinstance(between, list) or not between:
        return document
    places = {hold.number: (hold.x, hold.y) for hold in board.holds}
    for number in between:
        if not isinstance(number, int):
            raise document.problem("start.between", "must be a list of numbers of holds")
        if number not in places:
            allowed = f"board '{board.name}' has no hold {number!r}; {listed(set(places))}"
            raise document.problem("start.between", allowed)
    means = [math.fsum(places[number][axis] for number in between) / len(between) for axis in (0, 1)]
    place = {name: f"{mean!r} m" for name, mean in zip("xy", means, strict=True)}
    return Document(document.label, document.data | {"start": place | start}, document.overrides, document.folder)


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


FILES: Final = TaskFormat(
    build_robot=build_limbed,
    robot_spec=LimbedRobot,
    world_key="board",
    read_world=read_board,
    build=build_limbed_task,
    listed_world=listed_board,
    task_spec=TaskSpec,
    task_keys=field_names(TaskSpec),
    robot_keys=tuple(name for name in field_names(LimbedRobot) if name != "sources"),
    short_keys={f"board.{short}": f"board.{key}" for short, key in SHORT_KEYS.items()},
)
"""How files of climbers are read."""
