"""A limbed climber's task from its file: what is left out filled in, point goals as boxes, all of it checked."""

import math
from dataclasses import replace
from typing import Final

from ....files import Document, check_schema
from ....specs import build_spec, field_names
from ....tasks.parts import parts_of
from ....tasks.task_format import SCHEMA, TaskFormat, check_angle, hashes_of
from ..robot.robot import LimbedRobot, build_limbed
from ..world.board import SHORT_KEYS, Board, build_board, listed_board
from ..world.library import read_board
from .task import FREE, LimbedTask, Start, TaskSpec
from .task_checks import check_centres, check_goal, check_rules, check_start, listed

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
