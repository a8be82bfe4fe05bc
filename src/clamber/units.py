"""Units at the border: text such as "3 in" or "1500 oz-in" becomes an SI float, and nothing inside knows inches."""

import math
import re
from dataclasses import dataclass
from typing import Annotated, Any, Final

from pydantic import GetCoreSchemaHandler
from pydantic_core import CoreSchema, PydanticCustomError, core_schema

from .errors import StatedError, UnitError, describe_choices

INCH: Final = 0.0254
"""One inch [m], exact."""
OUNCE: Final = 0.028349523125
"""One avoirdupois ounce [kg], exact."""
GRAVITY: Final = 9.80665
"""Standard gravity [m/s^2], exact by definition."""
OUNCE_FORCE: Final = OUNCE * GRAVITY
"""One ounce-force [N]."""
OZ_IN: Final = OUNCE_FORCE * INCH
"""One ounce-inch [N m], 0.0070616."""
DEGREE: Final = math.pi / 180.0
"""One degree [rad]."""
LARGEST: Final = 1e9
"""No quantity of a file may be larger, in SI units: its square must still mean something."""

# The first unit of each dimension is its SI unit; texts are compared without blanks, "-", "*", "^" (see `_plain`).
UNITS: Final[dict[str, dict[str, float]]] = {
    "length": {"m": 1.0, "cm": 0.01, "mm": 0.001, "in": INCH, "ft": 12 * INCH},
    "angle": {"rad": 1.0, "deg": DEGREE, "turn": math.tau},
    "torque": {"N m": 1.0, "mN m": 1e-3, "oz-in": OZ_IN, "lbf-in": 16 * OZ_IN, "lbf-ft": 192 * OZ_IN},
    "force": {"N": 1.0, "kN": 1e3, "ozf": OUNCE_FORCE, "lbf": 16 * OUNCE_FORCE, "kgf": GRAVITY},
    "pressure": {"Pa": 1.0, "kPa": 1e3, "mbar": 100.0, "bar": 1e5},
    "mass": {"kg": 1.0, "g": 1e-3, "oz": OUNCE, "lb": 16 * OUNCE},
    "inertia": {"kg m^2": 1.0, "g cm^2": 1e-7, "kg cm^2": 1e-4},
    "damping": {"N m s/rad": 1.0, "N m s": 1.0, "mN m s/rad": 1e-3},
    "linear damping": {"N s/m": 1.0},
    "stiffness": {"N/m": 1.0, "N/mm": 1e3},
    "angular stiffness": {"N m/rad": 1.0, "N m/deg": 1.0 / DEGREE},
    "resistance": {"ohm": 1.0, "kohm": 1e3},
    "torque constant": {"N m/A": 1.0, "mN m/A": 1e-3, "oz-in/A": OZ_IN},
    "amplifier gain": {"A/V": 1.0},
    "acceleration": {"m/s^2": 1.0, "cm/s^2": 0.01, "gal": 0.01},
    "speed": {"m/s": 1.0, "cm/s": 0.01, "mm/s": 0.001, "in/s": INCH},
    "angular speed": {"rad/s": 1.0, "deg/s": DEGREE, "rpm": math.tau / 60.0},
    "voltage": {"V": 1.0, "mV": 1e-3},
    "current": {"A": 1.0, "mA": 1e-3},
    "power": {"W": 1.0, "mW": 1e-3},
    "time": {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9, "min": 60.0},
    "frequency": {"Hz": 1.0, "kHz": 1e3},
    "number per area": {"1/m^2": 1.0, "1/ft^2": 1.0 / (12 * INCH) ** 2},
    "ratio": {"1": 1.0, "%": 0.01},
}
"""Dimension -> unit -> its size in the SI unit, which stands first."""

