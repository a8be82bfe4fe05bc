"""Contacts of limbs: what wrenches a foot, a gripper or a magnet can take, as rows of a polytope inside the exact body.

A wrench is that of the surface on the limb, in the contact's frame: normal (out of the surface, so pushing is positive), two tangents;
forces [N], then moments about the contact's point [N m]. A row says `coefficients + mu per_friction` times the wrench is at most
`limit . (1, pull, mu pull)`: friction mu and pull are the smaller ones of end effector and hold, so one row serves every hold.
"""

import math
from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np

from ....types import Floats

FACETS = 8
"""Sides of the pyramid that stands for a friction cone; it lies inside: 90 % of the cone's section."""
MOST_ROWS = 32
"""Rows of a contact at most."""
SHUTTING = 0.4
"""Jaws that centre themselves take that long to shut, chosen: quicker ones tear at the other limbs through the inertia of the gears [s]."""
SLIP, GRIP, MOMENT = range(3)
"""Margins that a row counts for."""

Form: TypeAlias = Literal["cone", "pad", "hook", "spine"]
_NONE = (0.0,) * 6


def line(**components: float) -> tuple[float, ...]:
    """Six coefficients of a wrench by name: `n`, `f1`, `f2`, `mn`, `m1`, `m2`; the others are 0."""
    return tuple(components.get(name, 0.0) for name in ("n", "f1", "f2", "mn", "m1", "m2"))


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

    def polytope(self, friction: float, pull: float) -> tuple[Floats, Floats]:
        """`A`, `b` of `A wrench <= b` at a hold of such friction and strength, shapes (rows, 6) and (rows,)."""
        mu, held = min(self.friction, friction), min(self.pull, pull)
        terms = np.array([1.0, held, mu * held])
        matrix = np.array([np.add(row.coefficients, mu * np.array(row.per_friction)) for row in self.rows])
        return matrix, np.array([float(np.dot(row.limit, terms)) for row in self.rows])


@dataclass(frozen=True, slots=True, kw_only=True)
class Strength:
    """The exact body of wrenches that an end effector bears, which the rows of its `Contact` lie in, and when it attaches at all."""

    form: Form
    """Cone: |tangent| <= mu (normal + pull). Pad: the same, with moments that peel and twist it off. Hook and spine: as their rows say."""
    friction: float
    """Coefficient mu [-]."""
    pull: float = 0.0
    """Largest pull along the normal; of hooks the largest force, of spines the largest draw [N]."""
    press: float = math.inf
    """Largest push [N]."""
    bending: float = math.inf
    """Largest moment across the normal, of a cone that bears moments [N m]."""
    twisting: float = math.inf
    """Largest moment about the normal, of a cone that bears moments [N m]."""
    halves: tuple[float, float] = (0.0, 0.0)
    """Half the length and width of a pad [m]."""
    angle: float = 0.0
    """Of hooks and spines [rad]."""
    moments: bool = False
    """Whether it holds its direction, too."""
    capture: float = 0.0
    """It attaches beside a hold's patch by no more than this [m]; 0: it only pushes."""
    centring: float = 0.0
    """As it shuts, it draws itself to the hold's own place from no further than this [m]; 0: it stays where it attaches."""
    bar: bool = False
    """Whether it centres across the bar alone that it hangs on, and stays where it is along that."""
    jaws: float = 0.0
    """It attaches anywhere within so much along the hold's normal, and stays there as it centres [m]; 0: on the hold's surface."""
    tilt: float = math.inf
    """Largest angle of its z from the inward normal at which it attaches [rad]."""
    tilt_loss: float = 0.0
    """Share of the pull that a radian of tilt costs [1/rad]."""

    def contact(self, kind: str) -> Contact:
        """How a limb of such a kind holds on."""
        if self.form == "pad":
            rows = pad(*self.halves)
        elif self.form == "hook":
            rows = hook_rows(self.angle, self.friction)
        elif self.form == "spine":
            rows = spine_rows(self.angle)
        else:
            rows = (*cone(), *at_most(self.press), *(moments(self.bending, self.twisting) if self.moments else ()))
        return Contact(
            kind=kind,
            rows=rows,
            friction=self.friction,
            pull=self.pull,
            components=6 if self.moments else 3,
            aligned=self.moments or self.form == "hook",
            tilt=self.tilt,
            tilt_loss=self.tilt_loss,
        )


def cone() -> tuple[Row, ...]:
    """Rows of a friction cone `|tangent| <= mu (normal + pull)` and of `normal >= -pull`, inscribed."""
    inside = math.cos(math.pi / FACETS)
    sides = tuple(
        Row(
            coefficients=line(f1=math.cos(angle), f2=math.sin(angle)),
            per_friction=line(n=-inside),
            limit=(0.0, 0.0, inside),
        )
        for angle in (math.tau * k / FACETS for k in range(FACETS))
    )
    return (*sides, Row(coefficients=line(n=-1.0), limit=(0.0, 1.0, 0.0), margin=GRIP))


