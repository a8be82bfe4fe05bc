"""How long the walker's geometry takes: exact regions and steps, the pose behind lengths, ditches."""

from collections.abc import Callable
from functools import partial
from typing import Final

import numpy as np

from ..families.walker.robot import TwoFrames, WalkerRobot
from ..families.walker.robot.arcs import COLUMNS, MOST_ARCS, ROOM, outline, ray
from ..families.walker.robot.curves import CURVE_NUMBERS, MOST_CURVES, reach_curves
from ..families.walker.robot.ditch import Footing, ditch_map
from ..families.walker.robot.two_frames import follow_branch
from ..families.walker.robot.workspace import stride, workspace
from ..types import Floats
from .control_speed import round_times
from .rows import Row, Say, keep_quiet

ROUNDS: Final = 15
REPEATS: Final = 200
"""Of a piece of work in one timing."""


def region_rows(robot: WalkerRobot, *, rounds: int = ROUNDS, say: Say = keep_quiet) -> list[Row]:
    """Times of what a planner or controller asks of the mechanism, at many angles."""
    say("regions of the two frames")
    frames = TwoFrames.of(robot.mechanism)
    thetas = np.linspace(-0.3, 0.8, REPEATS)
    footing = Footing.of(robot)
    directions = np.linspace(0.0, np.pi / 3.0, 10)
    works: list[Callable[[], object]] = [
        partial(_regions_and_strides, frames, thetas),
        partial(_compiled_regions, frames, thetas),
        partial(_poses, frames, 1e-3),
        partial(_poses, frames, 5e-2),
        partial(ditch_map, footing, thetas, directions),
    ]
    whole, bare, near, far, ditches = np.median(round_times(works, rounds), axis=0) / REPEATS
    return [
        Row("exact region, its parts and areas, and a step, at one angle", 1e3 * whole, "ms", "< 1"),
        Row("the same within a kernel: arcs, areas, step", 1e6 * bare, "us"),
        Row("pose behind lengths, followed over 1 mm", 1e6 * near, "us"),
        Row("pose behind lengths, followed over 50 mm", 1e6 * far, "us"),
        Row("widest ditch at one angle and direction", 1e6 * ditches / len(directions), "us"),
    ]


def _regions_and_strides(frames: TwoFrames, thetas: Floats) -> None:
    for theta in thetas:
        workspace(frames, float(theta), guard=frames.guard)
        stride(frames, float(theta), 0.5, guard=frames.guard)


def _compiled_regions(frames: TwoFrames, thetas: Floats) -> None:
    curves, arcs = np.zeros((MOST_CURVES, CURVE_NUMBERS)), np.empty((MOST_ARCS, COLUMNS))
    areas, owners, room = np.empty(MOST_ARCS), np.empty(MOST_ARCS, np.int64), np.empty(ROOM)
    for theta in thetas:
        n = reach_curves(frames.delta, frames.y, theta, frames.shortest, frames.longest, frames.guard, curves)
        outline(curves, n, arcs, areas, owners, room)
        ray(curves, n, 0.0, 0.0, 1.0, 0.0)
        ray(curves, n, 0.0, 0.0, -1.0, 0.0)


def _poses(frames: TwoFrames, off: float) -> None:
    aim, room = frames.lengths((off, 0.5 * off, off)), np.empty((9, 3))
    for _ in range(REPEATS):
        follow_branch(frames.delta, frames.y, aim, np.zeros(3), room)
