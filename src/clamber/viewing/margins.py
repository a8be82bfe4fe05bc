"""Which check is the nearest to failing: margins of different units, compared as shares of what is limited."""

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from ..actions.limbed_problem import CHECKS
from ..statics.checks import LIMBED_CHECKS
from ..tasks.limbed import LimbedTask
from ..types import Floats
from ..units import DEGREE

NOTHING_LIMITS: Final = 1e8
"""Larger margins mean that nothing limits."""
COUNTS: Final = frozenset({"support", "hangs", "shared"})
"""Whole numbers: either fine or violated, never tight."""


@dataclass(frozen=True, slots=True)
class Limiting:
    """The check that is nearest to failing in one step."""

    check: str
    margin: float
    """In the check's own unit."""
    share: float
    """Margin over the size of what is limited [-]; negative: violated."""

    def __str__(self) -> str:
        unit = next(check.unit for check in LIMBED_CHECKS if check.name == self.check)
        value, shown = {"m": (100 * self.margin, "cm"), "rad": (self.margin / DEGREE, "deg")}.get(
            unit, (self.margin, "" if unit == "1" else unit)
        )
        name = self.check.replace("_", "-")
        share = "violated" if self.share < 0.0 else f"{100 * self.share:.0f} %"
        return f"{name} {value:+.3g} {shown} ({share})".replace("  ", " ")


def scales(task: LimbedTask) -> dict[str, float]:
    """Check -> the size that its margin is a share of, in its own unit."""
    robot, rules = task.robot, task.rules
    reach = min(limb.length for limb in robot.limbs)
    joints = [joint for limb in robot.limbs for joint in (limb.shoulder, limb.elbow)]
    half = 0.5 * min(joint.upper - joint.lower for joint in joints)
    torque = min(robot.motor.torque_limit if j.torque_limit is None else j.torque_limit for j in joints)
    room = max(rules.clearance, 0.1 * reach)
    power = math.inf if rules.max_power is None else rules.max_power
    sizes = dict.fromkeys(CHECKS, room)
    return sizes | {"reach": reach, "joint": half, "torque": torque, "power": power, "hook": robot.weight}


def limiting(task: LimbedTask, margins: Floats, reason: int) -> Limiting | None:
    """The hard check with the smallest relative margin, or the violated one; None where nothing is known.

    Args:
        task: The task.
        margins: Margins of one step, each in its own unit, shape (n_checks,).
        reason: Number of the violated check, -1 for none.
    """
    sizes = scales(task)
    if reason >= 0:
        name = CHECKS[reason]
        return Limiting(name, float(margins[reason]), min(float(margins[reason]) / sizes[name], 0.0))
    found: Limiting | None = None
    for name, margin in zip(CHECKS, margins.tolist(), strict=True):
        if name in COUNTS or name not in task.rules.hard or not abs(margin) < NOTHING_LIMITS:
            continue
        share = min(margin / sizes[name], 1.0)
        if found is None or share < found.share:
            found = Limiting(name, margin, share)
    return found


def all_limiting(
    task: LimbedTask, margins: Floats, reasons: np.ndarray[tuple[int], np.dtype[np.int32]]
) -> list[Limiting | None]:
    """`limiting` of every step of a replay."""
    return [limiting(task, row, int(reason)) for row, reason in zip(margins, reasons, strict=True)]


def grade(step: Limiting | None) -> int:
    """Colour of a step in `style.STRIP`: 0 violated, 1 tight, 2 fair, 3 ample."""
    if step is None:
        return 3
    return 0 if step.share < -1e-9 else 1 if step.share < 0.05 else 2 if step.share < 0.15 else 3
