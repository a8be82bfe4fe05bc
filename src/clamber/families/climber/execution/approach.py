"""How a free limb comes to a hold: the posture to hold with, a place to stand off, the way there, and where the body should be."""

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Final, TypeAlias

import numpy as np

from ....types import Floats, Records
from ..control.swing_path import clearance, discs_in_body, find_way
from ..robot.robot import Limb, LimbedRobot
from .postures import Posture, bent_postures, postures

CELLS: Final = 81
"""Grid points along each joint: 2.75 deg for LIBRA."""
MOST_POINTS: Final = 400
HOOK: Final = np.array((0.0185, 0.005))
"""Radius of the disc that stands for a hook with its flare, and how far its centre is before the tip, along the grab direction [m]."""
LEAST_CLEARANCE: Final = 0.004
"""That a way must keep [m]."""
STAND_OFFS: Final = (1.0, 0.85)
"""Parts of the wished stand-off that are tried in turn."""
SLANTS: Final = ((0, 15, -15), (30, -30), (45, -45))
"""Angles between the way in and the grab direction, in groups: a straight way with a moved body comes before a slanted one [deg]."""
HEADINGS: Final = ((0, 1), (-1, 1), (-1, 0), (1, 1), (1, 0), (0, -1), (-1, -1), (1, -1))
"""Of the body as it makes room, x towards the hold's side, y up. Up and away come first: there the hooks that hold stay steeper."""
SHIFTS: Final = (
    (0.0, 0.0),
    *(
        (size * x / math.hypot(x, y), size * y / math.hypot(x, y))
        for size in (0.02, 0.035, 0.05, 0.07)
        for x, y in HEADINGS
    ),
)
"""Moves of the body that make room, the least first [m]."""
BENT: Final = math.radians(20.0)
"""An elbow nearer to straight than this brings its tip no farther, and nowhere on a straight way [rad]."""
NEARBY: Final = 0.6
"""Holds farther from the body are in no limb's way [m]."""


Obstacles: TypeAlias = tuple[Floats, Floats, float, Floats]
"""As `clearance` takes them."""


@dataclass(frozen=True, slots=True, eq=False)
class Approach:
    """A way to a hold."""

    shift: Floats
    """Move of the body before it, world frame, shape (2,) [m]."""
    way: Floats
    """Joint angles from where the limb is to the stand-off, shape (n, 2) [rad]."""
    grab: Floats
    """Direction in which the hook will pull, world frame."""
    stand_off: float
    """Distance of the stand-off from the hold [m]."""


def wall_of(robot: LimbedRobot) -> Floats:
    """The body's outline as segments x, y, x, y, radius in the body frame, shape (limbs, 5) [m]."""
    ports = [(limb.port_x, limb.port_y) for limb in robot.limbs]
    return np.array([(*a, *b, robot.body_margin) for a, b in zip(ports, ports[1:] + ports[:1], strict=True)])


def free_distance(peg_radius: float, doubt: float) -> float:
    """Distance from a hold at which a hook with its flare is clear of it, wherever within its doubt it is [m]."""
    return float(HOOK.sum()) + LEAST_CLEARANCE + peg_radius + doubt


def discs_of(places: Iterable[Floats | tuple[float, float]], radius: float) -> Floats:
    """Places as discs x, y, radius, shape (n, 3) [m]."""
    return np.array([(*place, radius) for place in places]).reshape(-1, 3)


def discs_near(discs: Floats, pose: Floats) -> Floats:
    """Discs x, y, radius in the world that are near a body at a pose, in its frame, shape (n, 3) [m]."""
    out: Floats = np.empty_like(discs)
    return out[: discs_in_body(discs, pose, NEARBY, out)]


def moves_for_room(pose: Floats, towards: Floats, stands: Callable[[Floats], bool]) -> Iterator[tuple[Floats, Floats]]:
    """The moves by which a body makes room for a limb at a place [m], shape (2,), and the poses after them, as far as it stands there."""
    side = float(np.sign(towards[0] - pose[0]))
    for x, y in SHIFTS:
        shift = np.array((x * side, y))
        moved = pose + np.array((*shift, 0.0))
        if not shift.any() or stands(moved):
            yield shift, moved


def places_beside(
    limb: Limb, pose: Floats, hold: Floats, final: Posture, wished: float, slants: Sequence[int]
) -> Iterator[tuple[Floats, float, Floats, Posture]]:
    """From where a limb may go straight in to a hold.

    Args:
        limb: Of the robot.
        pose: Of the body, shape (3,).
        hold: Its place, world frame [m].
        final: Posture on the hold: the elbow stays on its side.
        wished: Distance from the hold that is tried first [m].
        slants: Angles between the way in and the grab direction, in the order in which they are tried [deg].

    Returns:
        Direction of the way in, its length [m], where it begins, world frame [m], and the posture there, within the joints' limits.
    """
    for part in STAND_OFFS:
        for slant in np.radians(slants):
            c = np.cos(slant)
            s = np.sin(slant)
            x, y = final.grab
            towards = np.array((c * x - s * y, s * x + c * y))
            place = hold - part * wished * towards
            for posture in bent_postures(limb, pose, place, float(final.angles[1])):
                yield towards, part * wished, place, posture


def rank(found: Iterable[Posture], elbow: int) -> list[Posture]:
    """Postures within the joints' limits with the elbow on the wanted side (+1, -1), or the hook on top (0); most on top first."""
    fit = [one for one in found if one.inside and (elbow * one.angles[1] > 0.0 if elbow else one.on_top > 0.0)]
    return sorted(fit, key=lambda one: -one.on_top)


