"""What `clamber new` writes: documents of boards and tasks, made from the command's words."""

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from ..errors import SpecError, UnitError
from ..files import Document
from ..types import Json
from ..units import parse_quantity
from ..worlds.board import Board, build_board
from ..worlds.random_board import random_board_data


def board_data(
    holds: int,
    density: str,
    width: str | None,
    least_gap: str | None,
    seed: int,
    path: Path,
    *,
    listed: bool,
) -> Json:
    """The document of a random board.

    Raises:
        SpecError: If an option is none that it may be; the error names it.
    """
    data = random_board_data(
        holds,
        _quantity("--density", density, "number per area", "holds/m^2"),
        seed,
        width=None if width is None else _quantity("--width", width, "length"),
        least_gap=None if least_gap is None else _quantity("--least-gap", least_gap, "length"),
        name=name_of(path),
    )
    if not listed:
        return data
    places = _board(data).positions().tolist()
    rows = [{"number": i, "x": f"{x!r} m", "y": f"{y!r} m"} for i, (x, y) in enumerate(places, start=1)]
    return {**{key: value for key, value in data.items() if key != "random"}, "holds": rows}


def task_data(board: Json, board_file: Path, path: Path, overrides: Sequence[str]) -> Json:
    """The document of a task on a board that lies beside it."""
    from ..actions.random_task import climb_data

    data, _ = climb_data(board, str(board_file), name=name_of(path), overrides=overrides)
    words = list(data.items())
    return dict([*words[:4], ("board", board_file.name), *words[4:]])


def wall_facts(board: Json, path: Path) -> Json:
    """What the command tells about a board; building it checks it."""
    built = _board(board)
    points = built.positions()
    width, height = (points.max(axis=0) - points.min(axis=0)).tolist()
    from scipy.spatial import cKDTree

    gap = float(cKDTree(points).query(points, k=2)[0][:, 1].min()) if len(points) > 1 else None
    return {"holds": len(points), "width_m": width, "height_m": height, "gap_m": gap}


def name_of(path: Path) -> str:
    """A name for what a file describes, from the file's."""
    stem = re.sub(r"[^A-Za-z0-9_-]", "-", path.stem)[:60]
    return stem if stem[:1].isalpha() else f"wall-{stem}"


def _board(data: Json) -> Board:
    return build_board(Document("clamber new board", data))


def _quantity(option: str, text: str, dimension: str, unit: str = "") -> float:
    try:
        bare: Any = float(text) if unit else None
    except ValueError:
        bare = None
    try:
        value = parse_quantity(text if bare is None else f"{text} {unit}", dimension)
    except UnitError as error:
        raise SpecError("clamber new board", option, text, f"{error.problem}; {error.allowed}") from None
    return value