_NAMES: Final = {
    "meter": "m", "meters": "m", "metre": "m", "metres": "m", "inch": "in", "inches": "in", "foot": "ft",
    "degree": "deg", "degrees": "deg", "°": "deg", "radian": "rad", "radians": "rad", "turns": "turn",
    "ozfin": "ozin", "ozfin/A": "ozin/A", "lbin": "lbfin", "lbft": "lbfft",
    "kgm²": "kgm2", "kgcm²": "kgcm2", "gcm²": "gcm2",
    "/m2": "1/m2", "holds/m2": "1/m2", "/m²": "1/m2", "holds/m²": "1/m2", "1/m²": "1/m2", "/ft2": "1/ft2", "holds/ft2": "1/ft2",
    "newton": "N", "newtons": "N", "watt": "W", "Ohm": "ohm", "Ω": "ohm", "sec": "s",
}  # fmt: skip
LONGEST: Final = 200
"""Letters of a quantity's text; no number says more, and a longer one may be anything."""
_NUMBER: Final = re.compile(r"[+-]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d+)?")
_SEPARATORS: Final = re.compile(r"[\s*^·-]")


def _plain(unit: str) -> str:
    bare = _SEPARATORS.sub("", unit)
    return _NAMES.get(bare, bare)


_SIZES: Final = {dimension: {_plain(unit): size for unit, size in sizes.items()} for dimension, sizes in UNITS.items()}


def si_unit(dimension: str) -> str:
    """The SI unit of a dimension, such as "N m" for "torque"."""
    return next(iter(UNITS[dimension]))


def convert(value: float, unit: str, dimension: str) -> float:
    """`value` in `unit`, in the SI unit of `dimension`.

    Raises:
        UnitError: If `dimension` has no such unit, or the value is not finite.
    """
    sizes = _SIZES[dimension]
    bare = _plain(unit)
    if bare not in sizes:
        raise UnitError(unit, f"is no unit of {dimension}", f"allowed are {describe_choices(unit, UNITS[dimension])}")
    if not abs(value) <= LARGEST / sizes[bare]:  # this way round, NaN fails too; a whole number may exceed any float
        raise UnitError(value, "is not a finite number, or far too large", f"state a finite {dimension}")
    return float(value) * sizes[bare]


def split_quantity(text: str) -> tuple[float, str] | None:
    """Number and unit of a text such as "3 in"; None if it does not start with a number, or is longer than `LONGEST`."""
    plain = text.strip()
    match = _NUMBER.match(plain) if len(plain) <= LONGEST else None
    return (float(match[0]), plain[match.end() :].strip()) if match else None


def split_title(title: str) -> tuple[str, str | None]:
    """Name and unit of a title such as "shoulder angle [deg]" or "x (in)"; None where it states no unit."""
    plain = title.strip()
    if not plain.endswith(("]", ")")):
        return plain, None
    inside = plain[:-1]
    after = 1 + max(inside.rfind("]"), inside.rfind(")"))
    opened = [place for place in (inside.find("[", after), inside.find("(", after)) if place >= 0]
    if not opened:
        return plain, None
    return inside[: min(opened)].strip(), inside[min(opened) + 1 :].strip() or None


def is_number(text: str) -> bool:
    """Whether a text is a finite number without a unit."""
    try:
        return math.isfinite(float(text)) and "_" not in text
    except ValueError:
        return False


def parse_quantity(text: str, dimension: str) -> float:
    """The SI value of a text such as "3 in", "15deg" or "1500 oz-in".

    Raises:
        UnitError: If the text has no number, no unit, or a unit of something else.
    """
    parts = split_quantity(text)
    example = f"'1 {si_unit(dimension)}'" if dimension != "ratio" else "'0.5' or '50 %'"
    if parts is None:
        raise UnitError(text, f"is no {dimension}", f"state a finite number and a unit, such as {example}")
    number, unit = parts
    if not unit and dimension != "ratio":
        raise UnitError(text, "lacks its unit", _suggestion(number, dimension))
    return convert(number, unit or "1", dimension)


