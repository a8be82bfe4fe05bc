"""Places and vectors of a plane as a user writes them, such as 22cm,0."""

import math

from ..errors import ClamberError, UnitError
from ..units import parse_quantity


class PointError(ClamberError):
    """A text that is no pair of numbers: names the key, the text and what is allowed."""

    def __init__(self, key: str, text: str, allowed: str) -> None:
        super().__init__(key, text, allowed)
        self.key, self.text, self.allowed = key, text, allowed

    def __str__(self) -> str:
        return f"{self.key} = {self.text}: {self.allowed}"


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


def read_elbow(text: str | None) -> int | None:
    """1 or -1 of "+" or "-".

    Raises:
        PointError: If it is neither.
    """
    signs = {"+": 1, "-": -1, "positive": 1, "negative": -1}
    if text is None:
        return None
    if text not in signs:
        raise PointError("elbow", text, "must be + or -")
    return signs[text]
