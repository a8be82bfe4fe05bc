"""A ground and a two-frame walker in the viewer's space."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from ....types import Floats
from ....viewing import style
from ....viewing.browser.solids import DISC, Figure, Mesh, colour, prism
from ....viewing.scene import Bounds, goal_box, name_goal
from ..execution.walk_scene import HIGHER, LEVEL, LOWER, THICK
from ..planning.task import Goal
from ..robot import WalkerRobot
from ..world.ground import Ground, Surface
from .walker_motion import COLOURS, WalkShapes

if TYPE_CHECKING:
    import viser

SHADES: Final = ((-1e-6, LOWER), (1e-6, LEVEL), (np.inf, HIGHER))
"""Colour of a brick up to a height of its top above the slope [m]."""
ABOVE: Final = 0.004
"""A way is drawn so far above the ground [m] ..."""
DIP: Final = 0.1
"""... and into ditches by no more than this [m]."""
END: Final = 0.06
"""Radius of the disc at its end [m]."""
GRID: Final = "#A8A294"
CRUST: Final = 0.12
"""How much of the ground is shown below its lowest part [m]."""
LINES: Final = 0.25
"""Between lines on the ground [m]."""


class GroundScene:
    """A ground and goals on it, as they stand.

    Args:
        server: The scene's.
        ground: As it truly is.
        goals: Of a task.
        bounds: The part that is shown, world frame.
        way: Places of a walk's way, shape (n, 2) [m]; None: none is drawn.
    """

    def __init__(
        self,
        server: "viser.ViserServer",
        ground: Ground,
        goals: Sequence[Goal],
        bounds: Bounds,
        way: Floats | None = None,
    ) -> None:
        self._server, self.ground = server, ground
        self.root = server.scene.add_frame("/ground", show_axes=False)
        self._axes, self._surface = ground.axes(), Surface(ground)
        tiles = ground.tiles()
        x0, x1, y0, y1 = bounds
        low, high = np.maximum(tiles[:, [0, 2]], (x0, y0)), np.minimum(tiles[:, [1, 3]], (x1, y1))
        seen = (low < high).all(axis=1)
        bottom = float(tiles[:, 4].min(initial=0.0, where=tiles[:, 4] > -ground.depth)) - CRUST
        groups: dict[str, list[Floats]] = {}
        for (xa, ya), (xb, yb), top in zip(low[seen], high[seen], tiles[seen, 4], strict=True):
            shade = next(shade for most, shade in SHADES if top <= most)
            groups.setdefault(shade, []).append(np.array((xa, xb, ya, yb, top)))
        for k, (shade, bricks) in enumerate(groups.items()):
            self._add(f"bricks {k + 1}", self._placed(_bricks(np.array(bricks), bottom)), shade)
        for k, patch in enumerate(ground.forbidden()):
            self._add(f"forbidden {k + 1}", self._placed(prism(np.array(patch), 0.0, 0.003)), style.ALERT, 0.45)
        self._draw_lines(bounds)
        for k, goal in enumerate(goals):
            self._draw_goal(goals, k, goal_box(goal, bounds))
        if way is not None:
            self._draw_way(way)

    def _add(self, name: str, mesh: Mesh, shade: str, opacity: float | None = None) -> None:
        """A solid of the ground; only one that cannot be seen through casts a shadow."""
        self._server.scene.add_mesh_simple(
            f"/ground/{name}", *mesh, color=colour(shade), opacity=opacity, flat_shading=True, cast_shadow=opacity is None
        )  # fmt: skip

    def _placed(self, mesh: Mesh) -> Mesh:
        return mesh[0] @ self._axes.T, mesh[1]

    def _draw_lines(self, bounds: Bounds) -> None:
        x0, x1, y0, y1 = bounds
        fine = 0.02
        lines = []
        for at in np.arange(np.ceil(x0 / LINES) * LINES, x1, LINES):
            lines.append(np.column_stack((np.full_like(np.arange(y0, y1, fine), at), np.arange(y0, y1, fine))))
        for at in np.arange(np.ceil(y0 / LINES) * LINES, y1, LINES):
            lines.append(np.column_stack((np.arange(x0, x1, fine), np.full_like(np.arange(x0, x1, fine), at))))
        pieces = []
        for line in lines:
            heights = self._surface.heights(line)
            points = np.column_stack((line, heights + 0.0015))
            joined = np.stack((points[:-1], points[1:]), axis=1)
            joined = joined[np.isfinite(joined).all(axis=(1, 2))]  # beyond its ends the ground is infinitely deep
            pieces.append(joined[np.abs(np.diff(joined[:, :, 2], axis=1)[:, 0]) < 0.5 * fine])
        every = np.concatenate(pieces)
        there = every @ self._axes  # in the ground's frame, whose bricks end at the bounds
        every = every[((there[..., :2] >= (x0, y0)) & (there[..., :2] <= (x1, y1))).all(axis=(1, 2))]
        if len(every):
            self._server.scene.add_line_segments("/ground/lines", every, colour(GRID), thickness=0.002)

    def _draw_goal(self, goals: Sequence[Goal], k: int, corners: Floats | None) -> None:
        if corners is None:
            return
        last = k == len(goals) - 1
        lifted = prism(corners, 0.0, 0.002)
        heights = self._surface.heights(corners)
        base = float(heights[np.isfinite(heights)].max(initial=0.0))
        goal = lifted[0] + (0.0, 0.0, base), lifted[1]
        self._add(f"goals/{k + 1}", goal, style.GOAL, 0.4 if last else 0.2)
        self._server.scene.add_label(
            f"/ground/goals/{k + 1}/name", name_goal(goals, k), anchor="bottom-center",
            position=(float(corners[:, 0].mean()), float(corners[:, 1].mean()), base + 0.01),
        )  # fmt: skip

    def _draw_way(self, way: Floats) -> None:
        """A line over the ground along the robot's way, and a disc at its end."""
        heights = self._surface.heights(way)
        heights = np.where(np.isfinite(heights), np.maximum(heights, np.median(heights) - DIP), 0.0)
        points = np.column_stack((way, heights + ABOVE))
        self._server.scene.add_line_segments(
            "/ground/way", np.stack((points[:-1], points[1:]), axis=1), colour(style.GOAL), thickness=0.006
        )
        disc = prism(DISC * END + way[-1], 0.0, 0.002)
        self._add("way/end", (disc[0] + (0.0, 0.0, heights[-1] + ABOVE), disc[1]), style.GOAL, 0.5)

    def remove(self) -> None:
        """Take all of it away."""
        self.root.remove()


