"""A wall and a climber in the viewer's space: x to the right, y up, and depth out of the wall towards the viewer."""

import math
from typing import TYPE_CHECKING, Final

import numpy as np

from ....types import Floats
from ....viewing import style
from ....viewing.browser.solids import DISC, Figure, Sticks, colour, prism
from ....viewing.scene import Bounds
from ..planning.task import LimbedTask
from ..world.board import Hold
from .artists import (
    SMALLEST_FORCE,
    Snapshot,
    force_scale,
    goal_label,
    goal_outline,
    hold_radius,
    spacing,
    torque_limits,
)
from .geometry import Posture, body_outline, end_effector

if TYPE_CHECKING:
    import viser

TURN: Final = (math.sqrt(0.5), math.sqrt(0.5), 0.0, 0.0)
"""Quaternion w, x, y, z that lifts what lies in the plane z = 0 onto the wall: its z points out of it."""


def in_space(points: Floats, depth: Floats | float) -> Floats:
    """Points of the wall, shape (..., 2) [m], some way in front of it [m]: shape (..., 3)."""
    deep = np.broadcast_to(-np.asarray(depth, dtype=np.float64), points.shape[:-1])
    return np.stack((points[..., 0], deep, points[..., 1]), axis=-1)


def on_wall(point: Floats) -> tuple[float, float]:
    """Where on the wall a point in space is, x and y, shape (3,) [m]."""
    return float(point[0]), float(point[2])


def turned(angle: float) -> tuple[float, float, float, float]:
    """Quaternion w, x, y, z of a body that is turned on the wall [rad], anticlockwise, and stands out of it."""
    c, s = math.cos(0.5 * angle), math.sin(0.5 * angle)
    w, x = TURN[0], TURN[1]
    return w * c, x * c, -x * s, w * s


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
        away = min(0.12 * spacing(task), 0.03)
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


LIMBS: Final = 5.0
"""How far in front of the wall the limbs are, in radii of a link [-]."""
BODY: Final = (2.2, 5.4)
"""Where the body begins and ends, likewise [-]."""
GRIP_POINTS: Final = 12
"""Corners of the line that an end effector is drawn as."""
GRADES: Final = (style.ALERT, "#F2A65A", "#9FADBA", "#9FADBA")
"""Colour of the body by the smallest margin of its stance (`margins.grade`)."""
HEAT: Final = ((0.0, "#1E8A4C"), (0.5, "#C9A800"), (0.8, "#E06A10"), (0.95, style.ALERT))
"""Colour of a joint from a share of its torque limit on."""


def link_radius(task: LimbedTask) -> float:
    """Radius with which links are drawn [m]."""
    return max(task.robot.link_radius, 0.004)


