"""What the checks say of one step of a plan."""

from dataclasses import dataclass

from ..types import Json
from ..units import OZ_IN
from .planned import PlannedAction


@dataclass(frozen=True, slots=True, kw_only=True)
class StepVerdict:
    """One step of a plan and what the checks say of it."""

    step: int
    """From 1."""
    action: PlannedAction
    asked: int | str
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
    max_torque: float | None
    """Largest joint torque [N m]; None where it could not be had."""
    power: float | None
    """Electrical power that holding the stance takes [W]; None where it could not be had."""
    margins: dict[str, float | None]
    """Check -> signed margin in its own unit; None where nothing limits it or it could not be had."""
    reported: tuple[str, ...]
    """Violated checks that only report."""
    pose: tuple[float, float, float]
    """Body afterwards, world frame [m, m, rad]."""
    holds: dict[str, int]
    """Limb -> hold afterwards, 0 if free."""

    def to_json(self) -> Json:
        """Plain data."""
        return {
            "step": self.step,
            "action": self.asked,
            "ok": self.ok,
            "check": self.check,
            "reason": self.reason,
            "hold": self.hold,
            "nearest": self.nearest,
            "max_torque_oz_in": None if self.max_torque is None else self.max_torque / OZ_IN,
            "power_W": self.power,
            "reported": list(self.reported),
            "margins": self.margins,
        }
