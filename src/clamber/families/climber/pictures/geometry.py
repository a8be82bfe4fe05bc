"""Where the parts of a limbed climber are in a stance: joints, tips and body outline from the pose, without kernels.

Points are complex numbers x + iy inside this file, and arrays of shape (..., 2) outside it; world frame [m] unless said.
"""

import cmath
import math
from dataclasses import dataclass

import numpy as np

from ....types import Complexes, Floats
from ..robot.robot import Limb, LimbedRobot
from ..world.board import Board

ROUNDING = 32
"""Points of the circle that rounds the body's corners."""


@dataclass(frozen=True, slots=True)
class Posture:
    """A climber at one moment of its climb, settled or on its way."""

    x: float
    """Body origin, world frame [m]."""
    y: float
    """Body origin, world frame [m]."""
    angle: float
    """Body angle [rad]."""
    outline: Floats
    """Corners of the body, world frame [m], shape (m, 2)."""
    chains: Floats
    """Port, elbow, end of the second link and tip of each limb, world frame [m], shape (n_limbs, 4, 2)."""
    grips: Floats
    """Direction in which each end effector grabs, world frame [rad], shape (n_limbs,)."""
    held: tuple[int, ...]
    """Index of the hold that each limb is on; -1: none."""


def limb_chain(limb: Limb, origin: complex, angle: float, tip: complex, side: float) -> tuple[complex, ...]:
    """Port, elbow, end of the second link and tip of one limb (page "The model", section 1).

    Args:
        limb: The limb.
        origin: Body origin, world frame [m].
        angle: Body angle [rad].
        tip: Where the tip should be, world frame [m]; out of reach, the limb points at it, stretched.
        side: 1 for branch 0 and -1 for branch 1. Between them the elbow passes from one side to the other, as if it
            turned out of the plane: the links look shorter then, and both ends stay where they are.

    Returns:
        Four points, world frame [m].
    """
    turn = cmath.exp(1j * angle)
    port = origin + complex(limb.port_x, limb.port_y) * turn
    l1, l2 = limb.l1, limb.l2_effective
    v = tip - port
    distance = abs(v)
    ahead = v / distance if distance > 0.0 else turn * cmath.exp(1j * limb.port_angle)
    reached = min(max(distance, abs(l1 - l2)), l1 + l2)
    along = (reached * reached + l1 * l1 - l2 * l2) / (2.0 * reached) if reached > 0.0 else 0.0
    across = math.sqrt(max(l1 * l1 - along * along, 0.0))
    # branch 0 bends the second link to the left, so that the elbow lies to the right of the line from port to tip
    elbow = port + ahead * complex(along, -side * across)
    end = port + ahead * reached
    return port, elbow, elbow + (end - elbow) * limb.l2 / limb.second_link, end


def joint_angles(limb: Limb, angle: float, chain: tuple[complex, ...]) -> tuple[float, float]:
    """Shoulder and elbow angle [rad] of a drawn limb, in (-pi, pi]."""
    port, elbow, wrist, _ = chain
    first = cmath.phase((elbow - port) * cmath.exp(-1j * (angle + limb.port_angle)))
    return first, cmath.phase((wrist - elbow) / (elbow - port))


def joint_margin(limb: Limb, angle: float, chain: tuple[complex, ...]) -> float:
    """Distance of a drawn limb's joints from their nearer limit [rad]; negative outside."""
    margins = []
    for joint, at in zip((limb.shoulder, limb.elbow), joint_angles(limb, angle, chain), strict=True):
        centre, half = 0.5 * (joint.lower + joint.upper), 0.5 * (joint.upper - joint.lower)
        margins.append(half - abs(math.remainder(at - centre, math.tau)))
    return min(margins)


def stance_tips(robot: LimbedRobot, board: Board, stance: np.void) -> list[complex]:
    """Where each limb's tip is in a stance, world frame [m]: on its hold, or riding with the body."""
    origin, turn = complex(stance["x"], stance["y"]), cmath.exp(1j * float(stance["angle"]))
    tips = []
    for i in range(len(robot.limbs)):
        held = int(stance["hold"][i])
        if held >= 0:
            tips.append(complex(board.holds[held].x, board.holds[held].y))
        else:
            tips.append(origin + complex(*stance["foot"][i]) * turn)
    return tips


