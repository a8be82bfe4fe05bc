"""One action of a plan as people and files have it: names and hold numbers in place of packed codes."""

from typing import Annotated, Literal

from pydantic import Field, StrictStr

from ...json_form import Jsonable
from ...specs import spec

Finite = Annotated[float, Field(strict=True, allow_inf_nan=False)]


@spec
class PlannedAction(Jsonable):
    """What the robot is told to do in one step, every choice made."""

    kind: Literal["none", "move", "release", "grab"]
    limb: StrictStr | None = None
    """Name of the limb or frame; None where the action has none."""
    hold: Annotated[int, Field(strict=True, ge=1)] | None = None
    """Number of the hold that a grab takes; None for a grab that found no hold."""
    delta: tuple[Finite, Finite, Finite] | None = None
    """A move's change of x [m], y [m] and angle [rad], world frame."""
    code: Annotated[int, Field(strict=True, ge=0)] | None = None
    """The thesis's number (0, 1..6, N00, NXX) with the hold that was taken; None where it has no number for this."""
    gene: StrictStr | None = None
    """What the action was before its hold was chosen, such as "192" or "nearest 2"."""

    @property
    def title(self) -> str:
        """The action in a few words, for tables and messages."""
        if self.kind == "none":
            return "none"
        if self.kind == "move" and self.delta is not None:
            axes = zip(("x", "y", "theta"), self.delta, strict=True)
            way = " ".join(f"{'+' if part > 0 else '-'}{axis}" for axis, part in axes if part)
            return f"{self.limb} {way}" if self.limb else way
        if self.kind == "grab":
            return f"{self.limb} grabs {self.gene or 'no hold' if self.hold is None else self.hold}"
        return f"{self.limb} releases"


class ActionError(Exception):
    """A planned action is none that the task's robot has; whoever knows the file turns it into a `SpecError`."""

    def __init__(self, key: str, allowed: str) -> None:
        super().__init__(key, allowed)
        self.key, self.allowed = key, allowed