def read_quantity(raw: object, dimension: str) -> float:
    """The SI value of what a file says: a text with a unit, or a table `{ value, unit, source }`.

    A number without a unit is accepted for ratios alone.

    Raises:
        UnitError: If the unit is missing or wrong, or the value is no finite number.
    """
    if isinstance(raw, str):
        return parse_quantity(raw, dimension)
    if isinstance(raw, dict):
        return _read_table(raw, dimension)
    if isinstance(raw, bool) or not isinstance(raw, int | float):
        raise UnitError(raw, f"is no {dimension}", f"state a number and a unit, such as '1 {si_unit(dimension)}'")
    if dimension == "ratio":
        return convert(raw, "1", dimension)
    if not abs(raw) <= LARGEST:
        raise UnitError(raw, "is not a finite number", f"state a finite {dimension} with its unit")
    raise UnitError(raw, "lacks its unit", _suggestion(raw, dimension))


class PointError(StatedError):
    """A text that is no number or no pair of numbers: names the key, the text and what is allowed."""

    says = "{key} = {text}: {allowed}"
    key: str
    text: str
    allowed: str


def read_point(key: str, text: str, dimension: str = "length") -> tuple[float, float]:
    """Two numbers of a text such as "22cm,0"; without a unit they are in SI.

    Raises:
        PointError: If it is no such pair.
    """
    parts = text.split(",")
    if len(parts) != 2:
        raise PointError(key, text, "must be two numbers with a comma between, such as 22cm,0")
    x, y = (read_number(key, part, dimension) for part in parts)
    return x, y


def read_number(key: str, text: str, dimension: str) -> float:
    """A finite number of a text, in SI or with a unit.

    Raises:
        PointError: If it is none.
    """
    try:
        value = float(text)
    except ValueError:
        try:
            value = parse_quantity(text, dimension)
        except UnitError as error:
            raise PointError(key, text.strip(), f"{error.problem}; {error.allowed}") from None
    if not math.isfinite(value):
        raise PointError(key, text.strip(), "must be finite")
    return value


def _suggestion(number: float, dimension: str) -> str:
    return f"state a unit, such as '{number:g} {si_unit(dimension)}'; {_all(dimension)}"


def _all(dimension: str) -> str:
    return f"units of {dimension} are {', '.join(UNITS[dimension])}"


def _read_table(raw: dict[str, Any], dimension: str) -> float:
    strange = sorted(set(raw) - QUANTITY_KEYS)
    if strange or "value" not in raw:
        what = f"has the unknown key '{strange[0]}'" if strange else "has no 'value'"
        raise UnitError(raw, what, "a quantity is { value, unit, source }")
    value, unit = raw["value"], raw.get("unit")
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise UnitError(value, "is no number", f"state a finite number in 'value' and a unit of {dimension} in 'unit'")
    if unit is None and dimension != "ratio":
        raise UnitError(raw, "lacks its unit", f"state a 'unit', such as '{si_unit(dimension)}'; {_all(dimension)}")
    if unit is not None and not isinstance(unit, str):
        raise UnitError(unit, "is no unit", _all(dimension))
    return convert(value, unit or "1", dimension)


QUANTITY_KEYS: Final = frozenset({"value", "unit", "source"})
"""The keys of a quantity given as a table."""


