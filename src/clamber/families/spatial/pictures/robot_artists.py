"""A robot in space as artists of a picture: base, links as thick as they are, the far ones paler, contacts and their forces."""

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.lines import Line2D

from ....types import Floats
from ....viewing import style
from ....viewing.scene import Bounds
from ..planning.task import SpatialTask
from .camera import Camera
from .moments import Moment
from .world_artists import Colour, discs, larger_side, mixed

ROUND: Final = 9
"""Corners of each end of a link's outline."""
LEAST_LINK: Final = 0.0035
"""Least radius of a drawn link, over the larger side of the picture [-]."""
FADE: Final = 0.42
"""How much of the paper the farthest links take on [-]."""
FADES: Final = 4
"""Steps of that, so that animations have few colours."""
GLOSS: Final = 0.45
"""How much lighter the side of a link that is towards the light is [-]."""
ARROW: Final = 1.1
"""Length of the arrow of a force as large as the weight, over the length of the longest limb [-]."""
SMALLEST: Final = 0.015
"""Smaller forces, over the weight, are not drawn [-]."""
RIM: Final = "#2B3945"


@dataclass(frozen=True, slots=True)
class Patch:
    """A part of a robot, as seen."""

    depth: float
    """Nearness to the camera [m]."""
    outline: Floats
    """Corners in the picture's plane, shape (n, 2) [m]."""
    face: Colour
    edge: Colour


def stadiums(ends: Floats, radii: Floats) -> Floats:
    """Outlines of capsules that are seen from afar, shape (n, 2 `ROUND`, 2).

    Args:
        ends: Their ends in the picture's plane, shape (n, 2, 2) [m].
        radii: Shape (n,) [m].
    """
    ways = ends[:, 1] - ends[:, 0]
    angle = np.arctan2(ways[:, 1], ways[:, 0])
    half = np.linspace(-0.5 * math.pi, 0.5 * math.pi, ROUND)
    turns = np.concatenate((angle[:, None] + half, angle[:, None] + math.pi + half), axis=1)
    around = np.stack((np.cos(turns), np.sin(turns)), axis=-1)
    centres = np.repeat(ends[:, ::-1], ROUND, axis=1)
    made: Floats = centres + radii[:, None, None] * around
    return made


def limb_colour(limb: int) -> str:
    """Colour of a limb."""
    return style.PARTS[limb % len(style.PARTS)]


def force_scale(task: SpatialTask) -> float:
    """Length of the arrow of a force of 1 N [m]."""
    chains = task.robot.chains
    weight = chains.total_mass * float(np.linalg.norm(task.world.gravity)) or chains.total_mass
    return ARROW * chains.longest_limb / weight


