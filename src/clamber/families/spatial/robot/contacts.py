"""Contacts of limbs: what wrenches a foot, a gripper or a magnet can take, as rows of a polytope inside the exact body.

A wrench is that of the surface on the limb, in the contact's frame: normal (out of the surface, so pushing is positive), two tangents;
forces [N], then moments about the contact's point [N m]. A row says `coefficients + mu per_friction` times the wrench is at most
`limit . (1, pull, mu pull)`: friction mu and pull are the smaller ones of end effector and hold, so one row serves every hold.
"""

import math
from dataclasses import dataclass, field

import numpy as np

from ....types import Floats

FACETS = 8
"""Sides of the pyramid that stands for a friction cone; it lies inside: 90 % of the cone's section."""
MOST_ROWS = 32
"""Rows of a contact at most."""
SLIP, GRIP, MOMENT = range(3)
"""Margins that a row counts for."""

_NONE = (0.0,) * 6


@dataclass(frozen=True, slots=True, kw_only=True)
class Row:
    """One row of a contact's polytope."""

    coefficients: tuple[float, ...]
    """Of the wrench (normal, two tangents: force, then moment), shape (6,)."""
    per_friction: tuple[float, ...] = _NONE
    """What mu adds to them, shape (6,)."""
    limit: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Constant, per pull, per mu times pull."""
    slack: tuple[float, float] = (1.0, 0.0)
    """What a unit of s takes off the limit: per weight of the robot, and constant."""
    margin: int = SLIP
    """Which margin it counts for: `SLIP` and `GRIP` [N], `MOMENT` [N m]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Contact:
    """How a limb holds on, as statics needs it."""

    kind: str
    rows: tuple[Row, ...]
    friction: float
    """Coefficient of friction mu of the end effector [-]."""
    pull: float = 0.0
    """Largest pull along the normal [N]."""
    components: int = 3
    """Of its wrench: 3 without moments, 6 with."""
    aligned: bool = False
    """Whether postures have to put the end effector's z along the inward normal."""
    tilt: float = math.inf
    """Largest angle of the end effector's z from the inward normal [rad]."""
    tilt_loss: float = 0.0
    """Share of the pull that a radian of tilt costs [1/rad]."""
    exact: dict[str, float] = field(default_factory=dict)
    """Numbers of the body that the polytope lies in, for tests and pages."""

    def polytope(self, friction: float, pull: float) -> tuple[Floats, Floats]:
        """`A`, `b` of `A wrench <= b` at a hold of such friction and strength, shapes (rows, 6) and (rows,)."""
        mu, held = min(self.friction, friction), min(self.pull, pull)
        terms = np.array([1.0, held, mu * held])
        matrix = np.array([np.add(row.coefficients, mu * np.array(row.per_friction)) for row in self.rows])
        return matrix, np.array([float(np.dot(row.limit, terms)) for row in self.rows])


def cone(facets: int = FACETS, *, pulls: bool = False) -> tuple[Row, ...]:
    """Rows of a friction cone `|tangent| <= mu (normal + pull)` and of `normal >= -pull`, inscribed; without `pulls`, pull counts as 0."""
    inside = math.cos(math.pi / facets)
    sides = tuple(
        Row(
            coefficients=(0.0, math.cos(angle), math.sin(angle), 0.0, 0.0, 0.0),
            per_friction=(-inside, 0.0, 0.0, 0.0, 0.0, 0.0),
            limit=(0.0, 0.0, inside if pulls else 0.0),
        )
        for angle in (math.tau * k / facets for k in range(facets))
    )
    least = Row(coefficients=(-1.0, 0.0, 0.0, 0.0, 0.0, 0.0), limit=(0.0, 1.0 if pulls else 0.0, 0.0), margin=GRIP)
    return (*sides, least)


def point_foot(friction: float, facets: int = FACETS) -> Contact:
    """A foot that touches in a point: pushes only, within its friction cone."""
    return Contact(kind="point", rows=cone(facets), friction=friction)


def gripper(friction: float, pull: float, facets: int = FACETS) -> Contact:
    """A gripper on a hold as a point that also pulls: a friction cone whose apex lies at the pull-off force [N]."""
    return Contact(kind="gripper", rows=cone(facets, pulls=True), friction=friction, pull=pull)
