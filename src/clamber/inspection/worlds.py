"""What is odd about a board or a ground."""

from collections.abc import Iterator
from itertools import pairwise
from typing import Final

import numpy as np
import numpy.typing as npt

from ..types import Floats
from ..worlds.board import Board
from ..worlds.ground import Ground
from .finding import Finding

ALONE: Final = 3.0
"""A hold this many times farther from its nearest than holds usually are is alone [-]."""
NAMED: Final = 5
"""So many holds are named, the others counted."""


def inspect_board(board: Board) -> Finding:
    """Facts of a board, and what is odd about it."""
    points = board.positions()
    width, height = np.ptp(points, axis=0)
    away = nearest(points)
    directed = sum(hold.direction is not None for hold in board.holds)
    facts = {
        "holds": str(len(points)),
        "numbers": f"{board.holds[0].number} to {board.holds[-1].number}",
        "size": f"{width:.4g} x {height:.4g} m, from ({points[:, 0].min():.4g}, {points[:, 1].min():.4g}) m",
        "with a direction": str(directed),
        "keep-out regions": str(len(board.keep_out)),
    }
    if len(points) > 1:
        facts["nearest two"] = f"{away.min():.4g} m"
    odd = (*_lonely(board, away), *_covered(board, points))
    return Finding(kind="board", name=board.name, title=board.title, facts=facts, odd=odd)


def nearest(points: Floats) -> Floats:
    """Distance of each of the points, shape (n, 2), from the one nearest to it [m], shape (n,); infinite for a single one."""
    from scipy.spatial import cKDTree  # takes a tenth of a second to import

    if len(points) < 2:
        return np.full(len(points), np.inf)
    away: Floats = cKDTree(points).query(points, k=2)[0][:, 1]
    return away


def _lonely(board: Board, away: Floats) -> Iterator[str]:
    if len(away) < 3:
        return
    usual = float(np.median(away))
    alone = [hold.number for hold, distance in zip(board.holds, away, strict=True) if distance > ALONE * usual]
    if alone:
        farthest = float(away.max())
        yield (
            f"{_holds(alone)} far from all others, {farthest:.3g} m where holds usually are {usual:.3g} m apart; "
            "is a unit or a decimal point wrong?"
        )


def _covered(board: Board, points: Floats) -> Iterator[str]:
    for index, polygon in enumerate(board.keep_out):
        inside = _inside(points, np.array(polygon))
        covered = [hold.number for hold, hidden in zip(board.holds, inside, strict=True) if hidden]
        if covered:
            yield f"{_holds(covered)} inside keep_out.{index}: no limb can take them"


def _inside(points: Floats, polygon: Floats) -> npt.NDArray[np.bool_]:
    """Whether points lie inside a polygon, by the number of its sides to their right, shape (n,)."""
    inside = np.zeros(len(points), bool)
    for (x0, y0), (x1, y1) in pairwise([*polygon, polygon[0]]):
        spans = (y0 > points[:, 1]) != (y1 > points[:, 1])
        with np.errstate(divide="ignore", invalid="ignore"):
            crossing = x0 + (points[:, 1] - y0) * (x1 - x0) / (y1 - y0)
        inside ^= spans & (points[:, 0] < crossing)
    return inside


def _holds(numbers: list[int]) -> str:
    shown = ", ".join(map(str, numbers[:NAMED])) + (", ..." if len(numbers) > NAMED else "")
    return f"hold {shown} lies" if len(numbers) == 1 else f"{len(numbers)} holds ({shown}) lie"


def inspect_ground(ground: Ground) -> Finding:
    """Facts of a ground, and what is odd about it."""
    facts = {
        "slope": f"{np.degrees(ground.slope):.4g} deg, rising towards {np.degrees(ground.uphill):.4g} deg",
        "size": f"{ground.x_max - ground.x_min:.4g} x {ground.y_max - ground.y_min:.4g} m",
        "friction": f"{ground.friction:.3g}",
        "blocks": str(len(ground.blocks)),
        "rough parts": str(len(ground.rough)),
        "forbidden patches": str(len(ground.patches)),
    }
    return Finding(kind="ground", name=ground.name, title=ground.title, facts=facts, odd=tuple(_odd_ground(ground)))


def _odd_ground(ground: Ground) -> Iterator[str]:
    if np.tan(ground.slope) > ground.friction:
        yield (
            f"the slope is steeper than friction holds: feet slide on it above {np.degrees(np.arctan(ground.friction)):.3g} deg"
        )
    for key, corners in (
        *((f"blocks.{i}", block.corners()) for i, block in enumerate(ground.blocks)),
        *((f"rough.{i}", rough.corners()) for i, rough in enumerate(ground.rough)),
        *((f"patches.{i}", patch) for i, patch in enumerate(ground.forbidden())),
    ):
        xs, ys = np.array(corners).T
        beyond = (
            xs.max() <= ground.x_min or xs.min() >= ground.x_max or ys.max() <= ground.y_min or ys.min() >= ground.y_max
        )
        if beyond:
            yield f"{key} lies beyond the ends of the ground, where there is nothing"