class RobotArtists:
    """A robot on the axes of a picture.

    Args:
        axes: The picture's.
        task: Robot and world.
        camera: From where it is seen.
        bounds: Of the picture's plane.
        alpha: Of everything; a ghost has less, and shows no forces.
    """

    def __init__(self, axes: Axes, task: SpatialTask, camera: Camera, bounds: Bounds, alpha: float = 1.0) -> None:
        self._task, self._camera, self._size, self._chains = task, camera, larger_side(bounds), task.robot.chains
        self._radii = np.maximum(self._chains.radius, LEAST_LINK * self._size)
        self._loaded = alpha >= 1.0
        order = 4.0 if self._loaded else 3.0
        self.marks = PolyCollection([], linewidths=1.4, alpha=alpha, zorder=order)
        self.body = PolyCollection([], linewidths=0.7, alpha=alpha, zorder=order + 0.5)
        self.path = Line2D([], [], color=style.QUIET, lw=1.1, ls=(0, (2, 1.6)), zorder=order + 0.2)
        self.forces = PolyCollection(
            [], facecolors=style.FORCE, edgecolors=style.PAPER, linewidths=0.5, zorder=order + 1.0
        )
        self.mass = [
            Line2D([], [], marker=marker, ms=width, mfc=face, mec=RIM, mew=1.2, ls="", zorder=order + 1.1)
            for marker, width, face in (("o", 7.5, style.PAPER), ("+", 7.5, RIM))
        ]
        for collection in (self.marks, self.body, self.forces):
            axes.add_collection(collection, autolim=False)
        for line in (self.path, *self.mass):
            axes.add_line(line)

    @property
    def artists(self) -> list[Artist]:
        """See `Robot`."""
        return [self.marks, self.path, self.body, self.forces, *self.mass]

    def update(self, at: Moment) -> None:
        """See `Robot`."""
        patches = sorted([*self._base(at), *self._limbs(at)], key=lambda patch: patch.depth)
        self.body.set_verts([patch.outline for patch in patches])
        self.body.set_facecolor([patch.face for patch in patches])
        self.body.set_edgecolor([patch.edge for patch in patches])
        self._mark_contacts(at)
        path = np.zeros((0, 2)) if at.path is None or not self._loaded else self._camera.flat(at.path)
        self.path.set_data(path[:, 0], path[:, 1])
        if not self._loaded:
            return
        self.forces.set_verts(list(self._arrows(at)))
        centre = self._camera.flat(at.centre)
        for mark in self.mass:
            mark.set_data(centre[:1], centre[1:])

    def _fade(self, depth: float, low: float, high: float) -> float:
        share = (high - depth) / max(high - low, 1e-9)
        return FADE * round(min(max(share, 0.0), 1.0) * FADES) / FADES

    def _limbs(self, at: Moment) -> list[Patch]:
        camera, chains, found = self._camera, self._chains, []
        depths = camera.depth(at.origins)
        low, high = float(depths.min()), float(depths.max())
        light = np.array((-0.35, 0.35))
        for limb in range(len(chains.limb_names)):
            n = int(chains.n_joints[limb])
            chain, radii = at.origins[limb, : n + 1], self._radii[limb, :n]
            ends = np.stack((chain[:-1], chain[1:]), axis=1)
            flat = camera.flat(ends)
            outlines = stadiums(flat, radii)
            shines = stadiums(flat + light * radii[:, None, None], 0.38 * radii)
            middle = camera.depth(ends).mean(axis=1)
            for k in range(n):
                if float(np.linalg.norm(chain[k + 1] - chain[k])) < 1e-6:
                    continue
                paint = mixed(limb_colour(limb), style.PAPER, self._fade(float(middle[k]), low, high))
                rim = mixed(paint, RIM, 0.55)
                depth = float(middle[k])
                found.append(Patch(depth, outlines[k], paint, rim))
                found.append(
                    Patch(depth + 1e-9, shines[k], mixed(paint, style.PAPER, GLOSS), mixed(paint, style.PAPER, GLOSS))
                )
        return found

    def _base(self, at: Moment) -> list[Patch]:
        """The faces of the base's box that are seen, and a mark that points ahead."""
        camera = self._camera
        half = np.maximum(self._chains.base_half, 2.0 * LEAST_LINK * self._size)
        depth = float(camera.depth(at.body.place))
        found = []
        for axis in range(3):
            sign = 1.0 if float(at.body.turn[:, axis] @ camera.axes[2]) > 0.0 else -1.0
            a, b = (axis + 1) % 3, (axis + 2) % 3
            own = np.zeros((4, 3))
            own[:, axis] = sign * half[axis]
            own[:, a] = half[a] * np.array((1.0, 1.0, -1.0, -1.0))
            own[:, b] = half[b] * np.array((1.0, -1.0, -1.0, 1.0))
            normal = sign * at.body.turn[:, axis]
            lit = max(0.0, float(normal @ (np.array((-0.3, 0.8, 0.5)) @ camera.axes)))
            paint = mixed("#8C99A6", "#DDE3E9", min(1.0, 0.15 + 0.85 * lit))
            found.append(
                Patch(
                    depth + 1e-9 * axis,
                    camera.flat(at.body.place + own @ at.body.turn.T),
                    paint,
                    mixed(paint, RIM, 0.7),
                )
            )
        top = 1.0 if float(at.body.turn[:, 2] @ camera.axes[2]) > 0.0 else -1.0
        x, y = 0.85 * half[0], 0.35 * half[1]
        ahead = np.array(
            [(x, 0.0, top * half[2]), (x - 0.45 * half[0], y, top * half[2]), (x - 0.45 * half[0], -y, top * half[2])]
        )
        ink = mixed(RIM, style.PAPER, 0.15)
        found.append(Patch(depth + 4e-9, camera.flat(at.body.place + ahead @ at.body.turn.T), ink, ink))
        return found

    def _mark_contacts(self, at: Moment) -> None:
        """Rings about the holds that limbs are on, in the limbs' colours."""
        held = [limb for limb in range(len(self._chains.limb_names)) if at.holds[limb] >= 0]
        least = 1.5 * LEAST_LINK * self._size
        places = at.tips[held].reshape(-1, 3)
        normals = at.normals[held].reshape(-1, 3)
        ends = self._radii[held, self._chains.n_joints[held] - 1]
        radii = 1.7 * np.maximum(ends, least)
        self.marks.set_verts(list(self._camera.flat(discs(places, normals, radii))) if held else [])
        self.marks.set_facecolor([mixed(limb_colour(limb), style.PAPER, 0.6) for limb in held])
        self.marks.set_edgecolor([limb_colour(limb) for limb in held])

    def _arrows(self, at: Moment) -> Floats:
        """Outlines of the contact forces on the tips, shape (n, 7, 2)."""
        forces = np.nan_to_num(at.wrenches[:, :3]) * force_scale(self._task)
        seen = np.linalg.norm(forces, axis=1) > SMALLEST * ARROW * self._chains.longest_limb
        return arrows(self._camera.flat(at.tips[seen]), self._camera.flat(forces[seen]), 0.0034 * self._size)


def arrows(starts: Floats, ways: Floats, width: float) -> Floats:
    """Outlines of arrows from their starts along their ways, shape (n, 7, 2); heads shrink with short arrows.

    Args:
        starts: Shape (n, 2) [m].
        ways: Shape (n, 2) [m].
        width: Half the width of a shaft [m].
    """
    length = np.maximum(np.hypot(ways[:, 0], ways[:, 1]), 1e-9)
    ahead = ways / length[:, None]
    side = np.stack((-ahead[:, 1], ahead[:, 0]), axis=1)
    head = np.minimum(7.0 * width, 0.6 * length)
    thick = np.minimum(width, 0.25 * length)
    along = np.stack(
        (0.0 * length, length - head, length - head, length, length - head, length - head, 0.0 * length), axis=1
    )
    aside = thick[:, None] * np.array((1.0, 1.0, 2.9, 0.0, -2.9, -1.0, -1.0))
    made: Floats = starts[:, None] + along[..., None] * ahead[:, None] + aside[..., None] * side[:, None]
    return made
