"""What `clamber new` writes: documents of boards and tasks, made from the command's words."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from ..errors import SpecError, UnitError
from ..families.climber.world.board import Board, build_board
from ..families.climber.world.csv_board import DEFAULT_RADIUS, build_points_board, read_csv_board, read_pixel_board
from ..families.climber.world.random_board import random_board_data
from ..files import Document
from ..json_form import Count
from ..terminal.options import ROBOT
from ..terminal.output import name_of
from ..types import Json
from ..units import parse_quantity

if TYPE_CHECKING:
    from .new import BoardOptions

COMMAND: Final = "clamber new board"


def random_data(words: "BoardOptions") -> Json:
    """The document of a random board.

    Raises:
        SpecError: If an option is none that it may be; the error names it.
    """
    data = random_board_data(
        words.holds,
        quantity("--density", words.density, "number per area", "holds/m^2"),
        words.seed,
        width=None if words.width is None else quantity("--width", words.width, "length"),
        least_gap=None if words.least_gap is None else quantity("--least-gap", words.least_gap, "length"),
        name=name_of(words.board_file),
    )
    if not words.listed:
        return data
    places = _board(data).positions().tolist()
    rows = [{"number": i, "x": f"{x!r} m", "y": f"{y!r} m"} for i, (x, y) in enumerate(places, start=1)]
    return {**{key: value for key, value in data.items() if key != "random"}, "holds": rows}


def points_data(words: "BoardOptions") -> Json:
    """The document of a board from a table of lengths, or from one of pixels; what is wrong with a hold is told by its line.

    Raises:
        FileError: If a line is no hold.
        SpecError: If an option is none that it may be; the error names it.
    """
    size = DEFAULT_RADIUS if words.radius is None else f"{quantity('--radius', words.radius, 'length'):.9g} m"
    if words.csv is not None:
        source, document = words.csv, read_csv_board(words.csv, words.unit, size)
    else:
        assert words.pixels is not None and words.scale is not None
        metres = quantity("--scale", words.scale, "length")
        if not metres > 0.0:
            raise SpecError(COMMAND, "--scale", words.scale, "must be more than 0 m")
        origin = None if words.origin is None else _pixel(words.origin)
        source, document = words.pixels, read_pixel_board(words.pixels, metres, origin, size)
    build_points_board(document, source)
    return document.data | {"name": name_of(words.board_file)}


def _pixel(text: str) -> tuple[float, float]:
    try:
        x, y = map(float, text.split(","))
    except ValueError:
        x = y = math.nan
    if not (math.isfinite(x) and math.isfinite(y)):
        raise SpecError(COMMAND, "--origin", text, "must be two numbers of pixels, such as 120,840")
    return x, y


def task_data(board: Json, label: str, path: Path, overrides: Sequence[str], robot: str = ROBOT) -> Json:
    """The document of a task on a board, from the lowest stance to the top; it names the board by a file beside it.

    Args:
        board: The board's document.
        label: What errors call it: the path of its file.
        path: Of the task's file.
        overrides: Texts "key=value" on keys of the task, or `robot=...`.
        robot: Name or file of a limbed robot.

    Raises:
        SpecError: If the board has no stance that the rules allow.
    """
    from ..families.climber.planning.random_task import climb_data

    data, _ = climb_data(board, label, name=name_of(path), robot=robot, overrides=overrides, to_edit=True)
    words = list(data.items())
    return dict([*words[:4], ("board", Path(label).name), *words[4:]])


@dataclass(frozen=True, slots=True, kw_only=True)
class NewBoard:
    """A board that was written."""

    written: dict[str, str]
    """board, and with --task the task, to the file."""
    name: str
    holds: Count
    width_m: float
    height_m: float
    gap_m: float | None
    """Least distance of two holds."""


def describe_board(board: Json, written: dict[str, str]) -> NewBoard:
    """What the command prints about a board and the files of it; building it checks it."""
    built = _board(board)
    points = built.positions()
    width, height = (points.max(axis=0) - points.min(axis=0)).tolist()
    from scipy.spatial import cKDTree

    gap = float(cKDTree(points).query(points, k=2)[0][:, 1].min()) if len(points) > 1 else None
    return NewBoard(written=written, name=built.name, holds=len(points), width_m=width, height_m=height, gap_m=gap)


def _board(data: Json) -> Board:
    return build_board(Document(COMMAND, data))


def quantity(option: str, text: str, dimension: str, unit: str = "") -> float:
    """The SI value of an option; a bare number counts in `unit`, if there is one.

    Raises:
        SpecError: If it is no such quantity; the error names the option.
    """
    try:
        bare: Any = float(text) if unit else None
    except ValueError:
        bare = None
    try:
        value = parse_quantity(text if bare is None else f"{text} {unit}", dimension)
    except UnitError as error:
        raise SpecError(COMMAND, option, text, f"{error.problem}; {error.allowed}") from None
    return value
