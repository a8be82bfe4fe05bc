"""Large boards take a time that grows with their holds, and too large ones are refused with the number."""

import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from clamber.errors import FileError, SpecError
from clamber.families.climber.world.board import MOST_HOLDS, Board, build_board
from clamber.families.climber.world.csv_board import read_points
from clamber.families.walker.planning.walks import read_path
from clamber.files import Document
from clamber.sim.limb_flaws import LimbFlaws
from clamber.sim.plant_rules import PlantError

MOST = 10.0
"""Of processor time [s]: ten times and more of what it takes; what grows with the square of the holds took a minute and more."""


def board(**keys: Any) -> Board:
    return build_board(
        Document("many.toml", {"schema": "clamber-board-1", "name": "many", "hold_radius": "5 mm"} | keys)
    )


def hold(number: int, x: float, y: float, **more: str) -> dict[str, Any]:
    return {"number": number, "x": f"{x} m", "y": f"{y} m"} | more


COLUMN = [hold(i + 1, 0.0, i / 10) for i in range(60_000)]
SIZES = [
    hold(i + 1, 2.0 ** (i % 28) * 3e-3 * (i // 28), 2.0 ** (i % 28), radius=f"{2.0 ** (i % 28) * 1e-3} m")
    for i in range(30_000)
]
BOARDS: dict[str, Callable[[], Board]] = {
    "rungs": lambda: board(ladder={"rungs": 10_000, "spacing": "6 in", "width": "18 in", "removed": list(range(1, 5000))}),
    "grid": lambda: board(grid={"columns": 1000, "rows": 100, "spacing": "6 in"}),
    "column": lambda: board(holds=COLUMN),
    "row of all sizes": lambda: board(holds=SIZES),
}  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("name", BOARDS)
def test_large_boards_are_built_soon(name: str) -> None:
    began = time.process_time()
    assert len(BOARDS[name]().holds) >= 15_000
    assert time.process_time() - began < MOST


@pytest.mark.slow
def test_a_board_with_a_mistake_in_every_hold_is_refused_soon() -> None:
    began = time.process_time()
    with pytest.raises(SpecError, match="is no unit of length") as refused:
        board(holds=[{"number": i + 1, "x": "0 kg", "y": "0 m"} for i in range(60_000)])
    assert time.process_time() - began < MOST
    assert refused.value.others[-1] == "59980 problems more"


def test_too_many_holds_are_refused_with_their_number() -> None:
    with pytest.raises(SpecError, match=f"makes 1000000 holds; at most {MOST_HOLDS}"):
        board(grid={"columns": 1000, "rows": 1000, "spacing": "6 in"})
    with pytest.raises(SpecError, match=r"holds\.1\.x"):
        board(holds=[{"number": 1, "x": "nan m", "y": "0 m"}])
    with pytest.raises(SpecError, match="hold_radius"):
        board(hold_radius="1e-300 m", holds=[hold(1, 0.0, 0.0)])


def test_overlaps_are_found_among_holds_of_any_size() -> None:
    rng = np.random.default_rng(5)
    for _ in range(300):
        x, y, radius = rng.uniform(0.0, 1.0, 12), rng.uniform(0.0, 1.0, 12), 10.0 ** rng.uniform(-3.0, -0.6, 12)
        distance = np.hypot(x[:, None] - x, y[:, None] - y) - (radius[:, None] + radius) + 10.0 * np.eye(12)
        holds = [hold(k + 1, float(x[k]), float(y[k]), radius=f"{radius[k]} m") for k in range(12)]
        if distance.min() < 0.0:
            with pytest.raises(SpecError, match=r"holds (\d+) and (\d+) overlap") as refused:
                board(holds=holds)
            first, second = (int(word) - 1 for word in refused.value.allowed.split() if word.isdecimal())
            assert first < second and distance[first, second] < 0.0
        else:
            assert len(board(holds=holds).holds) == 12


def test_tables_may_end_their_lines_as_they_like_and_cells_have_an_end(tmp_path: Path) -> None:
    table = tmp_path / "table.csv"
    for ending in ("\n", "\r\n", "\r"):
        table.write_bytes(ending.join(("x [m],y [m]", "0,1", "2,3", "")).encode())
        points, places = read_points(table), read_path(table)
        assert (points.places, points.lines) == ((("0", "1"), ("2", "3")), (2, 3))
        assert places == [{"x": "0.0 m", "y": "1.0 m"}, {"x": "2.0 m", "y": "3.0 m"}]
    table.write_text("x [m],y [m]\n0,1\n0," + "9" * 200_000 + "\n")
    for read in (read_points, read_path):
        with pytest.raises(FileError, match=r"table\.csv:3: is not valid CSV .*; a cell has at most 131072 letters"):
            read(table)


@pytest.mark.parametrize(
    "flaws",
    [
        {"delay": 10**9},
        {"encoder_counts": 10**12},
        {"physics_rate": 1e9},
        {"physics_rate": 1e9, "control_rate": 1e9},
        {"seed": 2**63},
    ],
)
def test_plants_that_would_fill_memory_or_never_end_are_refused(flaws: dict[str, Any]) -> None:
    with pytest.raises(PlantError, match=f"plant: {next(iter(flaws))} = |plant: control_rate = "):
        LimbFlaws(**flaws)
