"""One identified number with its error, or why a log does not tell it."""

from dataclasses import dataclass

from ...types import Json


@dataclass(frozen=True, slots=True)
class Estimate:
    """One parameter of a joint."""

    name: str
    unit: str
    value: float | None = None
    """None: the log does not tell it."""
    error: float | None = None
    """Standard error, of what scatters in the log; an error of the torque constant or gear is not in it."""
    low: float | None = None
    """Ends of the interval that holds 95 % of the bootstrap's answers."""
    high: float | None = None
    method: str = ""
    """How it was found."""
    needs: str = ""
    """What the log lacks; empty where there is a value."""
    stated: float | None = None
    """What the robot's file says."""

    @property
    def difference(self) -> float | None:
        """From what the robot's file says, as a part of that; None where either is missing, or the file says 0."""
        if self.value is None or not self.stated:
            return None
        return (self.value - self.stated) / self.stated

    def to_json(self) -> Json:
        """As plain data."""
        return {
            "name": self.name,
            "unit": self.unit,
            "value": self.value,
            "standard_error": self.error,
            "interval_95": None if self.low is None else [self.low, self.high],
            "method": self.method,
            "needs": self.needs or None,
            "stated": self.stated,
            "difference": self.difference,
        }
