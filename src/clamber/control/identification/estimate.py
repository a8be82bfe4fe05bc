"""One identified number with its error, or why a log does not tell it."""

from dataclasses import dataclass
from typing import Annotated, Final

from ...json_form import HIDDEN, Jsonable, Key, in_json

NEEDS: Final = "What the log would have to hold for a value; null where there is one."


@dataclass(frozen=True, slots=True)
class Estimate(Jsonable):
    """One parameter of a joint."""

    name: str
    unit: str
    value: float | None = None
    """None: the log does not tell it."""
    error: Annotated[float | None, Key("standard_error")] = None
    """Standard error, of what scatters in the log; an error of the torque constant or gear is not in it."""
    low: Annotated[float | None, HIDDEN] = None
    """Ends of the interval that holds 95 % of the bootstrap's answers."""
    high: Annotated[float | None, HIDDEN] = None
    method: str = ""
    """How it was found."""
    needs: Annotated[str, Key(get=lambda needs: needs or None, kind=str | None, meaning=NEEDS)] = ""
    """What the log lacks; empty where there is a value."""
    stated: float | None = None
    """What the robot's file says."""

    @in_json(after="standard_error")
    def interval_95(self) -> Annotated[tuple[float | None, float | None] | None, Key(kind=tuple[float, float])]:
        """Holds 95 % of the bootstrap's answers; None where there is none."""
        return None if self.low is None else (self.low, self.high)

    @property
    @in_json()
    def difference(self) -> float | None:
        """From what the robot's file says, as a part of that; None where either is missing, or the file says 0."""
        if self.value is None or not self.stated:
            return None
        return (self.value - self.stated) / self.stated
