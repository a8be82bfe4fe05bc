"""A wall in space: its surface, the pegs with their numbers, what must not be touched, and the goals."""

from typing import TYPE_CHECKING, Final

import numpy as np

from ...tasks.limbed import LimbedTask
from .. import style
from ..scene import Bounds
from ..wall import goal_label, goal_outline, hold_radius, spacing
from .climber_figure import link_radius
from .solids import Sticks, colour, prism
from .wall_space import TURN, in_space

if TYPE_CHECKING:
    import viser

WALL: Final = "#EEF0F3"
PEGS: Final = 9.0
"""How far pegs stand out of the wall, in radii of a link [-]."""
THICK: Final = 0.03
"""Of the wall [m]."""
MOST_NUMBERS: Final = 80
"""With more pegs than this only a few numbers could be read, and none is drawn."""


class WallScene:
    """A board and the goals of a task on it, as they stand.

    Args:
        server: The scene's.
        task: Board and goals.
        bounds: The part of the wall that is shown.
    """

    def __init__(self, server: "viser.ViserServer", task: LimbedTask, bounds: Bounds) -> None:
        self._server, self.task, self.bounds = server, task, bounds
        self.root = server.scene.add_frame("/wall", show_axes=False)
        x0, x1, y0, y1 = bounds
        corners = np.array([(x0, y0), (x1, y0), (x1, y1), (x0, y1)])
        server.scene.add_mesh_simple(
            "/wall/surface", *prism(corners, -THICK, 0.0), color=colour(WALL), flat_shading=True, wxyz=TURN
        )
        self._depth = PEGS * link_radius(task)
        for k, polygon in enumerate(task.world.keep_out):
            server.scene.add_mesh_simple(
                f"/wall/keep out {k + 1}", *prism(np.array(polygon), 0.0, 0.9 * self._depth), color=colour(style.QUIET),
                opacity=0.55, flat_shading=True, wxyz=TURN,
            )  # fmt: skip
        self._draw_goals()
        self.pegs = self._draw_pegs()

    def _draw_pegs(self) -> Sticks:
        holds, places = self.task.world.holds, self.task.world.positions()
        least = hold_radius(self.task, self.bounds)
        radii = np.array([max(hold.radius, least) for hold in holds])
        shades = np.array([colour(style.HOLD)] * len(holds), np.uint8)
        pegs = Sticks(self._server, "/wall/pegs", shades, radii)
        pegs.put(np.stack((in_space(places, 0.0), in_space(places, self._depth)), axis=1))
        if len(holds) <= MOST_NUMBERS:
            away = min(0.12 * spacing(self.task), 0.03) if len(holds) > 1 else 0.02
            aside = np.array((-away, away))
            for hold, place in zip(holds, places, strict=True):
                at = in_space(place + aside, 0.002)
                self._server.scene.add_label(
                    f"/wall/numbers/{hold.number}", str(hold.number), position=tuple(at), anchor="center-center",
                    font_screen_scale=0.75, depth_test=True,
                )  # fmt: skip
        return pegs

    def _draw_goals(self) -> None:
        for k, goal in enumerate(self.task.goals):
            corners = goal_outline(goal, self.bounds)
            last = k == len(self.task.goals) - 1
            if corners is None:
                continue
            depth = 0.004 if last else 0.003
            self._server.scene.add_mesh_simple(
                f"/wall/goals/{k + 1}", *prism(corners, 0.0, depth), color=colour(style.GOAL), opacity=0.45 if last else 0.22,
                flat_shading=True, wxyz=TURN, cast_shadow=False,
            )  # fmt: skip
            at = np.array((corners[:, 0].min(), corners[:, 1].max()))
            self._server.scene.add_label(
                f"/wall/goals/{k + 1}/name", goal_label(self.task, k), anchor="bottom-left",
                position=(float(at[0]), float(at[1]), depth), font_screen_scale=0.9,
            )  # fmt: skip

    def remove(self) -> None:
        """Take all of it away."""
        self.root.remove()
