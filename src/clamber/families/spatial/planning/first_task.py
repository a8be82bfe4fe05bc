"""The task that a robot and a world start: along the guide to its end, from where the robot stands best near the guide's beginning."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from ....errors import OptionError, SpecError
from ....files import Document
from ....tasks.overrides import apply_overrides
from ....tasks.parts import Naming
from ....tasks.robots import read_robot
from ....tasks.task_format import SCHEMA
from ....types import Json
from ..robot.robot import FAMILY, SpatialRobot, build_robot
from ..world.guide import GRAIN
from ..world.library import read_world
from ..world.made import Fit, rounded
from .problem import problem_params
from .robot_arrays import nominal_tips, reaches
from .start import find_start
from .task import FILES, SpatialTask, Start, build_task

STEP: Final = 0.08
"""A step along and across over the robot's reach: those of the tasks that come with Clamber, about [-]."""
RISE: Final = 0.04
"""A step of height over the same [-]."""
TURN: Final = "10 deg"
HEIGHTS: Final = (1.0, 0.9, 1.15, 0.8, 1.3, 0.65, 1.5)
"""Heights of the body that are tried, over that of the nominal posture over its tips [-]."""
PLACES: Final = (0.0, 0.1, 0.2, 0.35, 0.5, 0.75, 1.0)
"""Places along the guide that are tried, over the robot's reach [-]."""
HIGHER: Final = 0.3
"""Share of strength that is worth e times the nominal height, or an e-th of it [-]."""
FARTHER: Final = 0.1
"""Share of strength that is worth a reach along the guide [-]."""


def fit_of(robot: SpatialRobot) -> Fit:
    """A robot's size, as worlds ask for it."""
    tips = nominal_tips(robot)
    aside = tips[:, 1][abs(tips[:, 1]) > 1e-3]
    straddle = float(abs(aside).mean()) if len(aside) else float(abs(tips[:, :2]).max())
    return Fit(reach=float(reaches(robot).max()), straddle=2.0 * straddle)


def fit_named(name_or_path: str) -> Fit:
    """The size of a robot in space by its name or file.

    Raises:
        ClamberError: If there is none, or it is of another family.
    """
    document = read_robot(name_or_path)
    if document.data.get("family") != FAMILY:
        raise OptionError("--robot", f"'{name_or_path}' is no robot in space", "name one of family 'spatial'")
    return fit_of(build_robot(document))


def first_task(robot: str, world: str, name: str, overrides: Sequence[str] = ()) -> Json:
    """What a task file says that sends a robot along the guide of a world.

    Args:
        robot: Name or file of a robot in space.
        world: Name or file of a world in space.
        name: What the task is called.
        overrides: Texts "key=value" on keys of the task, such as "rules.need=0.1"; a start or step that they state is kept.

    Returns:
        The task file, its start where the robot has the most in reserve of the places tried.

    Raises:
        SpecError: If it stands nowhere there; the error names the check that forbids most, and how near the nearest hold is.
    """
    robot_document, world_document = read_robot(robot), read_world(world)
    built = build_robot(robot_document)
    reach = float(reaches(built).max())
    height = max(-float(nominal_tips(built)[:, 2].mean()), 0.1 * reach)
    data: Json = {
        "schema": SCHEMA,
        "name": name,
        "title": f"{built.title or built.name} in '{world_document.data.get('name', world)}'",
        "robot": robot,
        "world": world,
        "start": {"height": _mm(rounded(height))},
        "step": {
            "length": _mm(_stepped(STEP * reach)),
            "height": _mm(_stepped(RISE * reach)),
            "angle": TURN,
        },
        "goal": {"along_min": "1 m"},
    }
    changed = apply_overrides(Document(name, data), overrides, (*FILES.task_keys, "robot", "world"), (), {}).data

    def build(document: Json) -> SpatialTask:
        naming = Naming(Document(name, document), frozenset(), [])
        return build_task(naming.merged(robot=robot_document, world=world_document))

    task = build(changed)
    if changed["goal"] == data["goal"]:
        long = GRAIN * (len(task.world.frames) - 1)
        changed["goal"] = {"along_min": f"{math.floor(1e3 * long + 1e-6) / 1e3:g} m"}
        task = build(changed)
    stated = changed["start"].keys() - {"height"}
    tried = [task.start] if stated or changed["start"] != data["start"] else list(_places(task, reach, height))
    start = _best(task, tried)
    if len(tried) > 1:
        changed["start"] = {"along": _mm(start.along), "height": _mm(start.height)}
    return changed


def _places(task: SpatialTask, reach: float, height: float) -> Iterator[Start]:
    for share in HEIGHTS:
        for place in PLACES:
            along, tall = round(place * reach, 3), round(share * height, 3)
            yield replace(task.start, along=along, height=tall)


def _best(task: SpatialTask, tried: Sequence[Start]) -> Start:
    """The start with the most in reserve, rather near the nominal height and the guide's beginning.

    Raises:
        SpecError: If the robot stands at none: of the first, and how many were tried.
    """
    posed = replace(task, step=replace(task.step, heights=0)) if len(tried) > 1 else task
    params = problem_params(task, True)
    reach, usual = float(params.record["reach"]), tried[0].height
    best, most, refused = None, -math.inf, None
    for start in tried:
        at = params.extended({"along": start.along, "height": start.height})
        try:
            stance = find_start(replace(posed, start=start), at)
        except SpecError as error:
            refused = refused or error
            continue
        far = HIGHER * abs(math.log(start.height / usual)) + FARTHER * abs(start.along) / reach
        if float(stance["share"][0]) - far > most:
            best, most = start, float(stance["share"][0]) - far
    if best is None:
        assert refused is not None
        many = f"; {len(tried)} places near the guide's beginning were tried" if len(tried) > 1 else ""
        raise SpecError(refused.file, refused.key, refused.value, f"{refused.allowed}{many}")
    return best


def _stepped(length: float) -> float:
    """A length with one digit that people like to read, 1, 2, 3, 5 or 8 [m]."""
    size = 10.0 ** math.floor(math.log10(length))
    return size * float(min((1.0, 2.0, 3.0, 5.0, 8.0, 10.0), key=lambda digit: abs(math.log(digit * size / length))))


def _mm(value: float) -> str:
    return f"{1e3 * np.round(value, 6) + 0.0:.6g} mm"
