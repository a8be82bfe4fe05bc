"""A board: numbered holds on a vertical wall, and regions that no part of a robot may enter."""

import math
from bisect import bisect_left
from collections.abc import Container, Sequence
from itertools import pairwise
from operator import attrgetter
from typing import Annotated, Any, ClassVar, Final

import numpy as np
from pydantic import Field, StrictInt, StrictStr

from ....errors import UnknownHoldError
from ....files import Document, check_schema
from ....notebook import Pictured
from ....specs import Name, build_spec, spec
from ....tasks.regions import check_polygon
from ....types import Floats, Ints, Json
from ....units import (
    Angle,
    ConeAngle,
    Length,
    NonNegativeLength,
    Polygon,
    PositiveDensity,
    PositiveForce,
    PositiveLength,
    Quantity,
    Ratio,
)
from .scatter import DEFAULT_GAP, MOST_PACKED, GapError, scatter

AROUND = tuple((i, j) for i in (-1, 0, 1) for j in (-1, 0, 1))
"""A cell and its neighbours."""


def find_overlap(holds: "Sequence[Hold]") -> "tuple[Hold, Hold] | None":
    """Two holds of which parts coincide, None if there are none.

    Larger holds come first. Those of like size, within a factor of two, lie in the cells of one grid, twice as wide as the largest of them:
    what overlaps one of them lies in a neighbouring cell, and a cell has room for a few only, wherever the others are.
    """
    grids: dict[int, dict[tuple[int, int], list[Hold]]] = {}
    for hold in sorted(holds, key=lambda hold: -hold.radius):
        for size, cells in grids.items():
            column, row = _cell(hold, size)
            for i, j in AROUND:
                for other in cells.get((column + i, row + j), ()):
                    if math.hypot(hold.x - other.x, hold.y - other.y) < hold.radius + other.radius:
                        return other, hold
        size = math.frexp(hold.radius)[1]  # the radius is less than 2^size
        grids.setdefault(size, {}).setdefault(_cell(hold, size), []).append(hold)
    return None


def _cell(hold: "Hold", size: int) -> tuple[int, int]:
    wide = math.ldexp(2.0, size)
    return math.floor(hold.x / wide), math.floor(hold.y / wide)


SCHEMA: Final = "clamber-board-1"
MOST_HOLDS: Final = 100_000
"""Of a board: as many as the arrays of a stance are made for in some seconds; a climber's wall has some thousands."""
HoldRadius = Annotated[float, Quantity("length", at_least=1e-6)]
"""Radius [m], a micrometre or more."""

SHORT_KEYS: Final = {"spacing": "ladder.width", "rung": "ladder.spacing", "rungs": "ladder.rungs"}
"""How the climbing literature calls the distances of a ladder: holds apart across, and up -> keys of its board."""


@spec
class Hold:
    """One hold. World frame: x to the right, y up, on a vertical wall."""

    number: Annotated[int, Field(strict=True, ge=1, lt=2**31)]
    """Its name in plans; unique on the board."""
    x: Length
    """Centre [m]."""
    y: Length
    """Centre [m]."""
    radius: HoldRadius
    """Radius of the disc that stands for it; the board's `hold_radius` unless stated [m]."""
    direction: Angle | None = None
    """World direction about which it can be pulled [rad]; None: every direction."""
    cone: ConeAngle | None = None
    """Half angle about `direction` within which it holds [rad]."""
    strength: PositiveForce | None = None
    """Largest force it takes [N]; None: any."""


