"""What can be relaxed in a limbed climber's task: distances, limits of joints and motors, rules, actions, boxes.

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
from ....planning.infeasibility.relaxations import Dial, Relaxation, Switch, key_dial
from ....planning.infeasibility.trial import Answer, Trial
from ....toml_text import toml_value
from ....units import DEGREE, OZ_IN
from .inventory import DIRECTIONS, whole_kinds
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
    return float(lifted.problem.replay(lifted.codes).stances["power"].max())


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


MM: Final = 1e-3
"""One millimetre [m]."""


def climber_relaxations(task: LimbedTask) -> Iterator[Relaxation]:
    """Every kind of single relaxation of a climber's task."""
    yield from _distances(task)
    yield from motor_dials(task)
    yield from joint_dials(task)
    yield from _rules(task)
    yield from _actions(task)
    yield from _boxes(task)


def _distances(task: LimbedTask) -> Iterator[Relaxation]:
    rules = task.rules
    for name, checks in (
        ("reach_offset", {"reach"}),
        ("holding_offset", {"reach"}),
        ("hook_width", {"holder_peg"}),
        ("inside", {"stability"}),
        ("clearance", {"clearance", "swing"}),
    ):
        present = getattr(rules, name)
        if checks & set(rules.hard) and present > 0.0:
            yield key_dial(f"rules.{name}", present / MM, most=0.0, unit="mm", per_unit=10, nested=True)
            if name == "reach_offset" and rules.offset_while_holding:
                free = "rules.offset_while_holding"
                yield Switch(key=free, before="true", after="false", overrides=(f"{free}=false",))


def _rules(task: LimbedTask) -> Iterator[Relaxation]:
    rules = task.rules
    if rules.branch == "kept":
        yield Switch(key="rules.branch", before="kept", after="free", overrides=("rules.branch=free",))
    coned = any(limb.end.kind != "gripper" and limb.end.cone is None for limb in task.robot.limbs)
    if "hook" in rules.hard and coned and rules.hook_cone < 90.0 * DEGREE - 1e-9:
        present = rules.hook_cone / DEGREE
        yield key_dial("rules.hook_cone", present, most=90.0, unit="deg", per_unit=10, nested=one_split(task))
    if "hook" in rules.hard and any(limb.end.kind != "gripper" for limb in task.robot.limbs) and rules.hook_pull > 0.0:
        yield key_dial("rules.hook_pull", rules.hook_pull, most=0.0, unit="N", per_unit=10, nested=one_split(task))
    if "support" in rules.hard and rules.min_supports > 1:
        fewer = rules.min_supports - 1
        key = "rules.min_supports"
        yield Switch(key=key, before=f"{fewer + 1}", after=f"{fewer}", overrides=(f"{key}={fewer}",))
    if "hangs" in rules.hard and rules.max_hangs >= 0:
        more = rules.max_hangs + 1
        key = "rules.max_hangs"
        yield Switch(key=key, before=f"{rules.max_hangs}", after=f"{more}", overrides=(f"{key}={more}",))


def _actions(task: LimbedTask) -> Iterator[Relaxation]:
    """Actions that `rules.allowed` leaves out: one by one, then both ways of an axis."""
    if task.rules.allowed is None:
        return
    bits, _ = whole_kinds(task)
    out = [word for bit, word in enumerate((*DIRECTIONS, "release", "grab")) if not bits & (1 << bit)]
    pairs = [(DIRECTIONS[i], DIRECTIONS[i + 1]) for i in (0, 2, 4)]
    for words in [(word,) for word in out] + [pair for pair in pairs if set(pair) <= set(out)]:
        allowed = toml_value([*task.rules.allowed, *words])
        yield Switch(
            key="rules.allowed",
            before=f"no {' '.join(words)}",
            after=f"with {' '.join(words)}",
            overrides=(f"rules.allowed={allowed}",),
            larger=len(words) > 1,
        )


def _boxes(task: LimbedTask) -> Iterator[Relaxation]:
    """Boxes that limbs must keep to, holds that they may not use, and regions that nothing may enter: each by itself, then all."""
    document = Document(task.name, task.document)
    for key, what, present in (
        ("rules.keep", "box", task.rules.keep),
        ("board.keep_out", "region", task.world.keep_out if "keep_out" in task.rules.hard else ()),
    ):
        if not present:
            continue
        raw = list(document.value_at(key))
        names = [f"{what} of '{entry['limb']}'" if "limb" in entry else f"{what} {k}" for k, entry in enumerate(raw)]
        left = [([entry for other, entry in enumerate(raw) if other != k], names[k]) for k in range(len(raw))]
        if len(raw) > 1:
            left.append(([], "all"))
        for rest, name in left:
            override = f"{key}={toml_value(rest)}"
            yield Switch(key=key, before=name, after="dropped", overrides=(override,), larger=name == "all")
    if task.rules.barred:
        yield Switch(
            key="rules.barred", before="holds barred", after="dropped", overrides=("rules.barred={}",), larger=False
        )
