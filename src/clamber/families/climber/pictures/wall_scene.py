"""A wall in space: its surface, the pegs with their numbers, what must not be touched, and the goals."""

from typing import TYPE_CHECKING, Final

import numpy as np

from ....viewing import style
from ....viewing.browser.solids import DISC, Sticks, colour, prism
from ....viewing.scene import Bounds
from ..planning.task import LimbedTask
from ..world.board import Hold
from .climber_figure import link_radius
from .wall import goal_label, goal_outline, hold_radius, spacing
from .wall_space import TURN, in_space

if TYPE_CHECKING:
    import viser

WALL: Final = "#EEF0F3"
PEGS: Final = 9.0
"""How far pegs stand out of the wall, in radii of a link [-]."""
THICK: Final = 0.03
"""Of the wall [m]."""
EDGE: Final = 0.04
"""How much of the wall is shown beyond all that is on it [m]."""
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
        x0, x1, y0, y1 = (edge + side * EDGE for edge, side in zip(bounds, (-1, 1, -1, 1), strict=True))
        corners = np.array([(x0, y0), (x1, y0), (x1, y1), (x0, y1)])
        server.scene.add_mesh_simple(
            "/wall/surface", *prism(corners, -THICK, 0.0), color=colour(WALL), flat_shading=True, wxyz=TURN
        )
        self.depth = PEGS * link_radius(task)
        """How far pegs stand out of the wall [m]."""
        self._least = hold_radius(task, bounds)
        away = min(0.12 * spacing(task), 0.03) if len(task.world.holds) > 1 else 0.02
        self._aside = np.array((-away, away))
        for k, polygon in enumerate(task.world.keep_out):
            server.scene.add_mesh_simple(
                f"/wall/keep out {k + 1}", *prism(np.array(polygon), 0.0, 0.9 * self.depth), color=colour(style.QUIET),
                opacity=0.55, flat_shading=True, wxyz=TURN,
            )  # fmt: skip
        self._draw_goals()
        self._drawn: tuple[Hold, ...] = ()
        self._pegs: Sticks | None = None
        self._numbers: dict[int, viser.LabelHandle] = {}
        self.draw_pegs(task.world.holds)

    def draw_pegs(self, holds: tuple[Hold, ...]) -> None:
        """Draw pegs in place of those that are drawn, whatever they are: also such as make no board."""
        if holds == self._drawn:
            return
        places = np.array([(hold.x, hold.y) for hold in holds]).reshape(-1, 2)
        if self._pegs is not None and len(holds) != len(self._drawn):
            self._pegs.node.remove()
            self._pegs = None
        if self._pegs is None and holds:
            radii = np.array([max(hold.radius, self._least) for hold in holds])
            self._pegs = Sticks(
                self._server, "/wall/pegs", np.array([colour(style.HOLD)] * len(holds), np.uint8), radii
            )
        if self._pegs is not None:
            self._pegs.put(np.stack((in_space(places, 0.0), in_space(places, self.depth)), axis=1))
        self._drawn = holds
        self._draw_numbers(holds)

    def _draw_numbers(self, holds: tuple[Hold, ...]) -> None:
        shown = {hold.number: hold for hold in holds} if len(holds) <= MOST_NUMBERS else {}
        for number in [number for number in self._numbers if number not in shown]:
            self._numbers.pop(number).remove()
        for number, hold in shown.items():
            at = tuple(
                in_space(np.array((hold.x, hold.y)) + self._aside, 0.5 * self.depth)
            )  # far enough out that the wall cuts none
            if number in self._numbers:
                self._numbers[number].position = at
                continue
            self._numbers[number] = self._server.scene.add_label(
                f"/wall/numbers/{number}", str(number), position=at, anchor="center-center", font_screen_scale=0.75, depth_test=True
            )  # fmt: skip

    def _draw_goals(self) -> None:
        """Draw every goal's region, or discs about the pegs and the centre that it names, with its name."""
        for k, goal in enumerate(self.task.goals):
            corners = goal_outline(goal, self.bounds)
            pegs = [self.task.world.by_number(number) for number in goal.holds.values()]
            places = [(peg.x, peg.y) for peg in pegs] + ([] if goal.centre is None else [goal.centre])
            discs = [np.array(place) + DISC * max(3.0 * self._least, 0.012) for place in places]
            last = k == len(self.task.goals) - 1
            depth = 0.004 if last else 0.003
            for part, outline in enumerate([*([] if corners is None else [corners]), *discs]):
                self._server.scene.add_mesh_simple(
                    f"/wall/goals/{k + 1}/{part + 1}", *prism(outline, 0.0, depth), color=colour(style.GOAL),
                    opacity=0.45 if last else 0.22, flat_shading=True, wxyz=TURN, cast_shadow=False,
                )  # fmt: skip
            named = corners if corners is not None else np.array(discs[0]) if discs else None
            if named is not None:
                at = in_space(np.array((named[:, 0].min(), named[:, 1].max())), depth)
                self._server.scene.add_label(
                    f"/wall/goals/{k + 1}/name", goal_label(self.task, k), anchor="bottom-left", position=tuple(at),
                    font_screen_scale=0.9,
                )  # fmt: skip

    def remove(self) -> None:
        """Take all of it away."""
        self.root.remove()
