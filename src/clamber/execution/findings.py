"""What a robot notices of its own faults."""

from dataclasses import dataclass

from ..json_form import Jsonable


@dataclass(frozen=True, slots=True)
class Finding(Jsonable):
    """A fault as the robot has noticed it."""

    kind: str
    """Such as "no number", "jump", "no answer", "unbalanced", "drift", "no reading", "late readings"."""
    where: str
    """Sensor or joint; empty for the link."""
    time: float
    """When it was noticed first [s]."""
    why: str
    """In words, with its numbers."""

    def __str__(self) -> str:
        at = f"{self.where}: " if self.where else ""
        return f"{at}{self.kind}: {self.why}"