@spec
class Board(Pictured):
    """A wall with holds, in SI units, world frame."""

    kind: ClassVar[str] = "board"

    name: str
    title: str
    holds: tuple[Hold, ...]
    """Ordered by number; at least one."""
    keep_out: tuple[Polygon, ...] = ()
    """Corners of regions that neither body nor links may enter [m]."""

    def by_number(self, number: int) -> Hold:
        """The hold with this number.

        Raises:
            UnknownHoldError: If the board has none.
        """
        index = self.index_of(number)
        if index is None:
            raise UnknownHoldError(number, self.name, tuple(hold.number for hold in self.holds))
        return self.holds[index]

    def index_of(self, number: int) -> int | None:
        """Place of the hold with this number among `holds`; None: the board has none."""
        index = bisect_left(self.holds, number, key=attrgetter("number"))
        return index if index < len(self.holds) and self.holds[index].number == number else None

    def positions(self) -> Floats:
        """Centres of the holds [m], world frame, in the order of `holds`, shape (n_holds, 2)."""
        return np.array([(hold.x, hold.y) for hold in self.holds], dtype=np.float64).reshape(-1, 2)

    def places(self) -> dict[int, Floats]:
        """Number of each hold -> its centre, world frame, shape (2,) [m]."""
        return dict(zip(self.numbers().tolist(), self.positions(), strict=True))

    def numbers(self) -> Ints:
        """Numbers of the holds, in the order of `holds`, shape (n_holds,)."""
        return np.array([hold.number for hold in self.holds], dtype=np.int32)


