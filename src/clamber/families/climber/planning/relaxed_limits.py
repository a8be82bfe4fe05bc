"""Limits of a climber's motors and joints as numbers that can be relaxed.

Which numbers are *nested*, so that every plan stays a plan as they are relaxed further: reach offset and clearance are read by their
own checks alone. Torque limits and joint ranges also choose which side an elbow takes and how three or more limbs share the weight. With
the thesis's force rule, two carriers share it by where their holds are alone; a wider range or limit then leaves all choices that
there were, and the side taken is the one with less torque. What else reads the side taken (power, interference) may still get worse.
"""

import math
from collections.abc import Iterator
from functools import partial
from typing import Final

from ....files import Document
from ....planning.exact.costs import Aim
from ....planning.infeasibility.relaxations import Dial, key_dial
from ....planning.infeasibility.trial import Answer, Trial
from ....planning.problem.problems import plan_family
from ....units import DEGREE, OZ_IN
from .task import LimbedTask

MOST_TORQUE: Final = 1e4
"""The largest torque limit that is tried [N m]; stances without any split of the weight count as 1e6 N m."""
MOST_POWER: Final = 1e6
"""The largest power limit that is tried [W]."""
WIDEST: Final = 60.0
"""Joint ranges are made wider by up to this much at each end [deg]."""
FULL_TURN: Final = 360.0
"""No joint range is wider [deg]."""
INTERFERENCE: Final = frozenset({"limb_limb", "limb_body", "limb_peg"})


def motor_dials(task: LimbedTask) -> Iterator[Dial]:
    """The torque limit of the motors, that of all joints where some have their own, and the power limit."""
    rules, motor = task.rules, task.robot.motor
    if "torque" in rules.hard:
        ounces = _stated_unit(task, "robot.motor.torque_limit") == "oz-in"
        size = OZ_IN if ounces else 1.0
        if any(joint.torque_limit is None for joint in task.robot.joints):
            yield key_dial(
                "motor.torque_limit",
                motor.torque_limit / size,
                most=math.floor(MOST_TORQUE / size),
                unit="oz-in" if ounces else "N m",
                per_unit=10 if ounces else 1000,
                nested=one_split(task) and (rules.branch == "free" or not _reads_side(task)),
                guess=partial(_least_torque, size=size),
            )
        own = [
            (f"limbs.{limb.name}.{name}.torque_limit", joint.torque_limit)
            for limb in task.robot.limbs
            for name, joint in (("shoulder", limb.shoulder), ("elbow", limb.elbow))
            if joint.torque_limit is not None
        ]
        if own:
            every = [("motor.torque_limit", motor.torque_limit), *own]
            yield Dial(
                key="all torque limits",
                present=100.0,
                most=100_000.0,
                unit="%",
                per_unit=10,
                overrides=lambda share: tuple(f"{key}={limit * share / 100.0:.12g} N m" for key, limit in every),
                nested=one_split(task) and (rules.branch == "free" or not _reads_side(task)),
            )
    if "power" in rules.hard and rules.max_power is not None:
        key = "rules.max_power"
        yield key_dial(key, rules.max_power, most=MOST_POWER, unit="W", per_unit=100, nested=True, guess=_peak_power)


def _least_torque(trial: Trial, lifted: Answer, *, size: float) -> float | None:
    """The least largest torque of any plan where torques have no limit, in units of `size`; the start's counts."""
    assert lifted.problem is not None
    seen = trial.search(lifted.problem, Aim(first="torque"), trial.max_stances)
    if not seen.ways:
        return None
    features = lifted.problem.measured(lifted.problem.replay(seen.codes).stances)
    return float(features[:, lifted.problem.features.index("peak")].max()) / size


def _peak_power(trial: Trial, lifted: Answer) -> float:
    """The most power that a plan found without a limit takes [W]."""
    assert lifted.problem is not None
    family = plan_family(trial.task)
    return max(family.power(stance) for stance in lifted.problem.replay(lifted.codes).stances)


def joint_dials(task: LimbedTask) -> Iterator[Dial]:
    """How much wider the ranges of all joints, of the shoulders or of the elbows are at each end; their middles stay."""
    if "joint" not in task.rules.hard:
        return
    for key, names in (
        ("all joint ranges, each end", ("shoulder", "elbow")),
        ("shoulder ranges, each end", ("shoulder",)),
        ("elbow ranges, each end", ("elbow",)),
    ):
        ranges = [
            (f"limbs.{limb.name}.{name}", getattr(limb, name).lower / DEGREE, getattr(limb, name).upper / DEGREE)
            for limb in task.robot.limbs
            for name in names
        ]
        room = 0.5 * (FULL_TURN - min(upper - lower for _, lower, upper in ranges))
        if room >= 0.1:
            yield Dial(
                key=key,
                present=0.0,
                most=min(WIDEST, math.floor(10.0 * room) / 10.0),
                unit="deg",
                per_unit=10,
                overrides=partial(_wider, ranges),
                nested=one_split(task) and not _reads_side(task),
            )


def _wider(ranges: list[tuple[str, float, float]], more: float) -> tuple[str, ...]:
    """Ranges [deg] that are wider by `more` at each end, up to a full turn."""
    made = []
    for key, lower, upper in ranges:
        each = min(more, 0.5 * (FULL_TURN - (upper - lower)))
        made += [f"{key}.lower={lower - each:.10g} deg", f"{key}.upper={upper + each:.10g} deg"]
    return tuple(made)


def one_split(task: LimbedTask) -> bool:
    """Whether how limbs share the weight follows from where they hold alone: two carriers at most, and the thesis's rule."""
    return task.rules.force_rule == "thesis" and task.rules.limb_in_use == "idle" and len(task.robot.limbs) <= 3


def _reads_side(task: LimbedTask) -> bool:
    """Whether a hard check beside `torque` reads which side an elbow takes."""
    hard = set(task.rules.hard)
    fenced = "keep_out" in hard and bool(task.world.keep_out)
    limited = "power" in hard and task.rules.max_power is not None
    return bool(hard & INTERFERENCE) or fenced or limited


def _stated_unit(task: LimbedTask, key: str) -> str:
    """The unit in which a quantity is written."""
    raw = Document(task.name, task.document).value_at(key)
    if isinstance(raw, dict):
        return str(raw.get("unit", ""))
    return "oz-in" if isinstance(raw, str) and "oz" in raw else ""