@dataclass(frozen=True, slots=True, kw_only=True)
class Wish:
    """How a limb is to come to a hold."""

    elbow: int = 0
    """Side of the elbow to hold with: +1, -1, or 0 for whichever has the hook more on top."""
    stand_off: float = 0.028
    """Distance from the hold before the way in [m]."""
    near: float = 0.016
    """Distance straight before the hold, against the grab direction, that the limb must also reach, its elbow well bent where that can be:
    a straight limb is pushed nowhere from there [m]."""
    straight: bool = True
    """Whether an elbow that is not well bent there will do."""


class Approaches:
    """Finds ways to holds for the limbs of one robot.

    Args:
        robot: The climber.
        legs: Records of `control.planar_limb.PLANAR_LIMB`, one per limb.
    """

    def __init__(self, robot: LimbedRobot, legs: Records) -> None:
        self.robot, self.legs = robot, legs
        self._wall, self._path = wall_of(robot), np.zeros((MOST_POINTS, 2))
        joints = [(limb.shoulder, limb.elbow) for limb in robot.limbs]
        self.limits = np.array([[[joint.lower for joint in two], [joint.upper for joint in two]] for two in joints])
        """Of each limb's joints, shape (limbs, 2, 2): lower, then upper [rad]."""

    def obstacles(self, discs: Floats) -> Obstacles:
        """What limbs keep off: discs in the body frame and the body itself."""
        return discs, self._wall, self.robot.link_radius, HOOK

    def room(self, i: int, angles: Floats, obstacles: Obstacles) -> float:
        """Clearance of limb `i`, joints at angles, shape (2,) [rad], from obstacles [m]."""
        return float(clearance(self.legs[i], angles[0], angles[1], obstacles))

    def way(
        self, i: int, start: Floats, goal: Floats, obstacles: Obstacles, least: float = LEAST_CLEARANCE
    ) -> Floats | None:
        """Joint angles from start to goal, shape (n, 2) [rad], that keep a clearance, but near ends that have less; None if none do."""
        grid = (*self.limits[i], CELLS)
        count = find_way(self.legs[i], grid, start, goal, obstacles, least, self._path)
        return self._path[:count].copy() if count else None

    def find(
        self,
        i: int,
        angles: Floats,
        pose: Floats,
        hold: Floats,
        discs: Floats,
        wish: Wish,
        *,
        stands: Callable[[Floats], bool] = lambda pose: True,
    ) -> Approach | None:
        """A way for limb `i` from joint angles `angles` to a stand-off before `hold`; None where there is none.

        Args:
            i: Index of the limb.
            angles: Where it is, shape (2,) [rad].
            pose: Body pose, shape (3,).
            hold: Place of the hold, world frame [m].
            discs: All holds as obstacles: x, y, radius with what the place is in doubt by, world frame, shape (n, 3) [m].
            wish: How it is to come there.
            stands: Whether the other limbs can hold the body at another pose.
        """
        for bent, slants in product((BENT, 0.0) if wish.straight else (BENT,), SLANTS):
            for shift, moved in moves_for_room(pose, hold, stands):
                found = self._stand_off(i, angles, moved, hold, discs, wish, bent, slants)
                if found is not None:
                    return Approach(shift, *found)
        return None

    def leave(
        self,
        i: int,
        side: float,
        pose: Floats,
        tip: Floats,
        back: Floats,
        discs: Floats,
        *,
        stands: Callable[[Floats], bool] = lambda pose: True,
    ) -> Floats | None:
        """The least move of the body after which a limb can draw its hook straight back off its hold, shape (2,) [m]; None if none does.

        Args:
            i: Index of the limb.
            side: Of its elbow, +1 or -1.
            tip: Of the limb, on its hold, world frame [m].
            back: How far it draws back, world frame, shape (2,) [m].
            pose, discs, stands: As in `find`.
        """
        limb = self.robot.limbs[i]
        for shift, moved in moves_for_room(pose, tip, stands):
            near = self.obstacles(discs_near(discs, moved))
            off = bent_postures(limb, moved, tip + back, side, BENT)
            comes_off = all(bent_postures(limb, moved, tip + part * back, side, BENT) for part in (0.0, 0.5))
            if comes_off and any(self.room(i, one.angles, near) >= 0.0 for one in off):
                return shift
        return None

    def bends(self, i: int, side: float, pose: Floats, tip: Floats, back: Floats, shift: Floats) -> bool:
        """Whether a limb that draws its hook back while the body moves, both in step, keeps its elbow well bent and its joints in limits.

        Args:
            i, side, pose, tip, back: As in `leave`.
            shift: Move of the body, shape (2,) [m].
        """
        limb, move = self.robot.limbs[i], np.array((*shift, 0.0))
        parts = np.linspace(0.0, 1.0, 9)
        return all(bent_postures(limb, pose + part * move, tip + part * back, side, BENT) for part in parts)

    def _stand_off(
        self,
        i: int,
        angles: Floats,
        pose: Floats,
        hold: Floats,
        discs: Floats,
        wish: Wish,
        bent: float,
        slants: tuple[int, ...],
    ) -> tuple[Floats, Floats, float] | None:
        limb = self.robot.limbs[i]
        obstacles = self.obstacles(discs_near(discs, pose))
        # the posture that is best on the hold; the other one would pull sideways, and the robot fall when it has to carry
        for final in rank(postures(limb, pose, hold), wish.elbow)[:1]:
            if not bent_postures(limb, pose, hold - wish.near * final.grab, float(final.angles[1]), bent):
                continue
            for _, distance, _, posture in places_beside(limb, pose, hold, final, wish.stand_off, slants):
                if self.room(i, posture.angles, obstacles) < 0.0:
                    continue
                way = self.way(i, angles, posture.angles, obstacles)
                if way is not None:
                    return way, final.grab, distance
        return None
