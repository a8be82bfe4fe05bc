"""Which check is the nearest to failing: margins of different units, compared as shares of what is limited."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

from ..actions.problem import Replay
from ..statics.checks import LIMBED_CHECKS, Check
from ..statics.walker import WALKER_CHECKS
from ..tasks.limbed import LimbedTask
from ..tasks.walker import WalkerTask
from ..types import Floats
from ..units import DEGREE

NOTHING_LIMITS: Final = 1e8
"""Larger margins mean that nothing limits."""


@dataclass(frozen=True, slots=True)
class Limiting:
    """The check that is nearest to failing in one step."""

    check: Check
    margin: float
    """In the check's own unit."""
    share: float
    """Margin over the size of what is limited [-]; negative: violated."""

    def __str__(self) -> str:
        unit = self.check.unit
        value, shown = {"m": (100 * self.margin, "cm"), "rad": (self.margin / DEGREE, "deg")}.get(
            unit, (self.margin, "" if unit == "1" else unit)
        )
        name = self.check.name.replace("_", "-")
        share = "violated" if self.share < 0.0 else f"{100 * self.share:.0f} %"
        return f"{name} {value:+.3g} {shown} ({share})".replace("  ", " ")


@dataclass(frozen=True, slots=True)
class Yardsticks:
    """What a task's margins are measured against."""

    checks: tuple[Check, ...]
    """In the order of a replay's margins."""
    hard: tuple[str, ...]
    """Names of the checks that forbid an action."""
    sizes: Mapping[str, float]
    """Check -> the size that its margin is a share of, in its own unit; counts have none, for they are never tight."""


def climber_yardsticks(task: LimbedTask) -> Yardsticks:
    """Reach, joint ranges, torque and power limits, weight; for distances the clearance or a tenth of the reach."""
    robot, rules = task.robot, task.rules
    reach = min(limb.length for limb in robot.limbs)
    joints = [joint for limb in robot.limbs for joint in (limb.shoulder, limb.elbow)]
    half = 0.5 * min(joint.upper - joint.lower for joint in joints)
    torque = min(robot.motor.torque_limit if j.torque_limit is None else j.torque_limit for j in joints)
    power = math.inf if rules.max_power is None else rules.max_power
    room = max(rules.clearance, 0.1 * reach)
    sizes = {check.name: room for check in LIMBED_CHECKS if check.unit != "1"}
    sizes |= {"reach": reach, "joint": half, "torque": torque, "power": power, "hook": robot.weight}
    return Yardsticks(LIMBED_CHECKS, rules.hard, sizes)


def walker_yardsticks(task: WalkerTask) -> Yardsticks:
    """Half a stroke, the guarded singular distance, a tenth of the feet's circle, the middle of a support triangle."""
    mechanism, legs = task.robot.mechanism, task.robot.legs
    feet = min(legs.radius_delta, legs.radius_y)
    sizes = {
        "stroke": 0.5 * mechanism.stroke,
        "singular": mechanism.guard * mechanism.singular_distance(0.0),
        "foothold": max(task.rules.clearance, 0.1 * feet),
        "balance": 0.5 * feet,  # inradius of a triangle over its circumradius
    }
    return Yardsticks(WALKER_CHECKS, task.rules.hard, sizes)


def limiting(yardsticks: Yardsticks, margins: Floats, reason: int) -> Limiting | None:
    """The hard check with the smallest relative margin, or the violated one; None where nothing is known.

    Args:
        yardsticks: Those of the task.
        margins: Margins of one step, each in its own unit, shape (n_checks,).
        reason: Number of the violated check, -1 for none.
    """
    sizes = yardsticks.sizes
    if reason >= 0:
        check, margin = yardsticks.checks[reason], float(margins[reason])
        return Limiting(check, margin, min(margin / sizes.get(check.name, 1.0), 0.0))
    found: Limiting | None = None
    for check, margin in zip(yardsticks.checks, margins.tolist(), strict=True):
        if check.name not in sizes or check.name not in yardsticks.hard or not abs(margin) < NOTHING_LIMITS:
            continue
        share = min(margin / sizes[check.name], 1.0) if sizes[check.name] > 0.0 else 1.0
        if found is None or share < found.share:
            found = Limiting(check, margin, share)
    return found


def all_limiting(yardsticks: Yardsticks, replay: Replay) -> list[Limiting | None]:
    """`limiting` of every step of a replay."""
    return [limiting(yardsticks, row, int(reason)) for row, reason in zip(replay.margins, replay.reasons, strict=True)]


def grade(step: Limiting | None) -> int:
    """Colour of a step in `style.STRIP`: 0 violated, 1 tight, 2 fair, 3 ample."""
    if step is None:
        return 3
    return 0 if step.share < -1e-9 else 1 if step.share < 0.05 else 2 if step.share < 0.15 else 3
