"""A two-frame walker with its arm as lines, in space or seen from the side."""

from collections.abc import Iterator
from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes

from ....types import Floats
from ....viewing import style
from ..control.cooperative.planted import heading_of, turn_of
from ..control.cooperative.planted_feet import PlantedFeet
from ..robot.weight import arm_places

ARM: Final = style.PARTS[1]
DELTA: Final = style.INK
Y: Final = style.PARTS[2]


def draw_robot(space: Any, footing: PlantedFeet, q: Floats, alpha: float) -> None:
    """Draw frames, standing legs and arm.

    Args:
        space: 3-D axes.
        footing: What it stands on.
        q: Freedoms of body and arm, shape (6 + joints,).
        alpha: Opacity.
    """
    for points, colour, width in robot_lines(footing, q):
        space.plot(*points.T, color=colour, lw=width, alpha=alpha, solid_capstyle="round")


def draw_from_side(axes: Axes, footing: PlantedFeet, q: Floats, alpha: float) -> None:
    """Draw the same as seen along y: x and z [m]."""
    for points, colour, width in robot_lines(footing, q):
        axes.plot(points[:, 0], points[:, 2], color=colour, lw=width, alpha=alpha, solid_capstyle="round")


def robot_lines(footing: PlantedFeet, q: Floats) -> Iterator[tuple[Floats, str, float]]:
    """Points, shape (n, 3) [m], colour and width of the lines of frames, standing legs and arm."""
    robot, turn, origin = footing.robot, turn_of(q[3:6]), q[:3]
    feet = footing.feet_on_ground()
    offset, twist = np.array(footing.offset), footing.twist
    if footing.support == "y":
        offset = (turn.T @ (feet[1].mean(axis=0) - origin))[:2]
        twist += heading_of(footing.pose[3:6]) - heading_of(q[3:6])
    c, s = np.cos(twist), np.sin(twist)
    plate = robot.feet()
    plate[1] = plate[1] @ np.array([[c, s], [-s, c]]) + offset
    over = plate @ turn[:, :2].T + origin
    for frame, colour in enumerate((DELTA, Y)):
        yield np.vstack([over[frame], over[frame][:1]]) if frame == 0 else _spokes(over[1]), colour, 2.0
        if frame in footing.standing():
            for top, foot in zip(over[frame], feet[frame], strict=True):
                yield np.array([top, foot]), colour, 1.4
    assert robot.arm is not None, "only robots with an arm follow paths"
    arm = np.vstack([np.zeros(3), [0.0, 0.0, robot.arm.up], arm_places(robot.arm, q[6:].tolist())])
    yield arm @ turn.T + origin, ARM, 2.6


def set_space(space: Any) -> None:
    """Equal scales, named axes and a view from the side."""
    space.set_aspect("equal")
    for name in "xyz":
        getattr(space, f"set_{name}label")(f"{name} [m]")
        getattr(space, f"{name}axis").pane.set_facecolor(style.WALL)
    space.view_init(elev=18, azim=-62)
    space.locator_params(nbins=5)


def _spokes(tips: Floats) -> Floats:
    """The Y-frame as one line from its middle out to each tip and back."""
    middle = tips.mean(axis=0)
    return np.array([tips[0], middle, tips[1], middle, tips[2]])
