"""One limb that carries: its torques, the branch it takes, and what balance asks (docs/model.md, sections 6 and 7)."""

import math
from dataclasses import dataclass
from typing import Any

from .kinematics import EPS, Option, Point


@dataclass(frozen=True)
class Carrier:
    """A limb that carries: where, with which branches, against which limits."""

    index: int
    """Number of the limb, from 0."""
    limb: Any
    hold: Any
    r: Point
    """Hold minus body origin [m]."""
    port: Point
    options: list[Option]
    """The branches it may take."""
    limits: tuple[float, float]
    """Torque limits of shoulder and elbow [N m]."""

    @property
    def place(self) -> Point:
        return self.hold.x, self.hold.y


def cross(a: Point, b: Point) -> float:
    return a[0] * b[1] - a[1] * b[0]


def torques(carrier: Carrier, o: Option, force: Point) -> tuple[float, float]:
    """Shoulder and elbow torque [N m] under the force of the hold on the limb [N]."""
    px, py = carrier.place
    shoulder = -cross((px - carrier.port[0], py - carrier.port[1]), force)
    elbow = -cross((px - o.elbow[0], py - o.elbow[1]), force)
    return shoulder, elbow


def torque_rows(carrier: Carrier, o: Option) -> list[list[float]]:
    """Both torques as rows over (Fx, Fy), each divided by its limit [1/N]."""
    unit_x, unit_y = torques(carrier, o, (1.0, 0.0)), torques(carrier, o, (0.0, 1.0))
    return [[unit_x[j] / carrier.limits[j], unit_y[j] / carrier.limits[j]] for j in (0, 1)]


def best_option(carrier_torques: list[tuple[Option, tuple[float, float]]]) -> Option:
    """The branch taken: least larger torque, then grab direction further down, then least elbow torque, then 0."""
    first, *rest = sorted(carrier_torques, key=lambda item: item[0].branch)
    for other in rest:
        larger = [max(abs(t) for t in item[1]) for item in (first, other)]
        sine = [math.sin(item[0].grab_angle) for item in (first, other)]
        elbow = [abs(item[1][1]) for item in (first, other)]
        if abs(larger[0] - larger[1]) >= EPS:
            better = larger[1] < larger[0]
        elif abs(sine[0] - sine[1]) > EPS:
            better = sine[1] < sine[0]
        elif abs(elbow[0] - elbow[1]) > EPS:
            better = elbow[1] < elbow[0]
        else:
            better = False
        if better:
            first = other
    return first[0]


def general_split(a: Carrier, b: Carrier, weight: float) -> list[tuple[Point, Point]] | None:
    """Both forces as (constant, per lambda) pairs of vectors, or None when the holds coincide.

    F_a = f_a n + (W u_y/2 + lam) u and F_b = (W n_y - f_a) n + (W u_y/2 - lam) u.
    """
    (ax, ay), (bx, by) = a.place, b.place
    d = math.hypot(bx - ax, by - ay)
    if d < EPS:
        return None
    ux, uy = (bx - ax) / d, (by - ay) / d
    nx, ny = -uy, ux
    f_a = weight * b.r[0] / d
    f_b = weight * ny - f_a
    half = weight * uy / 2.0
    return [
        ((f_a * nx + half * ux, f_a * ny + half * uy), (ux, uy)),
        ((f_b * nx + half * ux, f_b * ny + half * uy), (-ux, -uy)),
    ]


def balance(carriers: list[Carrier], weight: float) -> tuple[list[list[float]], list[float]]:
    """Sum of forces and moment about the origin over all (Fx, Fy): rows and right side."""
    n = len(carriers)
    moment = [x for c in carriers for x in (-c.r[1], c.r[0])]
    return [[1.0, 0.0] * n, [0.0, 1.0] * n, moment], [0.0, weight, 0.0]


def placed(row: Any, carrier: int, n: int) -> list[float]:
    """A row over one carrier's (Fx, Fy) as a row over everybody's."""
    wide = [0.0] * (2 * n)
    wide[2 * carrier : 2 * carrier + 2] = list(row)
    return wide


def strength_of(limb: Any, hold: Any) -> float | None:
    """What end effector and hold both take [N], or None for any force."""
    stated = [one for one in (limb.end.strength, hold.strength) if one is not None]
    return min(stated) if stated else None


def strength_rows(strength: float | None) -> tuple[list[Point], float]:
    """Sides of the 16-gon inscribed in |F| <= strength (first corner at angle 0): outward normals, distance."""
    if strength is None:
        return [], math.inf
    normals = [(math.cos((k + 0.5) * math.pi / 8.0), math.sin((k + 0.5) * math.pi / 8.0)) for k in range(16)]
    return normals, strength * math.cos(math.pi / 16.0)
