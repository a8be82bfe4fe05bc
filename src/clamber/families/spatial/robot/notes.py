"""What was repaired in a model and what was left out of it, as sentences that name element, what was done, and why."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Final

NAMED: Final = 6
"""So many elements are named, the others counted."""


@dataclass(frozen=True, slots=True)
class Notes:
    """Sentences about one model, in the order in which things were found."""

    repaired: list[str] = field(default_factory=list)
    dropped: list[str] = field(default_factory=list)

    def repair(self, kind: str, names: Sequence[str], told: str) -> None:
        """Say of some elements, if there are any, what was done to them."""
        if names:
            self.repaired.append(sentence(kind, names, told))

    def drop(self, kind: str, names: Sequence[str], told: str) -> None:
        """Say of some elements, if there are any, why they were left out."""
        if names:
            self.dropped.append(sentence(kind, names, told))


def sentence(kind: str, names: Sequence[str], told: str) -> str:
    """Such as "2 joints (a, b): no limits"; of a single one "joint a: no limits"."""
    if len(names) == 1:
        return f"{kind} {names[0]}: {told}"
    plural = {"body": "bodies", "collision mesh": "collision meshes", "mesh": "meshes"}.get(kind, f"{kind}s")
    more = f", and {len(names) - NAMED} more" if len(names) > NAMED else ""
    return f"{len(names)} {plural} ({', '.join(names[:NAMED])}{more}): {told}"


def span(values: Mapping[str, float]) -> str:
    """The range of some numbers, or the one that they are."""
    low, high = min(values.values(), default=0.0), max(values.values(), default=0.0)
    return f"{low:.3g}" if high < 1.01 * low else f"{low:.3g} to {high:.3g}"
