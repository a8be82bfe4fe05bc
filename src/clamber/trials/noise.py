"""Widths of model errors by name: kinds, how texts such as "friction=30%" change them, and what a seed draws of each."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import ClassVar, Final, Self

import numpy as np

from ..errors import StatedError, UnitError, describe_choices
from ..types import Floats, Json
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


def named_widths(kinds: Mapping[str, NoiseKind], name: str) -> dict[str, float]:
    """A set of widths: "usual", or "none" of all."""
    assert name in SETS
    return {key: kind.width if name == "usual" else 0.0 for key, kind in kinds.items()}


def read_widths(kinds: Mapping[str, NoiseKind], widths: Mapping[str, float], texts: Iterable[str]) -> dict[str, float]:
    """Widths of these kinds changed by texts such as "friction=30%", the last one winning; "none" and "usual" change all of them.

    Raises:
        NoiseError: If there is no such key, or its width cannot be.
    """
    changed = dict(widths)
    for text in texts:
        key, equals, said = (part.strip() for part in text.partition("="))
        if not equals and key in SETS:
            changed = named_widths(kinds, key)
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


def stream_of(key: str, seed: int) -> np.random.Generator:
    """What a seed draws of a key comes from here: whatever becomes of other keys, it stays."""
    return np.random.default_rng([seed, *key.encode()])


@dataclass(frozen=True, slots=True)
class NoiseWidths:
    """A width for every kind of a family's noise, in SI."""

    widths: Mapping[str, float]
    kinds: ClassVar[Mapping[str, NoiseKind]]
    """Key -> what deviates."""

    @classmethod
    def of(cls, name: str, texts: Iterable[str] = ()) -> Self:
        """A set of widths, "usual" or "none" of all, changed by texts; see `read_widths`."""
        return cls(read_widths(cls.kinds, named_widths(cls.kinds, name), texts))

    @classmethod
    def from_json(cls, document: Json) -> Self:
        """What `to_json` described."""
        return cls({key: float(document.get(key, 0.0)) for key in cls.kinds})

    def changed(self, texts: Iterable[str]) -> Self:
        """These changed by texts; see `read_widths`."""
        return type(self)(read_widths(self.kinds, self.widths, texts))

    def to_json(self) -> Json:
        """Plain data."""
        return {key: self.widths[key] for key in self.kinds}

    @property
    def any(self) -> bool:
        """Whether anything deviates."""
        return any(self.widths.values())

    def share(self, key: str, seed: int, *shape: int) -> Floats:
        """What a seed draws of a key, evenly spread over its width to either side."""
        return self.widths[key] * stream_of(key, seed).uniform(-1.0, 1.0, shape)
