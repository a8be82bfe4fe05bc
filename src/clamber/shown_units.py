"""Units in which people are shown quantities: those that the files at hand are written in, unless `--units` says otherwise."""

from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Final

from .units import DEGREE, INCH, OUNCE_FORCE, OZ_IN, split_quantity

Unit = tuple[str, float, int]
"""Name, size in SI units, and usual decimals."""


@dataclass(frozen=True, slots=True)
class ShownUnits:
    """A system of units, each quantity in the unit that its sizes are read in."""

    name: str
    place: Unit
    """Of places and moves."""
    gap: Unit
    """Of small lengths: margins, errors."""
    torque: Unit
    force: Unit

    def of(self, unit: str) -> Unit:
        """How a quantity is shown that is known in an SI unit, such as a margin in the unit of its check; lengths as gaps."""
        shown = {"m": self.gap, "N m": self.torque, "N": self.force, "rad": ("deg", DEGREE, 1), "1": ("", 1.0, 0)}
        return shown.get(unit, (unit, 1.0, 2))

    def signed(self, value: float, unit: str, digits: int = 4) -> str:
        """A margin with its sign and unit, such as "+2.35 in"."""
        name, size, _ = self.of(unit)
        return f"{value / size + 0.0:+.{digits}g} {name}".rstrip()

    def length(self, metres: float, digits: int = 4) -> str:
        """A length with its unit: of a place or a size."""
        return f"{metres / self.place[1] + 0.0:.{digits}g} {self.place[0]}"

    def small(self, metres: float, decimals: int | None = None) -> str:
        """A small length with its unit: of an error or a gap."""
        name, size, usual = self.gap
        return f"{metres / size + 0.0:.{usual if decimals is None else decimals}f} {name}"


SI: Final = ShownUnits("si", ("cm", 0.01, 1), ("mm", 1e-3, 0), ("N m", 1.0, 2), ("N", 1.0, 1))
IMPERIAL: Final = ShownUnits(
    "imperial", ("in", INCH, 2), ("in", INCH, 2), ("oz-in", OZ_IN, 0), ("lbf", 16 * OUNCE_FORCE, 2)
)
_IMPERIAL: Final = frozenset(
    {"in", "inch", "inches", "ft", "foot", "oz-in", "ozf-in", "lbf-in", "lbf-ft", "lbf", "lb", "oz"}
)
_METRIC: Final = frozenset({"m", "cm", "mm", "N m", "Nm", "mN m", "N", "kg", "g"})
_chosen: list[ShownUnits] = []


def choose(name: str | None) -> None:
    """Have all quantities shown in a system of this name; None: in that of the files again."""
    _chosen[:] = [system for system in (SI, IMPERIAL) if system.name == name]


def units_of(document: Mapping[str, Any]) -> ShownUnits:
    """The chosen system, or the one in which most quantities are written of a task, else of its world, else of its robot.

    Args:
        document: A task's, with robot and world in place of their names, or that of a robot or a world.
    """
    if _chosen:
        return _chosen[0]
    parts = {key: value for key, value in document.items() if isinstance(value, Mapping) and "schema" in value}
    robot = parts.pop("robot", {})
    own = {key: value for key, value in document.items() if key not in {*parts, "robot", "labels"}}
    for part in (own, parts, robot):
        votes = Counter(_systems(part))
        if votes:
            return max((SI, IMPERIAL), key=lambda system: votes[system.name])
    return SI


def _systems(part: Any) -> Iterator[str]:
    """The system of each quantity of a document."""
    if isinstance(part, Mapping):
        for key, value in part.items():
            yield from _systems_of_unit(value) if key == "unit" else _systems(value)
    elif isinstance(part, list | tuple):
        for value in part:
            yield from _systems(value)
    elif isinstance(part, str) and part[:1] in "+-.0123456789" and (parts := split_quantity(part)) is not None:
        yield from _systems_of_unit(parts[1])


def _systems_of_unit(unit: Any) -> Iterator[str]:
    if unit in _IMPERIAL:
        yield IMPERIAL.name
    elif unit in _METRIC:
        yield SI.name