def at_most(press: float) -> tuple[Row, ...]:
    """The row that no more than `press` [N] pushes; none where nothing limits it."""
    if press == math.inf:
        return ()
    return (Row(coefficients=line(n=1.0), limit=(press, 0.0, 0.0), margin=GRIP),)


def moments(bending: float, twisting: float) -> tuple[Row, ...]:
    """Rows of moments across the normal of at most `bending` in any direction, inscribed, and about it of at most `twisting` [N m]."""
    inside = bending * math.cos(math.pi / FACETS)
    bends = tuple(
        Row(
            coefficients=line(m1=math.cos(angle), m2=math.sin(angle)),
            limit=(inside, 0.0, 0.0),
            slack=(0.0, inside),
            margin=MOMENT,
        )
        for angle in (math.tau * k / FACETS for k in range(FACETS))
    )
    twists = tuple(
        Row(coefficients=line(mn=sign), limit=(twisting, 0.0, 0.0), slack=(0.0, twisting), margin=MOMENT)
        for sign in (1.0, -1.0)
    )
    return (*bends, *twists)


def pad(half1: float, half2: float) -> tuple[Row, ...]:
    """Rows of a rectangle that pushes, rubs and pulls all over, half as long along the tangents as `half1` and `half2` [m].

    What its surface feels is the wrench with the pull added to the normal force: any pressure and friction within the rectangle. For
    friction pyramids of four sides these rows are exact (Caron, Pham and Nakamura 2015, "Stability of Surface Contacts for Humanoid Robots:
    Closed-Form Formulae of the Contact Wrench Cone for Rectangular Support Areas"); the pyramid lies in the cone.
    """
    inside = math.sqrt(0.5)
    around = inside * (half1 + half2)
    signs = (1.0, -1.0)
    slides = [
        Row(coefficients=tangent, per_friction=line(n=-inside), limit=(0.0, 0.0, inside))
        for sign in signs
        for tangent in (line(f1=sign), line(f2=sign))
    ]
    tips = [
        Row(coefficients=moment, limit=(0.0, half, 0.0), slack=(half, 0.0), margin=MOMENT)
        for sign in signs
        for half, moment in ((half2, line(n=-half2, m1=sign)), (half1, line(n=-half1, m2=sign)))
    ]
    twists = [
        Row(
            coefficients=line(mn=turn, f1=a * half2, f2=b * half1),
            per_friction=line(n=-around, m1=turn * a * inside, m2=turn * b * inside),
            limit=(0.0, 0.0, around),
            slack=(0.5 * around, 0.0),
            margin=MOMENT,
        )
        for turn in signs
        for a in signs
        for b in signs
    ]
    return (*slides, *tips, *twists, Row(coefficients=line(n=-1.0), limit=(0.0, 1.0, 0.0), margin=GRIP))


def hook_rows(opening: float, friction: float) -> tuple[Row, ...]:
    """Rows of a hook over a bar (first tangent along the bar, normal out of what it hangs on).

    It slides along the bar by friction, leaves its bed beyond the half angle `opening` [rad] across it, and bears the pull as its strength.
    """
    facets = 2 * FACETS
    inside = math.cos(math.pi / facets)
    across = math.tan(opening)
    strength = inside / math.hypot(1.0, friction)  # the force along the bar is at most mu times the normal one
    slides = [Row(coefficients=line(f1=sign), per_friction=line(n=-1.0)) for sign in (1.0, -1.0)]
    leaves = [Row(coefficients=line(f2=sign, n=-across), margin=GRIP) for sign in (1.0, -1.0)]
    breaks = [
        Row(
            coefficients=line(n=math.cos(angle), f2=math.sin(angle)),
            limit=(0.0, strength, 0.0),
            margin=GRIP,
        )
        for angle in (math.tau * k / facets for k in range(-(facets // 4), facets // 4 + 1))
        if abs(angle) <= opening + math.pi / facets
    ]
    return (*slides, *leaves, *breaks)


def spine_rows(angle: float) -> tuple[Row, ...]:
    """Rows of spines that hook into roughness when they are drawn along the first tangent (the force on them is along it).

    Drawn, they also pull, up to `tan(angle)` times the draw, and bear the pull as their strength along the tangent; else they rub.
    """
    hold = math.tan(angle)
    inside = math.cos(math.pi / FACETS)
    drawn = [
        Row(coefficients=line(n=-1.0, f1=-hold), margin=GRIP),
        Row(coefficients=line(f1=1.0), limit=(0.0, 1.0, 0.0), margin=GRIP),
    ]
    aside = [Row(coefficients=line(f2=sign), per_friction=line(n=-inside, f1=-inside * hold)) for sign in (1.0, -1.0)]
    back = [
        Row(coefficients=line(f1=math.cos(turn), f2=math.sin(turn)), per_friction=line(n=-inside))
        for turn in (math.tau * k / FACETS for k in range(FACETS // 4 + 1, FACETS - FACETS // 4))
    ]
    return (*drawn, *aside, *back)
