"""What would make an infeasible task feasible, as plain values."""

from dataclasses import dataclass
from typing import Annotated

from ...json_form import Count, Jsonable, Key, in_json

Value = float | str | None


@dataclass(frozen=True, slots=True, kw_only=True)
class Opening(Jsonable):
    """One change of a task that makes it feasible."""

    key: str
    """What changes: a key as overrides have it, or words where several keys change together."""
    before: Annotated[Value, Key("from")]
    """The value that the task has, in `unit`; None where there is none."""
    after: Annotated[Value, Key("to")]
    """As it would have to be, in `unit`."""
    shut_at: Annotated[float | None, Key("infeasible_at")] = None
    """The value one step before, at which the task is proved infeasible, in `unit`; None where the values are names."""
    unit: str
    """Empty where the values are names or have none."""
    overrides: tuple[str, ...]
    """The change as texts "key=value", for `--set`."""
    length: Count
    """Actions of the plan that it opens."""
    shortest: bool
    """Whether that plan is proved to be the shortest."""
    least: bool
    """Whether it is proved that no smaller change of this kind does; False where values in between were not all tried, or where
    time ran out, so that `infeasible_at` is farther away than a step."""

    @property
    @in_json()
    def text(self) -> str:
        """The change in words."""
        return f"{self.key}: {shown(self.before, self.unit)} -> {shown(self.after, self.unit)}"


@dataclass(frozen=True, slots=True, kw_only=True)
class Shut(Jsonable):
    """One kind of change that was not found to open the task."""

    key: str
    tried: str
    """How far it was changed."""
    proved: bool
    """Whether the task is proved infeasible even then; False where time or memory ran out."""

    @property
    def text(self) -> str:
        """The change in words."""
        return f"{self.key} ({self.tried})"


@dataclass(frozen=True, slots=True, kw_only=True)
class Places(Jsonable):
    """Where one hold more opens the task."""

    spacing: Annotated[float, Key("spacing_m")]
    """Of the lattice of places [m]."""
    places: Count
    """Places of the lattice that a limb could ever grab from where the robot can get to."""
    tried: Count
    """Of those, how many were settled by the exact planner: each opens the task or is proved not to."""
    openings: tuple[Opening, ...]
    """One for each place that does: those with the shortest plan first, of these the one with most others about it."""

    @property
    @in_json(after="tried")
    def complete(self) -> bool:
        """Whether all of them were settled."""
        return self.tried == self.places


@dataclass(frozen=True, slots=True, kw_only=True)
class Openings(Jsonable):
    """Every single change that was tried on an infeasible task, and what came of it."""

    openings: tuple[Opening, ...]
    """The smallest change of each kind that makes it feasible."""
    shut: tuple[Shut, ...]
    """The kinds of which none was found."""
    places: Annotated[Places | None, Key("one_hold_more")]
    """One hold more; None where the family has no holds, or the places were not settled one by one."""
    searches: Count
    """Exact searches made."""
    seconds: float
    ended: str
    """Empty if all was tried; else why not: "interrupted", "time"."""

    @property
    def found(self) -> bool:
        """Whether any change opens the task."""
        return bool(self.openings or (self.places is not None and self.places.openings))


def shown(value: Value, unit: str) -> str:
    """A value with its unit."""
    if value is None:
        return "-"
    return value if isinstance(value, str) else f"{value:.10g} {unit}".rstrip()
