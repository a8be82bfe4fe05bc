"""What can be relaxed in a limbed climber's task: distances, limits of joints and motors, rules, actions, boxes."""

from collections.abc import Iterator
from typing import Final

from ....files import Document
from ....planning.infeasibility.relaxations import Relaxation, Switch, key_dial
from ....toml_text import toml_value
from ....units import DEGREE
from .inventory import DIRECTIONS, whole_kinds
from .relaxed_limits import joint_dials, motor_dials, one_split
from .task import LimbedTask

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
    if "reach" in rules.hard and rules.reach_offset > 0.0:
        key = "rules.reach_offset"
        yield key_dial(key, rules.reach_offset / MM, most=0.0, unit="mm", per_unit=10, nested=True)
        if rules.offset_while_holding:
            free = "rules.offset_while_holding"
            yield Switch(key=free, before="true", after="false", overrides=(f"{free}=false",))
    if "reach" in rules.hard and rules.holding_offset > 0.0:
        key = "rules.holding_offset"
        yield key_dial(key, rules.holding_offset / MM, most=0.0, unit="mm", per_unit=10, nested=True)
    if "holder_peg" in rules.hard and rules.hook_width > 0.0:
        yield key_dial("rules.hook_width", rules.hook_width / MM, most=0.0, unit="mm", per_unit=10, nested=True)
    if "stability" in rules.hard and rules.inside > 0.0:
        yield key_dial("rules.inside", rules.inside / MM, most=0.0, unit="mm", per_unit=10, nested=True)
    if {"clearance", "swing"} & set(rules.hard) and rules.clearance > 0.0:
        yield key_dial("rules.clearance", rules.clearance / MM, most=0.0, unit="mm", per_unit=10, nested=True)


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
