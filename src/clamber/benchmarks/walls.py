"""What a larger board costs: time per expanded stance, time to load, memory, on random walls of equal density."""

import time
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Final

import numpy as np

from ..families.climber.planning.inventory import make_inventory
from ..families.climber.planning.problem import LimbedProblem
from ..families.climber.planning.random_task import climb_data, random_task
from ..families.climber.statics.elbows import EVERY
from ..families.climber.statics.records import STANCE
from ..families.climber.world.random_board import random_board_data
from ..files import write_atomically
from ..planning.problem.check import TICKS
from ..planning.problem.codes import pack
from ..planning.problem.loops import expand, replay
from ..planning.problem.problem import Records
from ..planning.problem.problems import pose_problem
from ..tasks import load_task
from ..toml_text import toml_text
from ..trials.measured import Row, Say, keep_quiet
from .speed import best_times

SIZES: Final = (100, 1000, 10_000)
"""Holds; each is measured beside a wall of twice as many."""
DENSITY: Final = 20.0
"""Holds per area [1/m^2]: about six in reach of a limb of LIBRA."""
STANCES: Final = 2000
"""Stances that are expanded on the walls of one size together."""
WALLS: Final = 20
"""Most walls of one size: small ones are many, so that all sizes see about as many different places."""
MARGIN: Final = 0.7
"""Stances lie so far from the edges [m], where as many holds are in sight as anywhere."""
REPEATS: Final = 25


@dataclass(frozen=True, slots=True)
class Walled:
    """Stances on one wall, ready to be expanded."""

    problem: LimbedProblem
    stances: Records

    def expand(self) -> int:
        """Expand every stance once; returns the number of children."""
        most = self.problem.branching
        children = np.zeros(2 * most, STANCE)
        parent, code, codes = np.zeros(2 * most, np.int32), np.zeros(2 * most, np.int32), np.zeros(most, np.int32)
        margins = np.zeros(len(self.problem.checks))
        first = total = 0
        while first < len(self.stances):
            which, scratch = (first, len(self.stances)), (codes, margins)
            n, first = expand(self.problem.params.record, self.stances, which, scratch, children, parent, code)
            total += n
        return total


def wall_rows(
    *,
    sizes: tuple[int, ...] = SIZES,
    stances: int = STANCES,
    repeats: int = REPEATS,
    say: Say = keep_quiet,
) -> list[Row]:
    """Time per expansion at each size and at its double, how it grows, and what loading and holding the largest takes."""
    grown = sorted({size * factor for size in sizes for factor in (1, 2)})
    walls = {}
    for size in grown:
        say(f"stances on walls of {size} holds")
        walls[size] = _walls(size, stances)
    counts = {size: sum(len(wall.stances) for wall in walls[size]) for size in grown}
    say("time per expansion")
    works = [partial(_expand_all, walls[size]) for size in grown]
    children = {size: work() for size, work in zip(grown, works, strict=True)}
    times = dict(zip(grown, best_times(works, repeats), strict=True))
    each = {size: times[size].cpu / counts[size] for size in grown}
    rows = []
    for size in grown:
        about = f"{size} holds, {DENSITY:g} per m^2"
        rows.append(Row(f"time per expansion, CPU, {about}", each[size] * 1e6, "us"))
        rows.append(Row(f"valid children per expansion, {about}", children[size] / counts[size], "stances"))
    for size in sizes:
        name = f"time per expansion, {2 * size} holds to {size} at equal density"
        rows.append(Row(name, each[2 * size] / each[size], "ratio", "< 1.10"))
    for size in sizes:
        say(f"loading {size} holds")
        rows += _loading_rows(size)
    return rows


def _walls(size: int, stances: int) -> list[Walled]:
    walls = max(1, min(WALLS, WALLS * SIZES[0] // size))
    made = []
    for seed in range(walls):
        task = random_task(size, DENSITY, seed)
        problem = LimbedProblem(task, make_inventory(task).table(), threads=1)
        made.append(Walled(problem, sampled_stances(problem, stances // walls, seed)))
    return made


def _expand_all(walls: list[Walled]) -> int:
    return sum(wall.expand() for wall in walls)


def sampled_stances(problem: LimbedProblem, count: int, seed: int) -> Records:
    """Valid stances all over a wall: places of the lattice drawn evenly, each limb on a hold drawn from those in reach.

    Args:
        problem: A task on the wall.
        count: How many.
        seed: Of the draws.
    """
    from scipy.spatial import cKDTree

    task, draw = problem.task, np.random.default_rng(seed)
    points = task.world.positions()
    tree = cKDTree(points)
    low, high = points.min(axis=0) + MARGIN, points.max(axis=0) - MARGIN
    found = np.zeros(count, STANCE)
    after, margins, reasons = np.zeros(2, STANCE), np.zeros((1, len(problem.checks))), np.zeros(1, np.int32)
    none = np.array([pack(0)], np.int32)
    made = 0
    while made < count:
        place = low + draw.random(2) * (high - low)
        cells = np.round((place - (task.start.x, task.start.y)) / task.step.length).astype(np.int64)
        x, y = cells * task.step.length + (task.start.x, task.start.y)
        start = np.zeros(1, STANCE)
        start["ix"], start["iy"] = cells * TICKS
        start["hold"] = start["left"] = start["resolved"] = -1
        start["elbows"], start["in_use"] = EVERY, int(draw.integers(len(task.robot.limbs)))
        for i, limb in enumerate(task.robot.limbs):
            near = tree.query_ball_point((x + limb.port_x, y + limb.port_y), limb.length)
            near = sorted(set(near) - set(start["hold"][0].tolist()))
            start["hold"][0, i] = draw.choice(near) if near else -1
        replay(problem.params.record, start, none, True, after, margins, reasons)
        if reasons[0] < 0 and (start["hold"] >= 0).sum() >= 2:
            found[made] = after[1]
            made += 1
    return found


def _loading_rows(size: int) -> list[Row]:
    """Time to read a task and pose it, with the holds scattered or listed, and the memory that its kernels read."""
    rows = []
    board = random_board_data(size, DENSITY)
    points = random_task(size, DENSITY).world.positions().tolist()
    listed = [{"number": i, "x": f"{x!r} m", "y": f"{y!r} m"} for i, (x, y) in enumerate(points, start=1)]
    by_hand = {key: value for key, value in board.items() if key != "random"} | {"holds": listed}
    with TemporaryDirectory() as folder:
        data, _ = climb_data(board, "random board", name="wall")
        for how, written in (("scattered", board), ("listed", by_hand)):
            write_atomically(Path(folder) / "board.toml", toml_text(written))
            write_atomically(Path(folder) / f"{how}.toml", toml_text({**data, "board": "board.toml"}))
            started = time.perf_counter()
            problem = pose_problem(load_task(str(Path(folder) / f"{how}.toml")), threads=1).problem
            took = time.perf_counter() - started
            aim = "< 2" if size == max(SIZES) else None
            rows.append(Row(f"loading and posing, {size} holds, {how}", took, "s", aim))
    names = ("limbs", "holds", "cells", "cell_start")
    held = sum(problem.params.array(name).nbytes for name in names)
    return [*rows, Row(f"memory that the kernels read, {size} holds", held / 1e6, "MB")]
