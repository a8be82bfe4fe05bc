"""Tasks on random boards: a robot starts near the bottom, where it can stand, and is to climb to the top."""

import json
import math
import re
from collections.abc import Sequence
from typing import Any, Final

from ....errors import MISSING, SpecError
from ....files import Document
from ....specs import field_names
from ....tasks.overrides import apply_overrides, split_override
from ....tasks.robots import read_robot
from ....tasks.task_format import SCHEMA
from ....types import Json
from ....units import DEGREE, UNITS
from ..robot.robot import build_limbed
from ..world.board import build_board
from ..world.random_board import random_board_data
from .first_stance import first_stance, liked_stance
from .task import LimbedTask, TaskSpec
from .task_file import build_limbed_task

ROBOT: Final = "libra"
HARD: Final = ("reach", "joint", "support", "hangs", "torque", "power", "clearance", "swing", "keep_out")
STEP: Final = 0.2
"""A step of the body, of the robot's reach, about: LIBRA's 3 in [-]."""
ROUND: Final = (1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 7.5)
"""First digits of steps."""
TOP: Final = 0.6
"""The goal lies this share of the robot's reach below the highest hold [-]."""


def climb_data(
    board: Json,
    board_label: str,
    *,
    name: str,
    robot: str = ROBOT,
    overrides: Sequence[str] = (),
    to_edit: bool = False,
) -> tuple[Json, Json]:
    """What a task file says that sends a robot up a board; its start is the lowest stance that the rules allow.

    Args:
        board: The board's document.
        board_label: What errors call it.
        name: What the task is called.
        robot: Name or file of a limbed robot.
        overrides: Texts "key=value" on keys of the task or `robot=...`, such as "rules.max_hangs=0" or "step.length=1in".
        to_edit: Whether a person starts from it: with a start that every check likes, in units of the robot's file.

    Returns:
        The task file without its board, and the robot's document.

    Raises:
        SpecError: If the board has no such stance, or an override sets something that is not the task's.
    """
    robots = [value for key, value in map(split_override, overrides) if key == "robot"]
    rest = [text for text in overrides if split_override(text)[0] != "robot"]
    robot = robots[-1] if robots else robot
    robot_document = read_robot(robot)
    climber, wall = build_limbed(robot_document), build_board(Document(board_label, board))
    points, unit = wall.positions(), length_unit(robot_document.data)
    (left, bottom), (right, top) = points.min(axis=0).tolist(), points.max(axis=0).tolist()
    data: Json = {
        "schema": SCHEMA,
        "name": name,
        "title": f"{climber.name.upper()} climbs {len(points)} holds",
        "robot": robot,
        "start": {"x": f"{left!r} m", "y": f"{bottom!r} m", "holds": {climber.limbs[0].name: wall.holds[0].number}},
        "step": {"length": step_for(climber.longest_reach, unit) if to_edit else "3 in", "angle": "15 deg"},
        "goal": {
            "name": "top",
            "x_min": f"{left!r} m",
            "x_max": f"{right!r} m",
            "y_min": f"{max(bottom, top - TOP * climber.longest_reach):.4f} m",
        },
        "rules": {"clearance": "0 cm", "hard": list(HARD)},
    }
    keys = (*field_names(TaskSpec), "robot")
    data = apply_overrides(Document(name, data), rest, keys, (), {}).data
    found = (liked_stance if to_edit else first_stance)(_built(data, board, board_label, robot_document))
    if found is None:
        allowed = f"robot '{climber.name}' has no stance on two holds that the hard checks allow; take a denser board"
        raise SpecError(board_label, "start", MISSING, allowed)
    stated = {key: value for key, value in data["start"].items() if key in {"in_use", "feet"}}
    data = {**data, "start": {**found, **stated}}
    return _in_unit(data, unit) if to_edit else data, robot_document.data


def length_unit(robot: Json) -> str:
    """The unit in which a robot's file states most lengths, inches where it states them so; else cm."""
    texts = re.findall(r"""['"](?:[-+\d.e]+ ?)?(m|cm|mm|in|ft)['"]""", json.dumps(robot))
    return max(sorted(set(texts)), key=texts.count, default="cm")


def step_for(reach: float, unit: str) -> str:
    """A step of the body that suits a robot's reach [m], in round numbers of a unit."""
    size, wished = UNITS["length"][unit], STEP * reach
    steps = [round_number * 10.0**power for power in range(-3, 4) for round_number in ROUND]
    return f"{min(steps, key=lambda step: abs(math.log(step * size / wished))):g} {unit}"


def _in_unit(data: Json, unit: str) -> Json:
    """A task's start and goal with lengths in a unit, and angles in degrees."""
    size = UNITS["length"][unit]

    def stated(value: Any) -> Any:
        if not isinstance(value, str) or not value.endswith((" m", " rad")):
            return value
        number, own = float(value.split()[0]), value.split()[1]
        return f"{round(number / size, 6):g} {unit}" if own == "m" else f"{round(number / DEGREE, 6):g} deg"

    parts = {part: {key: stated(value) for key, value in data[part].items()} for part in ("start", "goal")}
    return {**data, **parts}


def random_task(
    holds: int,
    density: float,
    seed: int = 0,
    *,
    width: float | None = None,
    least_gap: float | None = None,
    robot: str = ROBOT,
    name: str = "random-climb",
    overrides: Sequence[str] = (),
) -> LimbedTask:
    """A task on a random board: from the lowest stance to the top.

    Args:
        holds: How many.
        density: Holds per area [1/m^2].
        seed: Of the board; same seed, same task.
        width: Of the wall [m]; None: as wide as high.
        least_gap: Least distance of two holds [m]; None: half of the mean distance.
        robot: Name or file of a limbed robot.
        name: What the task is called.
        overrides: Texts "key=value" on keys of the task.

    Raises:
        SpecError: If the board can't be made, or the robot can't start on it.
    """
    board = random_board_data(holds, density, seed, width=width, least_gap=least_gap, name=f"{name}-board")
    label = f"random board of {holds} holds, seed {seed}"
    data, robot_data = climb_data(board, label, name=name, robot=robot, overrides=overrides)
    return _built(data, board, label, Document(str(data["robot"]), robot_data))


def _built(data: Json, board: Json, board_label: str, robot: Document) -> LimbedTask:
    whole: dict[str, Any] = {
        **data, "robot": robot.data, "board": board, "labels": {"robot": robot.label, "board": board_label}
    }  # fmt: skip
    return build_limbed_task(Document(str(data["name"]), whole))