def stance_sides(robot: LimbedRobot, stance: np.void, tips: list[complex]) -> list[float]:
    """Side of each elbow (1: branch 0, -1: branch 1): as solved; a free limb's other one if only that fits its joints."""
    origin, angle = complex(stance["x"], stance["y"]), float(stance["angle"])
    sides = []
    for i, limb in enumerate(robot.limbs):
        side = 1.0 if int(stance["branch"][i]) == 0 else -1.0
        if int(stance["hold"][i]) < 0:
            here, there = (
                joint_margin(limb, angle, limb_chain(limb, origin, angle, tips[i], s)) for s in (side, -side)
            )
            side = -side if here < 0.0 <= there else side
        sides.append(side)
    return sides


def pose(
    robot: LimbedRobot, origin: complex, angle: float, tips: list[complex], sides: list[float], held: tuple[int, ...]
) -> Posture:
    """The posture with the body at `origin`, turned by `angle`, and every tip at its place."""
    chains = [
        limb_chain(limb, origin, angle, tip, side) for limb, tip, side in zip(robot.limbs, tips, sides, strict=True)
    ]
    return chained_pose(robot, origin, angle, np.array(chains), held)


def chained_pose(
    robot: LimbedRobot, origin: complex, angle: float, chains: Complexes, held: tuple[int, ...]
) -> Posture:
    """The posture with port, elbow, end of the second link and tip of every limb at their places, shape (limbs, 4)."""
    hooks = np.exp(1j * np.array([limb.end.angle for limb in robot.limbs]))
    turn = cmath.exp(1j * angle)
    outline = origin + turn * body_outline(robot)
    corners, drawn = (np.stack([points.real, points.imag], axis=-1) for points in (outline, chains))
    grips = np.angle((chains[:, 2] - chains[:, 1]) * hooks)
    return Posture(origin.real, origin.imag, angle, corners, drawn, grips, held)


def stance_posture(robot: LimbedRobot, board: Board, stance: np.void) -> Posture:
    """The posture that a stance record stands for."""
    tips = stance_tips(robot, board, stance)
    held = tuple(int(h) for h in stance["hold"][: len(robot.limbs)])
    origin, angle = complex(stance["x"], stance["y"]), float(stance["angle"])
    return pose(robot, origin, angle, tips, stance_sides(robot, stance, tips), held)


def body_outline(robot: LimbedRobot) -> Complexes:
    """Corners of the body, body frame [m], anticlockwise: the polygon of its ports, extended by the body margin."""
    round_ = max(robot.body_margin, 1e-3) * np.exp(1j * np.linspace(0.0, math.tau, ROUNDING, endpoint=False))
    ports = np.array([complex(limb.port_x, limb.port_y) for limb in robot.limbs])
    points = (ports[:, None] + round_[None, :]).ravel()
    # for each direction the farthest point: the convex hull without a geometry library
    directions = np.exp(1j * np.linspace(-math.pi, math.pi, 8 * ROUNDING, endpoint=False))
    farthest = np.argmax((points[None, :] * directions.conj()[:, None]).real, axis=1)
    kept = [int(k) for k, before in zip(farthest, np.roll(farthest, 1), strict=True) if k != before]
    corners: Complexes = points[kept]
    return corners


def capsule(a: Floats, b: Floats, radius: float, points: int = 10) -> Floats:
    """Outline of a link of some thickness from `a` to `b` [m], shape (2 * points, 2)."""
    start, end = complex(*a), complex(*b)
    ahead = (end - start) / abs(end - start) if end != start else 1.0 + 0j
    bend = np.exp(1j * np.linspace(-math.pi / 2, math.pi / 2, points))
    rim = np.concatenate([end + radius * ahead * bend, start - radius * ahead * bend])
    return np.stack([rim.real, rim.imag], axis=-1)


def end_effector(kind: str, tip: Floats, direction: float, size: float, *, closed: bool) -> Floats:
    """A line that shows an end effector: a hook over its hold, open towards its pull; jaws; or a sole.

    Args:
        kind: "hook", "gripper" or "foot".
        tip: World frame [m].
        direction: Grab direction, world frame [rad].
        size: Radius [m].
        closed: Whether it holds.

    Returns:
        Polyline, world frame [m], shape (25, 2).
    """
    at, ahead = complex(*tip), cmath.exp(1j * direction)
    if kind == "foot":
        line = at + ahead * np.linspace(-1j, 1j, 25) * size
    else:
        gap = {"hook": math.radians(75), "gripper": math.radians(12 if closed else 60)}[kind]
        line = at + size * ahead * np.exp(1j * np.linspace(gap, math.tau - gap, 25))
    return np.stack([line.real, line.imag], axis=-1)
