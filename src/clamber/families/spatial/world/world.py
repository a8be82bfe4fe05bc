"""A world in space: holds as points with normals, solid things that links must miss, gravity, and a guide that bodies go along."""

import math
from collections.abc import Iterable
from dataclasses import field
from functools import lru_cache
from typing import Annotated, Any, ClassVar, Final, Literal

import numpy as np
from pydantic import Field, StrictStr

from ....errors import UnknownHoldError
from ....files import Document, check_schema
from ....notebook import Pictured
from ....specs import Name, build_spec, spec
from ....types import Floats, Records
from ....units import (
    GRAVITY,
    NonNegativeRatio,
    Place,
    PositiveForce,
    Quantity,
)
from .fields import DistanceField, distance_field
from .guide import Waypoint, guide_frames
from .patterns import Pattern, Seed
from .solids import SOLID, Direction, Solid, check_direction, solid_record, unit
from .terrain import Terrain, check_terrain, holds_on

SCHEMA: Final = "clamber-world-1"
MOST_HOLDS: Final = 60_000
"""Of a world: keys of stances keep a hold's index in 16 bits."""
LOOSE: Final = 1.1
"""How far an estimate of the number of holds may be off [-]."""
BODIES: Final = {"earth": GRAVITY, "moon": 1.625, "mars": 3.728, "none": 0.0}
"""Free fall at the surface [m/s^2]: standard gravity; Moon and Mars after NASA's fact sheets; weightless."""
Acceleration = Annotated[float, Quantity("acceleration")]
Ends = Annotated[float, Quantity("length", at_least=1e-4)]


@spec
class Hold:
    """A place that an end effector can take."""

    number: Annotated[int, Field(strict=True, ge=1, le=MOST_HOLDS)]
    """Its name in plans."""
    at: Place
    """World frame."""
    normal: Direction
    """Out of the surface."""
    friction: NonNegativeRatio | None = None
    """Coefficient of the surface; None: that of the end effector's data sheet. The smaller of both counts."""
    strength: PositiveForce | None = None
    """Largest force of any direction that the hold bears [N]; None: any."""
    radius: Ends = 0.01
    """Of the patch that is drawn about its place [m]; no check reads it: whether an end effector fits is the model's maker to say."""

    @property
    def x(self) -> float:
        """World frame [m]."""
        return self.at[0]

    @property
    def y(self) -> float:
        """World frame [m]."""
        return self.at[1]

    @property
    def z(self) -> float:
        """World frame [m]."""
        return self.at[2]


@spec
class WorldSpec:
    """What a world's file says."""

    name: Name
    title: StrictStr = ""
    source: StrictStr = ""
    gravity: Literal["earth", "moon", "mars", "none"] | tuple[Acceleration, Acceleration, Acceleration] = "earth"
    """Of a body, straight down along z; or a vector, such as that of a tilted wall."""
    holds: tuple[Hold, ...] = ()
    patterns: tuple[Pattern, ...] = ()
    """Holds that are generated, numbered after those that are listed."""
    seed: Seed = 0
    """Added to the seeds of the patterns: another world of the same kind."""
    terrain: tuple[Terrain, ...] = ()
    """Surfaces from files, with the holds that limbs find on them, numbered after all others."""
    solids: tuple[Solid, ...] = ()
    guide: tuple[Waypoint, ...]
    """Corners of the path that bodies go along."""


@spec
class World(Pictured):
    """A world with everything resolved, SI, world frame."""

    kind: ClassVar[str] = "world"

    name: str
    title: str
    gravity: tuple[float, float, float]
    """Acceleration of free fall [m/s^2]."""
    holds: tuple[Hold, ...]
    """By number, from 1 without a gap."""
    solids: tuple[Any, ...]
    guide: tuple[Waypoint, ...]
    """Corners of the path that bodies go along."""
    fields: tuple[DistanceField, ...] = field(default=(), compare=False)
    """Of terrains that are solid; `solid_records` has them after the solids."""
    places: Floats = field(init=False, compare=False, repr=False)
    """Of the holds [m], shape (n, 3); not to be written."""
    normals: Floats = field(init=False, compare=False, repr=False)
    """Of the holds, unit, shape (n, 3); not to be written."""

    def __post_init__(self) -> None:
        """Gather what is asked for at every tick."""
        places = np.array([hold.at for hold in self.holds], np.float64).reshape(-1, 3)
        normals = np.array([unit(hold.normal) for hold in self.holds], np.float64).reshape(-1, 3)
        for name, rows in (("places", places), ("normals", normals)):
            rows.setflags(write=False)
            object.__setattr__(self, name, rows)

    @property
    def frames(self) -> Floats:
        """Of the guide, every `guide.GRAIN` of its length, shape (n, 12)."""
        return _frames(self.guide)

    def by_number(self, number: int) -> Hold:
        """The hold of a number.

        Raises:
            UnknownHoldError: If there is none.
        """
        if 1 <= number <= len(self.holds):
            return self.holds[number - 1]
        raise UnknownHoldError(number, self.name, tuple(range(1, len(self.holds) + 1)))

    @property
    def solid_records(self) -> Records:
        """Records of `solids.SOLID`."""
        rows = np.zeros(len(self.solids) + len(self.fields), SOLID)
        for k, record in enumerate((*map(solid_record, self.solids), *(one.record for one in self.fields))):
            rows[k] = record
        return rows


