"""What the checks say of one step of a plan."""

from dataclasses import dataclass
from typing import Annotated

from ...json_form import HIDDEN, Jsonable, Key
from ...units import OZ_IN
from .planned import PlannedAction


@dataclass(frozen=True, slots=True, kw_only=True)
class StepVerdict(Jsonable):
    """One step of a plan and what the checks say of it."""

    step: int
    """From 1."""
    action: Annotated[PlannedAction, HIDDEN]
    asked: Annotated[int | str, Key("action")]
    """The action as its file has it: the thesis's number where there is one, else in words."""
    ok: bool
    """Whether every hard check holds."""
    check: str | None
    """The first violated hard check."""
    reason: str | None
    """The same in words, with the amount."""
    hold: int | None
    """Number of the hold that was taken."""
    nearest: int | None
    """Number of the hold that "nearest" takes here, where the plan's file asks for that and prints the hold taken."""
    max_torque: Annotated[float | None, Key("max_torque_oz_in", per=OZ_IN)]
    """Largest joint torque; None where it could not be had."""
    power: Annotated[float | None, Key("power_W")]
    """Electrical power that holding the stance takes; None where it could not be had."""
    reported: tuple[str, ...]
    """Violated checks that only report."""
    margins: dict[str, float | None]
    """Check -> signed margin in its own unit (SI); None where nothing limits it or it could not be had."""
    pose: Annotated[tuple[float, float, float], HIDDEN]
    """Body afterwards, world frame [m, m, rad]."""
    holds: Annotated[dict[str, int], HIDDEN]
    """Limb -> hold afterwards, 0 if free."""