def _bricks(bricks: Floats, bottom: float) -> Mesh:
    """Bricks x_min, x_max, y_min, y_max, top, shape (n, 5), as one mesh that reaches down to `bottom`."""
    square = prism(np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]), 0.0, 1.0)
    low = np.column_stack((bricks[:, 0], bricks[:, 2], np.full(len(bricks), bottom)))
    high = np.column_stack((bricks[:, 1], bricks[:, 3], np.maximum(bricks[:, 4], bottom + 1e-3)))
    vertices = low[:, None] + square[0] * (high - low)[:, None]
    faces = square[1] + 8 * np.arange(len(bricks))[:, None, None]
    return vertices.reshape(-1, 3), faces.reshape(-1, 3)


LONGEST: Final = 0.9
"""Length of the arrow of a third of the weight, over the radius of the feet's circle [-]."""
SMALLEST: Final = 0.01
"""Smaller forces, over the weight, are not drawn [-]."""


@dataclass(frozen=True, slots=True, eq=False)
class WalkMoment:
    """A walker at one moment."""

    shapes: WalkShapes
    forces: Floats
    """Of the ground on each foot, world frame, shape (2, 3, 3) [N]; zero where none is known."""
    weight: float
    """Of the robot [N]."""
    poses: Floats
    """x, y [m] and angle [rad] of both frames, seen from above, shape (2, 3)."""
    loads: tuple[Floats, ...]
    """What the bars of each block of the film show; NaN where nothing is told."""
    time: float = 0.0
    """Since the start [s]."""
    tilt: float = 0.0
    """Of the plate from level [rad]."""
    margin: float = np.nan
    """How far the centre of mass is inside the standing feet, from above [m]; NaN where it is not told."""


class WalkerFigure(Figure):
    """A walker."""

    def __init__(self, server: "viser.ViserServer", name: str, robot: WalkerRobot, opacity: float = 1.0) -> None:
        super().__init__(server, name, opacity)
        self._size = max(robot.legs.radius_delta, robot.legs.radius_y)
        r = THICK * self._size
        first, second, ink, arm, red = (colour(shade) for shade in (*COLOURS, style.INK, style.QUIET, style.ALERT))
        paint = [first] * 3 + [second] * 3 + [ink] * 3 + [first] * 3 + [second] * 3 + [arm] * 2
        self._bars = self.sticks("bars", paint, [r] * 6 + [0.5 * r] * 3 + [0.7 * r] * 6 + [0.8 * r] * 2)
        joints = [first] * 3 + [second] * 4 + [arm] * 2
        self._joints = self.balls("joints", joints, [1.3 * r] * 7 + [0.9 * r, 1.4 * r])
        pad = max(robot.legs.pad_radius, 1.6 * r)
        self._pads = self.sticks("pads", [first] * 3 + [second] * 3, [pad] * 6)
        self._pad_height = max(0.35 * pad, 0.004)
        self._mass = self.balls("centre of mass", [red] * 2, [r, 0.6 * r])
        self._plumb = self.sticks("plumb line", [red], [0.15 * r])
        self.make_arrows(0.95 * r, 1.9 * r, 3.0 * r)

    def show(self, at: WalkMoment, grade: int = 3) -> None:
        """Put everything where a moment has it; the centre of mass is red where the step is tight or worse."""
        shapes = at.shapes
        delta, star = shapes.frames
        self.middle = delta[:3].mean(axis=0)
        y = star[[0, 2, 4]]
        middle = star[1]
        ends = np.concatenate([
            np.stack((delta[:-1], delta[1:]), axis=1),
            np.stack((np.tile(middle, (3, 1)), y), axis=1),
            shapes.actuators,
            shapes.legs.reshape(6, 2, 3),
            np.stack((shapes.arm[:-1], shapes.arm[1:]), axis=1),
        ])  # fmt: skip
        self._bars.put(ends)
        self._joints.put(np.concatenate([delta[:3], y, middle[None], shapes.arm[1:]]))
        soles = shapes.legs[:, :, 1].reshape(6, 3)
        up = shapes.legs[:, :, 0].reshape(6, 3) - soles
        up /= np.maximum(np.linalg.norm(up, axis=1, keepdims=True), 1e-9)
        self._pads.put(np.stack((soles, soles + self._pad_height * up), axis=1))
        shade = np.array([colour(style.ALERT if grade < 2 else style.INK)] * 2, np.uint8)
        below = shapes.centre.copy()
        below[2] = np.nanmin(soles[:, 2]) + 0.004
        self._mass.put(np.stack((shapes.centre, below)), shade)
        self._plumb.put(np.stack((shapes.centre, below))[None])
        forces = at.forces.reshape(6, 3)
        seen = np.linalg.norm(forces, axis=1) > SMALLEST * at.weight
        self.show_forces(soles[seen], forces[seen] * (LONGEST * self._size / (at.weight / 3.0)))
