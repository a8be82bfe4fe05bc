"""A way's pieces: straight, a turn, a body twist for a time, to a place, through places one after another."""

import math
from typing import Final

import numpy as np
from pydantic import StrictStr

from ....files import Document
from ....specs import field_names, spec
from ....types import Floats
from ....units import Angle, AngularSpeed, Length, Point, PositiveLength, PositiveTime, Speed

KINDS: Final[dict[str, tuple[str, ...]]] = {
    "direction": ("direction", "distance"),
    "turn": ("turn",),
    "twist": ("twist", "lasts"),
    "to": ("to",),
    "through": ("through",),
    "ditch": ("ditch", "ahead"),
}
"""Kind of a piece, by a key of its own -> all that it must state."""
OPTIONS: Final = {"about": "turn", "heading": "to", "path": "through", "along": "ditch"}
"""Key that a piece may have besides -> kind that has it."""


@spec
class BodyTwist:
    """Velocity of the Delta-frame, seen from itself."""

    vx: Speed = 0.0
    """Ahead [m/s]."""
    vy: Speed = 0.0
    """To its left [m/s]."""
    omega: AngularSpeed = 0.0
    """Anticlockwise [rad/s]."""

    def rates(self) -> Floats:
        """All three [m/s], [rad/s], shape (3,)."""
        return np.array((self.vx, self.vy, self.omega))


@spec
class Stop:
    """A place that a path leads through."""

    x: Length
    """World [m]."""
    y: Length
    """[m]."""
    heading: Angle | None = None
    """World [rad]; that of the place before unless given."""


@spec
class Piece:
    """A piece of the way: direction and distance, turn, twist and lasts, to, through, path, or ditch and ahead."""

    direction: Angle | None = None
    """Seen from the Delta-frame; the heading is kept [rad]."""
    distance: PositiveLength | None = None
    """Over ground, seen from above [m]."""
    turn: Angle | None = None
    """Of the heading [rad]."""
    about: Point | None = None
    """Point that it turns about, in the Delta-frame as it is then; on the spot unless given [m]."""
    twist: BodyTwist | None = None
    """Where the robot goes: the way that this velocity covers in `lasts`. It goes there at its own pace."""
    lasts: PositiveTime | None = None
    """[s]."""
    to: Point | None = None
    """Place in the world, reached straight or after a pivot, whichever takes less time [m]."""
    heading: Angle | None = None
    """At that place, world frame; any unless given [rad]."""
    through: tuple[Stop, ...] | None = None
    """Places in the world, one after another: straight where the heading is kept, else in arcs."""
    path: StrictStr | None = None
    """CSV file with such places in its columns x, y and perhaps heading; they are read into `through` when the walk is loaded."""

    ditch: PositiveLength | None = None
    """Width of a straight ditch to be crossed [m]; both frames end behind it."""
    ahead: PositiveLength | None = None
    """How far ahead of the Delta-frame's origin its near edge is [m] ..."""
    along: Angle | None = None
    """... in this direction, seen from the Delta-frame, which the ditch lies across; 0 unless given [rad]."""

    def whole_twist(self) -> Floats:
        """What the Delta-frame does, in its own frame: x, y [m] and heading [rad], each at a constant rate, shape (3,).

        Not of `to`, `through` and `ditch`, which depend on where the robot is.
        """
        if self.twist is not None:
            assert self.lasts is not None
            return self.lasts * self.twist.rates()
        if self.turn is not None:
            x, y = (0.0, 0.0) if self.about is None else self.about
            return self.turn * np.array((y, -x, 1.0))
        assert self.direction is not None and self.distance is not None
        return self.distance * np.array((math.cos(self.direction), math.sin(self.direction), 0.0))

    def poses(self, heading: float) -> Floats:
        """Poses of the Delta-frame at the places of `through`: x, y [m], heading [rad], shape (n, 3).

        Args:
            heading: That it comes with [rad].
        """
        assert self.through is not None
        out = np.empty((len(self.through), 3))
        for k, stop in enumerate(self.through):
            heading = heading if stop.heading is None else stop.heading
            out[k] = stop.x, stop.y, heading
        return out


def check_way(way: tuple[Piece, ...], document: Document) -> None:
    """Makes sure that there is a way, and that each piece states one thing, wholly.

    Raises:
        SpecError: If not; it names the piece.
    """
    if not way:
        raise document.problem("way", "must have a piece or more")
    for i, piece in enumerate(way):
        _check_piece(piece, f"way.{i}", document)
        if piece.ditch is not None and len(way) > 1:
            raise document.problem(f"way.{i}", "must be the only piece: a ditch is crossed from where the walk starts")


def _check_piece(piece: Piece, at: str, document: Document) -> None:
    given = {name for name in field_names(Piece) if getattr(piece, name) is not None}
    kinds = [kind for kind, needs in KINDS.items() if given & set(needs)]
    if len(kinds) != 1:
        raise document.problem(
            at,
            "must state one of: direction and distance, turn, twist and lasts, to, through, path, or ditch and ahead",
        )
    kind = kinds[0]
    missing = set(KINDS[kind]) - given
    if missing:
        raise document.problem(at, f"must state both {' and '.join(KINDS[kind])}")
    for option, owner in OPTIONS.items():
        if option in given and owner != kind:
            raise document.problem(f"{at}.{option}", f"is for a piece with '{owner}', and this one has '{kind}'")
    if piece.turn == 0.0:
        raise document.problem(f"{at}.turn", "must not be 0")
    if piece.twist is not None and not piece.twist.rates().any():
        raise document.problem(f"{at}.twist", "must not be 0: state vx, vy or omega")
    if piece.through == ():
        raise document.problem(f"{at}.through", "must have a place or more")