class ClimberFigure(Figure):
    """A climber; `task` has its robot, and the board whose holds it is on."""

    def __init__(self, server: "viser.ViserServer", name: str, task: LimbedTask, opacity: float = 1.0) -> None:
        super().__init__(server, name, opacity)
        self._task, robot, r = task, task.robot, link_radius(task)
        self._radius = r
        self._depths = r * (LIMBS + 0.5 * (np.arange(len(robot.limbs)) % 2))
        self._limits = torque_limits(task).ravel()
        outline = body_outline(robot)
        corners = np.stack((outline.real, outline.imag), axis=-1)
        self._body = self.rigid("body", prism(corners, BODY[0] * r, BODY[1] * r), colour(GRADES[3]), flat=True)
        self._top = 0.25 * float(np.ptp(corners, axis=0).min())
        self._up = self.sticks("up", [colour(style.INK)], [0.22 * r])
        paint = [colour(style.PARTS[i % len(style.PARTS)]) for i in range(len(robot.limbs))]
        # of each limb: both links, the way from the second to the tip, and the end effector
        sizes = [r, 0.8 * r, 0.3 * r, *([0.3 * r] * GRIP_POINTS)]
        self._links = self.sticks("links", [one for one in paint for _ in sizes], sizes * len(paint))
        joints = [one for one in paint for _ in range(3)]
        self._joint_colours = np.array(joints, np.uint8)
        self._joints = self.balls("joints", joints, [1.35 * r, 1.2 * r, 0.8 * r] * len(paint))
        self._heat = [(share, np.array(colour(shade), np.uint8)) for share, shade in HEAT]
        self.make_arrows(0.42 * r, 1.0 * r, 2.4 * r)

    def show(self, at: Snapshot, grade: int = 3) -> None:
        """Put everything where a moment has it; the body takes the colour of a grade."""
        posture = at.posture
        centre = np.array((posture.x, posture.y))
        self.middle = in_space(centre, BODY[1] * self._radius)
        self._body.put(in_space(centre, 0.0), turned(posture.angle))
        above = centre + self._top * np.array((-math.sin(posture.angle), math.cos(posture.angle)))
        self._up.put(in_space(np.stack((centre, above)), BODY[1] * self._radius)[None])
        if not self._ghost:
            self._body.paint(np.array([colour(GRADES[grade])], np.uint8))
        chains = self._chains(posture)
        self._links.put(np.concatenate([self._limb_sticks(i, chains[i], posture) for i in range(len(chains))]))
        self._joints.put(chains[:, :3].reshape(-1, 3), None if self._ghost else self._hot(at.torques))
        seen = np.hypot(*at.forces.T) > SMALLEST_FORCE * self._task.robot.weight
        seen &= np.array([held >= 0 for held in posture.held]) & np.isfinite(at.forces).all(axis=1)
        starts = chains[seen, 3] + (0.0, -3.0 * self._radius, 0.0)
        self.show_forces(starts, in_space(at.forces[seen] * force_scale(self._task), 0.0))

    def _chains(self, posture: Posture) -> Floats:
        """Port, elbow, end of the second link and tip of each limb in space, shape (n_limbs, 4, 3).

        Where an elbow passes from one side to the other its links look shorter on the wall: in space it turns out of it.
        """
        robot = self._task.robot
        depths = np.repeat(self._depths[:, None], 4, axis=1)
        for i, limb in enumerate(robot.limbs):
            seen = float(np.hypot(*(posture.chains[i, 1] - posture.chains[i, 0])))
            out = np.sqrt(max(limb.l1**2 - seen**2, 0.0))
            if out > 1e-3 * limb.l1:
                depths[i, 1] += out
                depths[i, 2] += out * (1.0 - limb.l2 / abs(limb.second_link))
        return in_space(posture.chains, depths)

    def _limb_sticks(self, i: int, chain: Floats, posture: Posture) -> Floats:
        limb = self._task.robot.limbs[i]
        size = self._radius if limb.end.kind == "foot" else 1.25 * self._radius
        line = end_effector(
            limb.end.kind, posture.chains[i, 3], float(posture.grips[i]), size, closed=posture.held[i] >= 0
        )
        line = line[np.linspace(0, len(line) - 1, GRIP_POINTS + 1).round().astype(int)]
        grip = in_space(line, self._depths[i])
        ends = [np.stack((chain[:-1], chain[1:]), axis=1), np.stack((grip[:-1], grip[1:]), axis=1)]
        if limb.end.kind != "foot":  # what holds it is at the end of the link, not at the middle of its mouth
            ends[0][2] = np.nan
            back = int(np.argmin(np.linalg.norm(grip - chain[2], axis=1)))
            ends[0][2] = np.stack((chain[2], grip[back]))
        return np.concatenate(ends)

    def _hot(self, torques: Floats) -> "np.ndarray[tuple[int, ...], np.dtype[np.uint8]]":
        shares = np.abs(torques.ravel()) / self._limits
        colours = self._joint_colours.copy()
        for k, share in enumerate(shares):
            i, joint = divmod(k, 2)
            colours[3 * i + joint] = next(shade for least, shade in reversed(self._heat) if share >= least)
        return colours
