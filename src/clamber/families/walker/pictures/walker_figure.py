"""A two-frame walker in space: frames, legs, actuators and arm, its centre of mass, and the forces of the ground."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from ....types import Floats
from ....viewing import style
from ....viewing.browser.solids import Balls, Sticks, colour
from ..robot import WalkerRobot
from .walk_shapes import WalkShapes

if TYPE_CHECKING:
    import viser

PAINT: Final = (style.PARTS[0], style.PARTS[1])
"""Of the Delta-frame and the Y-frame."""
THICK: Final = 0.028
"""Radius of a frame's bars over that of its circle of feet [-]."""
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


class WalkerFigure:
    """A walker that can be set to any moment; arguments as those of `ClimberFigure`, with the robot for the task."""

    def __init__(self, server: "viser.ViserServer", name: str, robot: WalkerRobot, opacity: float = 1.0) -> None:
        r = THICK * max(robot.legs.radius_delta, robot.legs.radius_y)
        self._size, self._radius = max(robot.legs.radius_delta, robot.legs.radius_y), r
        self.root = server.scene.add_frame(name, show_axes=False)
        first, second, ink, arm = (np.array(colour(shade), np.uint8) for shade in (*PAINT, style.INK, style.QUIET))
        paint = [first] * 3 + [second] * 3 + [ink] * 3 + [first] * 3 + [second] * 3 + [arm] * 2
        sizes = [r] * 6 + [0.5 * r] * 3 + [0.7 * r] * 6 + [0.8 * r] * 2
        self._bars = Sticks(server, f"{name}/bars", np.array(paint), np.array(sizes), opacity)
        pad = max(robot.legs.pad_radius, 1.6 * r)
        joints = [first] * 3 + [second] * 4 + [arm] * 2
        self._joints = Balls(
            server, f"{name}/joints", np.array(joints), np.array([1.3 * r] * 7 + [0.9 * r, 1.4 * r]), opacity
        )
        self._pads = Sticks(server, f"{name}/pads", np.array([first] * 3 + [second] * 3), np.full(6, pad), opacity)
        self._ghost = opacity < 1.0
        self._pad_height = max(0.35 * pad, 0.004)
        self._mass = Balls(
            server,
            f"{name}/centre of mass",
            np.array([colour(style.ALERT)] * 2, np.uint8),
            np.array([r, 0.6 * r]),
            opacity,
        )
        self._plumb = Sticks(
            server, f"{name}/plumb line", np.array([colour(style.ALERT)], np.uint8), np.array([0.15 * r]), opacity
        )
        self._arrows = None if self._ghost else server.scene.add_arrows(
            f"{name}/forces", np.array([[(0.0, 0.0, 0.0), (0.0, 0.0, 1e-3)]]), colour(style.FORCE),
            shaft_radius=0.95 * r, head_radius=1.9 * r, head_length=3.0 * r, visible=False,
        )  # fmt: skip

    def show(self, at: WalkMoment, grade: int = 3) -> None:
        """Put everything where a moment has it; the centre of mass is red where the step is tight or worse."""
        shapes = at.shapes
        delta, star = shapes.frames
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
        if self._arrows is not None:
            self._show_forces(at, soles)

    def hide(self, hidden: bool = True) -> None:
        """Take the figure out of sight, or bring it back."""
        self.root.visible = not hidden

    def remove(self) -> None:
        """Take the figure away for good."""
        self.root.remove()

    def _show_forces(self, at: WalkMoment, soles: Floats) -> None:
        assert self._arrows is not None
        forces = at.forces.reshape(6, 3)
        seen = np.linalg.norm(forces, axis=1) > SMALLEST * at.weight
        self._arrows.visible = bool(seen.any())
        if seen.any():
            scale = LONGEST * self._size / (at.weight / 3.0)
            ways = forces[seen] * scale
            self._arrows.points = np.stack((soles[seen], soles[seen] + ways), axis=1).astype(np.float32)
