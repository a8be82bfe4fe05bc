"""Widths of model errors by name: kinds, and how texts such as "friction=30%" change them."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Final

from ..errors import StatedError, UnitError, describe_choices
from ..units import DEGREE, parse_quantity

SETS: Final = ("usual", "none")
"""Names of sets of widths."""
SHOWN: Final = {"length": ("mm", 1e-3), "angle": ("deg", DEGREE), "ratio": ("%", 0.01), "force": ("N", 1.0)}
"""Dimension -> the unit in which it is usually shown, and that in SI."""


class NoiseError(StatedError):
    """A range that cannot be: names the key, the value and what is allowed."""

    says = "noise: {key} = {value}: {allowed}"
    key: str
    value: object
    allowed: str


@dataclass(frozen=True, slots=True, kw_only=True)
class NoiseKind:
    """One property of robot or board that is not as believed."""

    dimension: str
    unit: str = ""
    """In which it is shown; that of `SHOWN` unless stated."""
    scale: float = 0.0
    """Of that unit, in SI."""
    width: float
    """Usual largest deviation, either way, in SI."""
    words: str
    """What deviates."""
    below_one: bool = False
    """Whether it is a share that must not take all away."""
    many: bool = False
    """Whether each peg or joint has its own."""

    def __post_init__(self) -> None:
        if not self.unit:
            for key, usual in zip(("unit", "scale"), SHOWN[self.dimension], strict=True):
                object.__setattr__(self, key, usual)

    def shown(self, value: float) -> str:
        """A value in the unit, such as "6.35 mm"."""
        return f"{value / self.scale:.4g} {self.unit}"


def read_widths(kinds: Mapping[str, NoiseKind], widths: Mapping[str, float], texts: Iterable[str]) -> dict[str, float]:
    """Widths of these kinds changed by texts, as `read_noise` does it.

    Raises:
        NoiseError: If there is no such key, or its width cannot be.
    """
    changed = dict(widths)
    for text in texts:
        key, equals, said = (part.strip() for part in text.partition("="))
        if not equals and key in SETS:
            changed = {name: kind.width if key == "usual" else 0.0 for name, kind in kinds.items()}
            continue
        if key not in kinds:
            raise NoiseError(key, said, f"no such key; there are {describe_choices(key, (*kinds, *SETS))}")
        if not said:
            raise NoiseError(key, said, f"needs a width, as in {key}={kinds[key].shown(kinds[key].width)}")
        try:
            changed[key] = parse_quantity(said, kinds[key].dimension)
        except UnitError as error:
            raise NoiseError(key, said, f"{error.problem}; {error.allowed}") from None
        if not changed[key] >= 0.0:
            raise NoiseError(key, said, f"must be 0 {kinds[key].unit} or more; it is meant either way")
        if kinds[key].below_one and not changed[key] < 1.0:
            raise NoiseError(key, said, "must be less than 100 %")
    return changed
