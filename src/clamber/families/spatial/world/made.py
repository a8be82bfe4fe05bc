"""Worlds to start from, made of a few numbers: stones, walls, overhangs, ceilings, a corner, a chimney; sized for a robot of some reach."""

import math
from dataclasses import dataclass
from enum import StrEnum
from typing import Final

import numpy as np

from ....types import Floats, Json
from .world import SCHEMA


class Kind(StrEnum):
    """What can be made."""

    stones = "stones"
    slope = "slope"
    wall = "wall"
    overhang = "overhang"
    ceiling = "ceiling"
    corner = "corner"
    chimney = "chimney"


TURNED: Final = {Kind.stones: 0.0, Kind.wall: 90.0, Kind.ceiling: 180.0}
"""Angle of the surface from level [deg], of kinds for which nobody states it."""
LEAN: Final = {Kind.slope: 30.0, Kind.overhang: 60.0}
"""Usual angle [deg]: of a slope from level, of an overhang from the vertical."""
REACH: Final = 0.36
"""Where no robot is named: that of the gripper climber that comes with Clamber [m]."""
SPACING: Final = 0.22
"""Distance of holds over the reach [-]; so for those that follow."""
BUMPS: Final = 0.055
LENGTH: Final = 5.0
"""Of the guide."""
WIDTH: Final = 2.4
BEYOND: Final = 1.2
"""How far there are holds beyond the guide's ends."""
BUMP: Final = 1.4
"""Distance over which bumps rise and fall."""
JITTER: Final = 0.28
"""Over the distance of holds [-]."""
PATCH: Final = {Kind.stones: 0.3, Kind.slope: 0.3}
"""Radius of a hold over the distance of holds, where feet stand; elsewhere it is `GRIP` [-]."""
GRIP: Final = 0.07
BEND: Final = 0.5
"""Radius of a corner's arc over the reach [-]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Wanted:
    """A world that is asked for; None: sized by the reach. Lengths in metres, angles in degrees."""

    kind: Kind
    length: float | None = None
    width: float | None = None
    spacing: float | None = None
    bumps: float | None = None
    angle: float | None = None
    gap: float | None = None
    """Between a chimney's walls."""
    left_out: float = 0.0
    """Share of holds that are missing, at random [-]."""
    seed: int = 0


@dataclass(frozen=True, slots=True)
class Fit:
    """A robot's size, as worlds ask for it."""

    reach: float = REACH
    """From the base's origin to the farthest that a limb reaches [m]."""
    straddle: float = 0.8 * REACH
    """Between tips on both sides in the nominal posture [m]."""


def world_data(wanted: Wanted, fit: Fit, name: str) -> Json:
    """The document of a world.

    Args:
        wanted: Its kind and sizes.
        fit: The robot that it is for.
        name: What it is called.
    """
    sizes = _Sizes(wanted, fit)
    make = {Kind.corner: sizes.corner, Kind.chimney: sizes.chimney}.get(wanted.kind, sizes.flat)
    return {"schema": SCHEMA, "name": name} | make()


