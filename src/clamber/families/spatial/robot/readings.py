"""Quantities of joints in robot files: angle, torque or inertia where a joint turns, length, force or mass where it slides."""

from typing import Annotated, NamedTuple

from pydantic import GetCoreSchemaHandler
from pydantic_core import CoreSchema, PydanticCustomError, core_schema

from ....errors import UnitError
from ....files import Document
from ....units import DEGREE, read_quantity
from .tree import Joint


class Reading(NamedTuple):
    """A quantity whose dimension the joint decides that it is said of."""

    value: float
    """[rad], [m], [N m], [N], [kg m^2] or [kg], or a rate of the first two."""
    dimension: str


class _OneOf:
    """A quantity of one of two dimensions: that of a turning joint, and that of a sliding one."""

    def __init__(self, turning: str, sliding: str) -> None:
        self.dimensions = (turning, sliding)

    def __get_pydantic_core_schema__(self, source: object, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(self._read)

    def _read(self, raw: object) -> Reading:
        told = []
        for dimension in self.dimensions:
            try:
                return Reading(read_quantity(raw, dimension), dimension)
            except UnitError as error:
                told.append(f"{error.problem}; {error.allowed}")
        raise PydanticCustomError("quantity", "{text}", {"text": told[0]})


Position = Annotated[Reading, _OneOf("angle", "length")]
"""Of a joint: an angle, or a length where it slides."""
Load = Annotated[Reading, _OneOf("torque", "force")]
"""Of a motor: a torque, or a force where its joint slides."""
Rate = Annotated[Reading, _OneOf("angular speed", "speed")]
"""Of a joint: an angular speed, or a speed where it slides."""
Inertia = Annotated[Reading, _OneOf("inertia", "mass")]
"""Of a rotor, at its joint: an inertia, or a mass where its joint slides."""
LINEAR = ("length", "force", "speed", "mass")
"""Dimensions of what is said of sliding joints."""


def shown(joint: Joint, position: float) -> str:
    """A joint's position in words."""
    return f"{position:.4g} m" if joint.sliding else f"{position / DEGREE:.4g} deg"


def check_dimension(document: Document, key: str, joint: Joint, reading: Reading) -> None:
    """Makes sure that what is said of a joint is of its dimension."""
    if (reading.dimension in LINEAR) != joint.sliding:
        what = (
            "slides: state a length, a force, a speed or a mass"
            if joint.sliding
            else "turns: state an angle, a torque, an angular speed or an inertia"
        )
        raise document.problem(key, f"joint {joint.name} {what}")


def positive(document: Document, key: str, joint: Joint, reading: Reading | None) -> float | None:
    """What the file states of a joint's motor; None: nothing."""
    if reading is None:
        return None
    check_dimension(document, key, joint, reading)
    if not reading.value > 0.0:
        raise document.problem(key, "must be more than 0")
    return reading.value
