"""What a walker's parts bear, against their limits: forces and lengths of legs and actuators, and the grip that its feet use."""

from dataclasses import dataclass
from typing import Any, Final, TypeAlias

import numpy as np

from ....types import Floats
from ....viewing import style
from ....viewing.panel import Gauges
from ..control.gait import lengths_at
from ..execution.true_walk import TrueWalk
from ..execution.walk_scene import plate_axes
from ..robot import LEG_NAMES, Legs, Mechanism, WalkerRobot
from ..world.ground import Ground
from .walker_motion import COLOURS

Bars: TypeAlias = tuple[tuple[str, str], ...]
"""Name and colour of each."""
LEG_BARS: Final[Bars] = tuple((name.capitalize(), COLOURS[k // 3]) for k, name in enumerate(LEG_NAMES))
ACTUATOR_BARS: Final[Bars] = tuple((f"actuator {i + 1}", style.HOLD) for i in range(3))
NEAR_END: Final = 0.05
"""Share of the stroke from either end at which a bar of length turns red [-]."""
NEAR_LIMIT: Final = 0.9
"""Share of a limit beyond which a bar of force or grip turns red [-]."""
BARELY: Final = 0.02
"""Feet that carry less of the weight than this have no grip to tell of [-]."""
FEW: Final = 100.0
"""Forces of a smaller bar than this are told with a decimal [N]."""
WHOLE: Final = "full bar: the robot's weight; its file states no limit"
MOST: Final = "full bar: the most of this walk; the robot's file states no limit"


LIMITED: Final = (
    ("leg-force", "what was left of the most force of a leg's motor"),
    ("grip", "what was left of the friction of a foot; momentary where feet land"),
    ("leg-stroke", "how far the legs were from the ends of their strokes; against half of one"),
    ("thrust", "what was left of the most force of an actuator"),
    ("actuator-stroke", "how far the actuators were from the ends of their strokes; against half of one"),
)
"""Names and meanings of what is left of the limits of each block of bars."""


class WalkLoads:
    """What the parts of a walker bore in a walk, row by row.

    Args:
        robot: The walker.
        ground: As its file says; grip is by its friction.
        trace: What happened.
        weight: Of the robot with what it carries [N].
        exact: Whether the trace's forces are those of the ground; those along the legs alone tell nothing of grip.
    """

    def __init__(self, robot: WalkerRobot, ground: Ground, trace: TrueWalk, weight: float, *, exact: bool) -> None:
        rows = len(trace.time)
        ups, forces = plate_normals(trace.pose), trace.forces.reshape(rows, 6, 3)
        self.forces = np.einsum("rik,rk->ri", forces, ups)
        """Of the ground along each leg, shape (rows, 6) [N]."""
        self.legs = np.einsum("rik,rk->ri", trace.pose[:, None, :3] - trace.feet.reshape(rows, 6, 3), ups)
        """Lengths from the plate to the soles, shape (rows, 6) [m]."""
        grip = grip_in_use(forces, ground.axes()[:, 2], ground.friction, weight)
        self.grip = grip if exact else np.full_like(grip, np.nan)
        self.thrusts = trace.thrusts
        self.actuators = lengths_at(robot, trace.place)
        most = float(np.abs(self.thrusts[np.isfinite(self.thrusts)]).max(initial=0.0))
        self.gauges = (
            leg_force_gauges(robot, weight), grip_gauges(), leg_gauges(robot), thrust_gauges(robot, max(most, 1.0)),
            actuator_gauges(robot),
        )  # fmt: skip

    def at(self, k: int) -> tuple[Floats, ...]:
        """What bars show at a row."""
        return self.forces[k], self.grip[k], self.legs[k], self.thrusts[k], self.actuators[k]

    def left(self, rows: slice) -> list["Left"]:
        """What was left of every limit in some rows, least of all legs or actuators; nothing of what has no limit."""
        columns = self.forces, self.grip, self.legs, self.thrusts, self.actuators
        found = []
        for (name, meaning), gauges, values in zip(LIMITED, self.gauges, columns, strict=True):
            shares = gauges.shares(values[rows])
            known = shares[np.isfinite(shares)]
            if not gauges.limits or not known.size:
                continue
            both = len(gauges.limits) > 1  # a stroke has two ends
            room = 1.0 - float(known.max())
            room = min(room, float(known.min())) if both else room
            size = room * float(gauges.high[0] - gauges.low[0])
            found.append(Left(name, gauges.show(size), room / (0.5 if both else 1.0), meaning))
        return found


@dataclass(frozen=True, slots=True)
class Left:
    """How much of a limit was left."""

    name: str
    value: str
    """With its unit."""
    share: float
    """Of the whole, or of half a stroke [-]."""
    meaning: str


def plate_normals(poses: Floats) -> Floats:
    """The plate's normals in the world for its poses, shape (rows, 6) -> (rows, 3)."""
    return plate_axes(*poses[:, 3:].T)[:, 2].T


def actuator_gauges(robot: WalkerRobot) -> Gauges:
    """One bar per actuator, from drawn in to extended."""
    return _lengths("Actuator lengths", ACTUATOR_BARS, robot.mechanism)


def leg_gauges(robot: WalkerRobot) -> Gauges:
    """One bar per leg, from drawn in to extended."""
    return _lengths("Leg lengths", LEG_BARS, robot.legs)


def leg_force_gauges(robot: WalkerRobot, weight: float) -> Gauges:
    """One bar per leg: the force along it, up to what its motor can give or, where no limit is stated, the robot's weight [N]."""
    return _forces("Force along each leg", LEG_BARS, robot.legs.force, weight, WHOLE)


def thrust_gauges(robot: WalkerRobot, most: float) -> Gauges:
    """One bar per actuator: the force that it pushes or pulls with, up to its limit or, where none is stated, to the most of a walk [N]."""
    return _forces("Actuator forces", ACTUATOR_BARS, robot.mechanism.force, most, MOST)


def grip_gauges() -> Gauges:
    """One bar per foot: the share of its friction that is in use."""
    limits, unit = ((1.0, "slips"),), ("%", 0.01, 0)
    return _gauges("Grip in use", LEG_BARS, 0.0, 1.0, limits=limits, calm=(0.0, NEAR_LIMIT), unit=unit)


def grip_in_use(forces: Floats, normal: Floats, friction: float, weight: float) -> Floats:
    """Coulomb: the force along the ground over the most that friction holds, shape (..., 6) [-]; NaN for feet that carry nothing.

    Args:
        forces: Of the ground on each foot, shape (..., 6, 3) [N].
        normal: Of the ground, shape (3,).
        friction: Its coefficient [-].
        weight: Of the robot [N].
    """
    onto = forces @ normal
    along = np.linalg.norm(forces - onto[..., None] * normal, axis=-1)
    carries = onto > BARELY * weight
    share: Floats = np.where(carries, along / (friction * np.where(carries, onto, 1.0)), np.nan)
    return share


def _lengths(title: str, bars: Bars, part: Legs | Mechanism) -> Gauges:
    limits, calm = ((0.0, "shortest"), (1.0, "longest")), (NEAR_END, 1.0 - NEAR_END)
    return _gauges(title, bars, part.shortest, part.longest, limits=limits, calm=calm, unit=("cm", 0.01, 1))


def _forces(title: str, bars: Bars, limit: float | None, full: float, note: str) -> Gauges:
    if limit is None:
        unit = ("N", 1.0, 1 if full < FEW else 0)
        return _gauges(title, bars, 0.0, full, limits=(), calm=(0.0, np.inf), unit=unit, note=note)
    unit = ("N", 1.0, 1 if limit < FEW else 0)
    return _gauges(title, bars, 0.0, limit, limits=((1.0, "limit"),), calm=(0.0, NEAR_LIMIT), unit=unit)


def _gauges(title: str, bars: Bars, low: float, high: float, **look: Any) -> Gauges:
    names, colours = zip(*bars, strict=True)
    ends = np.full(len(bars), low), np.full(len(bars), high)
    return Gauges(title=title, names=names, colours=colours, low=ends[0], high=ends[1], group=3, **look)