class _Sizes:
    """Sizes of a world, those that are stated and those of the robot's reach."""

    def __init__(self, wanted: Wanted, fit: Fit) -> None:
        self.wanted = wanted
        self.reach = fit.reach
        self.length = _or(wanted.length, LENGTH * fit.reach)
        self.width = _or(wanted.width, WIDTH * fit.reach)
        self.spacing = _or(wanted.spacing, SPACING * fit.reach)
        self.bumps = wanted.bumps if wanted.bumps is not None else rounded(BUMPS * fit.reach)
        self.gap = _or(wanted.gap, 1.2 * fit.straddle)
        self.bend = rounded(BEND * fit.reach)

    def flat(self) -> Json:
        """One surface, turned about a level line across it."""
        kind = self.wanted.kind
        lean = self.wanted.angle if self.wanted.angle is not None else LEAN.get(kind, 0.0)
        angle = math.radians(TURNED.get(kind, 90.0 + lean if kind is Kind.overhang else lean))
        along = np.array((math.cos(angle), 0.0, math.sin(angle)))
        normal = np.array((-math.sin(angle), 0.0, math.cos(angle)))
        told = {Kind.slope: f"Slope of {lean:g} deg", Kind.overhang: f"Overhang of {lean:g} deg"}
        title = told.get(kind, {Kind.stones: "Stepping stones on level ground"}.get(kind, kind.value.capitalize()))
        return {
            "title": f"{title}, {self.length:g} m x {self.width:g} m",
            "guide": [{"at": _place(np.zeros(3)), "normal": _vector(normal)}, {"at": _place(self.length * along)}],
            "patterns": [self._pattern((-BEYOND * self.reach, self.length + BEYOND * self.reach))],
            "solids": [self._behind(np.zeros(3), normal)],
        }

    def corner(self) -> Json:
        """From a level floor up a wall."""
        x, up = np.array((1.0, 0.0, 0.0)), np.array((0.0, 0.0, 1.0))
        foot, beyond = self.length * x, BEYOND * self.reach
        edge = self.length - 0.5 * self.spacing
        return {
            "title": f"Floor of {self.length:g} m and a wall of {self.length:g} m",
            "guide": [
                {"at": _place(np.zeros(3)), "normal": _vector(up)},
                {"at": _place(foot), "normal": _vector(-x), "bend": _mm(self.bend)},
                {"at": _place(foot + self.length * up)},
            ],
            "patterns": [
                self._pattern((-beyond, edge), (np.zeros(3), x, up)),
                self._pattern((0.5 * self.spacing, self.length + beyond), (foot, up, -x), 1),
            ],
            "solids": [self._behind(np.zeros(3), up), self._behind(foot, -x)],
        }

    def chimney(self) -> Json:
        """Two walls that face each other; the guide goes up between them, the body's back to the outside."""
        out, aside, up = np.array((-1.0, 0.0, 0.0)), np.array((0.0, 1.0, 0.0)), np.array((0.0, 0.0, 1.0))
        span = (-BEYOND * self.reach, self.length + BEYOND * self.reach)
        walls = [(0.5 * self.gap * aside, -aside), (-0.5 * self.gap * aside, aside)]
        return {
            "title": f"Chimney, {self.gap:g} m between its walls, {self.length:g} m high",
            "guide": [{"at": _place(np.zeros(3)), "normal": _vector(out)}, {"at": _place(self.length * up)}],
            "patterns": [self._pattern(span, (at, up, normal), k) for k, (at, normal) in enumerate(walls)],
            "solids": [self._behind(at, normal) for at, normal in walls],
        }

    def _pattern(
        self, along: tuple[float, float], on: tuple[Floats, Floats, Floats] | None = None, more: int = 0
    ) -> Json:
        """Holds on the guide's surface, or on a patch: its origin, the direction along it, its normal."""
        wanted, half = self.wanted, 0.5 * self.width
        patch = {} if on is None else {"on": {"at": _place(on[0]), "x": _vector(on[1]), "normal": _vector(on[2])}}
        bumps = {"bumps": _mm(self.bumps), "bump_length": _mm(rounded(BUMP * self.reach))} if self.bumps else {}
        return {
            **patch,
            "along": [_mm(rounded(value, 4)) for value in along],
            "across": [_mm(-half), _mm(half)],
            "spacing": _mm(self.spacing),
            "jitter": _mm(rounded(JITTER * self.spacing)),
            **bumps,
            **({"left_out": wanted.left_out} if wanted.left_out else {}),
            "radius": _mm(max(1e-3, rounded(PATCH.get(wanted.kind, GRIP) * self.spacing))),
            "seed": wanted.seed + more,
        }

    def _behind(self, at: Floats, normal: Floats) -> Json:
        """The solid below the lowest of the bumps."""
        return {"kind": "plane", "at": _place(at - self.bumps * normal), "normal": _vector(normal)}


def _or(stated: float | None, usual: float) -> float:
    return rounded(usual) if stated is None else stated


def rounded(value: float, digits: int = 2) -> float:
    """A length with a few digits, so that people like to read it [m]; 0 stays 0."""
    if value == 0.0:
        return 0.0
    size = 10.0 ** (math.floor(math.log10(abs(value))) - digits + 1)
    return float(f"{round(value / size) * size:.6g}")


def _mm(value: float) -> str:
    return f"{1e3 * value:.6g} mm" if abs(value) < 1.0 else f"{value:.6g} m"


def _place(place: Floats) -> list[str]:
    return [f"{value + 0.0:.6g} m" for value in np.round(place, 6)]


def _vector(vector: Floats) -> list[float]:
    return [float(f"{value + 0.0:.9g}") for value in np.round(vector, 9)]