@spec
class LadderSpec:
    """Generates two columns of holds: 1 at the origin, 2 to its right, 3 above 1, and so on."""

    rungs: Annotated[int, Field(strict=True, ge=1, le=10_000)]
    """Rows of two holds."""
    spacing: PositiveLength
    """Height between rows [m]."""
    width: PositiveLength
    """Distance of the columns [m]."""
    removed: tuple[StrictInt, ...] = ()
    """Numbers left out; the others keep theirs."""

    def holds(self, radius: float) -> tuple[Hold, ...]:
        """The holds, by number."""
        removed = frozenset(self.removed)
        return tuple(
            Hold(number=number, x=self.width * ((number - 1) % 2), y=self.spacing * ((number - 1) // 2), radius=radius)
            for number in range(1, 2 * self.rungs + 1)
            if number not in removed
        )


@spec
class GridSpec:
    """Generates a jittered grid, numbered row by row from the bottom left; some holds take pull only within a cone."""

    columns: Annotated[int, Field(strict=True, ge=1, le=1000)]
    """Holds side by side."""
    rows: Annotated[int, Field(strict=True, ge=1, le=1000)]
    """Holds above one another."""
    spacing: PositiveLength
    """Distance of neighbours before the jitter [m]."""
    jitter: NonNegativeLength = 0.0
    """Each coordinate moves by up to this much either way [m]."""
    seed: Annotated[int, Field(strict=True, ge=0)] = 0
    """The same seed gives the same board."""
    sloped: Ratio = 0.0
    """Share of holds that have a direction and a strength [-]; those point down, give or take `tilt`."""
    tilt: Angle = 0.0
    """Largest deviation of such a direction from straight down [rad]."""
    cone: ConeAngle = math.pi / 2
    """Half angle of such holds [rad]."""
    strength: PositiveForce | None = None
    """Largest force on such holds [N]."""

    def holds(self, radius: float) -> tuple[Hold, ...]:
        """The holds, by number."""
        # Every hold draws the same count of random numbers, so that the places do not depend on `sloped`.
        draws = np.random.default_rng(self.seed).random((self.rows * self.columns, 4))
        made = []
        for index, (dx, dy, share, lean) in enumerate(draws.tolist()):
            row, column = divmod(index, self.columns)
            is_sloped = share < self.sloped
            made.append(
                Hold(
                    number=index + 1,
                    x=column * self.spacing + (2.0 * dx - 1.0) * self.jitter,
                    y=row * self.spacing + (2.0 * dy - 1.0) * self.jitter,
                    radius=radius,
                    direction=-math.pi / 2 + (2.0 * lean - 1.0) * self.tilt if is_sloped else None,
                    cone=self.cone if is_sloped else None,
                    strength=self.strength if is_sloped else None,
                )
            )
        return tuple(made)


@spec
class RandomSpec:
    """Scatters holds at random over a rectangle whose lower left corner is the origin; its height follows from the density."""

    holds: Annotated[int, Field(strict=True, ge=1, le=MOST_HOLDS)]
    """How many."""
    density: PositiveDensity
    """Holds per area [1/m^2]."""
    width: PositiveLength | None = None
    """Of the wall [m]; None: as wide as high."""
    least_gap: NonNegativeLength | None = None
    """No two centres are closer [m]; None: half of the mean distance, 1 / sqrt(density)."""
    seed: Annotated[int, Field(strict=True, ge=0, lt=2**63)] = 0
    """The same seed gives the same board, on any machine."""

    @property
    def size(self) -> tuple[float, float]:
        """Width and height of the wall [m]."""
        area = self.holds / self.density
        width = math.sqrt(area) if self.width is None else self.width
        return width, area / width

    @property
    def gap(self) -> float:
        """The least distance of two centres [m]."""
        return DEFAULT_GAP / math.sqrt(self.density) if self.least_gap is None else self.least_gap

    def places(self) -> Floats:
        """Centres of the holds [m], from the bottom to the top in bands as high as the mean distance, left to right in each.

        Raises:
            GapError: If so many holds don't find room that far apart.
        """
        places = scatter(self.holds, *self.size, self.gap, self.seed)
        band = np.floor(places[:, 1] * math.sqrt(self.density))
        return places[np.lexsort((places[:, 1], places[:, 0], band))]


@spec
class BoardSpec:
    """What a board file says: holds one by one, or one generator."""

    name: Name
    title: StrictStr = ""
    source: StrictStr = ""
    """Where the places of the holds come from."""
    hold_radius: HoldRadius | None = None
    """Radius of every hold that states none [m]."""
    position_error: NonNegativeLength = 0.0
    """How well the places are known, either way [m]."""
    holds: tuple[Hold, ...] | None = None
    ladder: LadderSpec | None = None
    grid: GridSpec | None = None
    random: RandomSpec | None = None
    added: tuple[Hold, ...] = ()
    """Holds besides those that are listed or generated."""
    keep_out: tuple[Polygon, ...] = ()
    """Corners of regions that neither body nor links may enter [m]."""


def build_board(document: Document) -> Board:
    """A board from its document.

    Raises:
        SpecError: If the document breaks a rule of the format, or holds overlap or repeat.
    """
    check_schema(document, SCHEMA)
    stated = build_spec(BoardSpec, _with_radius(document), without=("schema",))
    given = [key for key in ("holds", "ladder", "grid", "random") if getattr(stated, key) is not None]
    if len(given) != 1:
        said = " and ".join(given) or "none"
        allowed = f"a board states exactly one of 'holds', [ladder], [grid], [random]; here: {said}"
        raise document.problem("holds", allowed)
    generator = stated.ladder or stated.grid or stated.random
    if generator is not None and stated.hold_radius is None:
        raise document.problem("hold_radius", "must be given beside a generator, such as '5 mm'")
    if stated.ladder is not None:
        most = 2 * stated.ladder.rungs
        for number in stated.ladder.removed:
            if not 1 <= number <= most:
                raise document.problem("ladder.removed", f"must be numbers from 1 to {most}; {number} is not")
    if stated.grid is not None and stated.grid.rows * stated.grid.columns > MOST_HOLDS:
        raise document.problem("grid", f"makes {stated.grid.rows * stated.grid.columns} holds; at most {MOST_HOLDS}")
    radius = stated.hold_radius or 0.0
    if stated.random is not None:
        holds: tuple[Hold, ...] | None = _random_holds(stated.random, radius, document)
    else:
        grown = stated.ladder or stated.grid
        holds = stated.holds if grown is None else grown.holds(radius)
    holds = tuple(sorted((*(holds or ()), *stated.added), key=lambda hold: hold.number))
    board = Board(name=stated.name, title=stated.title, holds=holds, keep_out=stated.keep_out)
    _check_holds(board, document, given[0], {hold.number for hold in stated.added})
    for index, polygon in enumerate(board.keep_out):
        check_polygon(polygon, document, f"keep_out.{index}")
    return board


def listed_board(document: Document) -> Json:
    """The document of a board with every hold in its list, in place of a generator of them."""
    if "holds" in document.data:
        return document.data
    kept = {key: value for key, value in document.data.items() if key not in ("ladder", "grid", "random")}
    made = build_board(Document(document.label, {**document.data, "added": []}, document.overrides, document.folder))
    rows = [
        {"number": hold.number, "x": f"{hold.x!r} m", "y": f"{hold.y!r} m", "radius": f"{hold.radius!r} m"}
        for hold in made.holds
    ]
    return {**kept, "holds": rows}


def _with_radius(document: Document) -> Document:
    """The document with `hold_radius` filled in wherever a hold states none."""
    radius = document.data.get("hold_radius")
    lists = {key: document.data[key] for key in ("holds", "added") if isinstance(document.data.get(key), list)}
    if not lists or radius is None:
        return document
    filled: dict[str, list[Any]] = {
        key: [{"radius": radius} | hold if isinstance(hold, dict) else hold for hold in holds]
        for key, holds in lists.items()
    }
    return Document(document.label, document.data | filled, document.overrides, document.folder)


def _random_holds(random: RandomSpec, radius: float, document: Document) -> tuple[Hold, ...]:
    """The holds of a random board, by number.

    Raises:
        SpecError: If they don't find room.
    """
    key = "random.density" if random.least_gap is None else "random.least_gap"
    most = math.sqrt(4.0 * MOST_PACKED / (math.pi * random.density))
    if random.gap > most:
        sparser = 4.0 * MOST_PACKED / (math.pi * random.gap**2)
        allowed = (
            f"{random.density:.4g} holds/m^2 leave room for gaps of at most {most:.4g} m, not {random.gap:.4g} m; "
            f"with such gaps the density must be at most {sparser:.4g} holds/m^2"
        )
        raise document.problem(key, allowed)
    if random.gap < 2.0 * radius:
        allowed = f"the gap is {random.gap:.4g} m, but holds of radius {radius:.4g} m overlap if closer than {2.0 * radius:.4g} m"
        raise document.problem(key, f"{allowed}; take a larger gap, a lower density or a smaller 'hold_radius'")
    try:
        places = random.places()
    except GapError as error:
        allowed = (
            f"only {error.placed} of {random.holds} holds found room {random.gap:.4g} m apart; make the gap smaller"
        )
        raise document.problem("random.least_gap", allowed) from None
    return tuple(Hold(number=number, x=x, y=y, radius=radius) for number, (x, y) in enumerate(places.tolist(), start=1))


def _check_holds(board: Board, document: Document, listed: str, added: Container[int]) -> None:
    holds = board.holds

    def key_of(first: int, second: int) -> str:
        own = [number for number in (first, second) if number in added]
        return f"added.{own[-1]}" if own else f"holds.{second}" if listed == "holds" else listed

    if not holds:
        raise document.problem(listed, "the board has no holds; it needs at least one")
    if len(holds) > MOST_HOLDS:
        raise document.problem(listed, f"makes {len(holds)} holds; at most {MOST_HOLDS}")
    for before, after in pairwise(holds):
        if before.number == after.number:
            key = "added" if after.number in added else listed
            raise document.problem(key, f"hold numbers must differ; {after.number} is there twice")
    for hold in holds:
        if (hold.direction is None) != (hold.cone is None):
            key = "added" if hold.number in added else listed
            raise document.problem(f"{key}.{hold.number}", "states 'direction' and 'cone' both or neither")
    overlap = find_overlap(holds)
    if overlap is not None:
        a, b = sorted(overlap, key=lambda hold: hold.number)
        sizes = f"{math.hypot(b.x - a.x, b.y - a.y):.4g} m apart, radii {a.radius:.4g} and {b.radius:.4g} m"
        raise document.problem(key_of(a.number, b.number), f"holds {a.number} and {b.number} overlap: {sizes}")