def build_world(document: Document) -> World:
    """The world of a document.

    Raises:
        SpecError: If the document says something that cannot be used.
    """
    check_schema(document, SCHEMA)
    stated = build_spec(WorldSpec, document, without=("schema",))
    if len(stated.guide) < 2:
        raise document.problem("guide", "must have two points or more")
    frames = guide_frames(stated.guide, document)
    holds = list(stated.holds)
    for k, hold in enumerate(holds):
        if hold.number != k + 1:
            raise document.problem(f"holds.{k}.number", f"must be {k + 1}: holds are numbered in order, from 1")
        check_direction(document, f"holds.{k}.normal", hold.normal)
    for k, pattern in enumerate(stated.patterns):
        if pattern.on is not None:
            check_direction(document, f"patterns.{k}.on.normal", pattern.on.normal, pattern.on.x)
        if len(holds) + pattern.grid > LOOSE * MOST_HOLDS:  # before they are made, which takes long
            allowed = f"makes about {pattern.grid:.0f} holds; a world may have {MOST_HOLDS}"
            raise document.problem(f"patterns.{k}.spacing", allowed)
        holds += _numbered(pattern.points(frames, stated.seed), pattern, len(holds))
        if len(holds) > MOST_HOLDS:
            raise document.problem("patterns", f"make more than {MOST_HOLDS} holds, the most that a world may have")
    for k, terrain in enumerate(stated.terrain):
        check_terrain(terrain, f"terrain.{k}", document)
        holds += _numbered(zip(*holds_on(terrain), strict=True), terrain, len(holds))
        if len(holds) > MOST_HOLDS:
            allowed = f"makes {len(holds)} holds with all before it; a world may have {MOST_HOLDS}"
            raise document.problem(f"terrain.{k}.spacing", allowed)
    for k, solid in enumerate(stated.solids):
        _check_solid(solid, f"solids.{k}", document)
    gravity = stated.gravity
    return World(
        name=stated.name,
        title=stated.title,
        gravity=(0.0, 0.0, -BODIES[gravity]) if isinstance(gravity, str) else gravity,
        holds=tuple(holds),
        solids=stated.solids,
        guide=stated.guide,
        fields=tuple(distance_field(one) for one in stated.terrain if one.solid and one.kind != "points"),
    )


def _numbered(found: Iterable[tuple[Floats, Floats]], of: Pattern | Terrain, before: int) -> list[Hold]:
    """Holds at places with normals that a pattern or a terrain has, numbered after those before."""
    return [
        Hold(
            number=number,
            at=tuple(place.tolist()),
            normal=tuple(normal.tolist()),
            friction=of.friction,
            strength=of.strength,
            radius=of.radius,
        )
        for number, (place, normal) in enumerate(found, before + 1)
    ]


@lru_cache(maxsize=64)
def _frames(guide: tuple[Waypoint, ...]) -> Floats:
    made = guide_frames(guide, Document("guide", {}))
    made.setflags(write=False)
    return made


def _check_solid(solid: Any, key: str, document: Document) -> None:
    if solid.kind == "plane":
        check_direction(document, f"{key}.normal", solid.normal)
    if solid.kind in ("cylinder", "tube", "bar") and not math.dist(solid.at, solid.to) > 0.0:
        raise document.problem(f"{key}.to", "must differ from 'at'")
    if solid.kind == "box":
        check_direction(document, f"{key}.z", solid.z, solid.x)