@dataclass(frozen=True, slots=True)
class Quantity:
    """Marks a float of a spec as a dimensional number; pydantic reads it through `read_quantity`."""

    dimension: str
    above: float | None = None
    at_least: float | None = None
    at_most: float | None = None

    def read(self, raw: object) -> float:
        """The SI value, within the bounds.

        Raises:
            PydanticCustomError: If it is no such quantity or out of bounds; pydantic adds the key.
        """
        try:
            value = read_quantity(raw, self.dimension)
        except UnitError as error:
            raise PydanticCustomError("quantity", "{text}", {"text": f"{error.problem}; {error.allowed}"}) from None
        for holds, words, bound in (
            (self.above is None or value > self.above, "more than {}", self.above),
            (self.at_least is None or value >= self.at_least, "{} or more", self.at_least),
            (self.at_most is None or value <= self.at_most, "{} or less", self.at_most),
        ):
            if not holds and bound is not None:
                raise PydanticCustomError("quantity", "{text}", {"text": f"must be {words.format(self._show(bound))}"})
        return value

    def _show(self, bound: float) -> str:
        if self.dimension == "ratio":
            return f"{bound:g}"
        return f"{bound / DEGREE:g} deg" if self.dimension == "angle" else f"{bound:g} {si_unit(self.dimension)}"

    def __get_pydantic_core_schema__(self, source: object, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(self.read)


def _read_count(raw: object) -> int:
    value = raw.get("value") if isinstance(raw, dict) and set(raw) <= QUANTITY_KEYS else raw
    if isinstance(value, bool) or not isinstance(value, int) or value < 0:
        raise PydanticCustomError("quantity", "{text}", {"text": "must be a whole number, 0 or more"})
    return value


class _Count:
    def __get_pydantic_core_schema__(self, source: object, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(_read_count)


Length = Annotated[float, Quantity("length")]
PositiveLength = Annotated[float, Quantity("length", above=0.0)]
NonNegativeLength = Annotated[float, Quantity("length", at_least=0.0)]
Angle = Annotated[float, Quantity("angle")]
NonNegativeAngle = Annotated[float, Quantity("angle", at_least=0.0)]
PositiveAngle = Annotated[float, Quantity("angle", above=0.0)]
ConeAngle = Annotated[float, Quantity("angle", above=0.0, at_most=math.pi / 2)]
"""Half angle of a cone [rad], over 0 and at most a right angle."""
PositiveTorque = Annotated[float, Quantity("torque", above=0.0)]
NonNegativeTorque = Annotated[float, Quantity("torque", at_least=0.0)]
PositiveForce = Annotated[float, Quantity("force", above=0.0)]
NonNegativeForce = Annotated[float, Quantity("force", at_least=0.0)]
PositivePressure = Annotated[float, Quantity("pressure", above=0.0)]
NonNegativeMass = Annotated[float, Quantity("mass", at_least=0.0)]
PositiveMass = Annotated[float, Quantity("mass", above=0.0)]
NonNegativeInertia = Annotated[float, Quantity("inertia", at_least=0.0)]
NonNegativeDamping = Annotated[float, Quantity("damping", at_least=0.0)]
PositiveResistance = Annotated[float, Quantity("resistance", above=0.0)]
PositiveTorqueConstant = Annotated[float, Quantity("torque constant", above=0.0)]
PositiveAmplifierGain = Annotated[float, Quantity("amplifier gain", above=0.0)]
AngularSpeed = Annotated[float, Quantity("angular speed")]
PositiveAngularSpeed = Annotated[float, Quantity("angular speed", above=0.0)]
Speed = Annotated[float, Quantity("speed")]
PositiveSpeed = Annotated[float, Quantity("speed", above=0.0)]
PositivePower = Annotated[float, Quantity("power", above=0.0)]
PositiveTime = Annotated[float, Quantity("time", above=0.0)]
PositiveDensity = Annotated[float, Quantity("number per area", above=0.0)]
"""Things per area [1/m^2]."""
PositiveFrequency = Annotated[float, Quantity("frequency", above=0.0)]
Ratio = Annotated[float, Quantity("ratio")]
PositiveRatio = Annotated[float, Quantity("ratio", above=0.0)]
NonNegativeRatio = Annotated[float, Quantity("ratio", at_least=0.0)]
Count = Annotated[int, _Count()]
"""A whole number, 0 or more; in a file also `{ value, source }`."""
Point = tuple[Length, Length]
"""x, y [m]."""
Place = tuple[Length, Length, Length]
"""x, y, z [m]."""
Polygon = tuple[Point, ...]
"""Corners in order [m]; at least three."""
