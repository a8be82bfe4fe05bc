"""What can be relaxed in a task of a robot in space; each number is read by a few checks alone, and more of it never forbids more."""

import math
from collections.abc import Iterator
from typing import Any, Final

from ....errors import UnitError
from ....planning.infeasibility.relaxations import Relaxation, key_dial
from ....units import DEGREE, read_quantity
from .task import SpatialTask

MM: Final = 1e-3
"""One millimetre [m]."""
MOST: Final = 4.0
"""Strengths and torques up to so many times the present ones are tried [-]."""
TURN: Final = 180.0
"""Largest jump of a joint that is tried [deg]."""
STRENGTHS: Final = {"friction": ("ratio", "", 100), "pull": ("force", "N", 10)}
"""Key of a contact's file -> its dimension, the unit that it is told in, and steps per unit."""


def spatial_relaxations(task: SpatialTask) -> Iterator[Relaxation]:
    """Every kind of single relaxation of a task of a robot in space."""
    rules = task.rules
    robot = task.robot.spec
    if "equilibrium" in rules.hard:
        if rules.need > 0.0:
            yield key_dial("rules.need", rules.need, most=0.0, unit="", per_unit=1000, nested=True)
        yield key_dial("robot.torque_share", robot.torque_share, most=1.0, unit="", per_unit=100, nested=True)
        yield from _strengths(task)
    if "reach" in rules.hard and robot.stretch < 1.0:
        yield key_dial("robot.stretch", robot.stretch, most=1.0, unit="", per_unit=1000, nested=True)
    if "limb_limb" in rules.hard and robot.limb_room > 0.0:
        yield key_dial("robot.limb_room", robot.limb_room / MM, most=0.0, unit="mm", per_unit=1, nested=True)
    if "jump" in rules.hard:
        yield key_dial("rules.jump", rules.jump / DEGREE, most=TURN, unit="deg", per_unit=1, nested=True)
    if "clearance" in rules.hard and rules.clearance > 0.0:
        yield key_dial("rules.clearance", rules.clearance / MM, most=0.0, unit="mm", per_unit=1, nested=True)
    if "swing" in rules.hard and rules.lift > 0.0:
        yield key_dial("rules.lift", rules.lift / MM, most=0.0, unit="mm", per_unit=1, nested=False)


def _strengths(task: SpatialTask) -> Iterator[Relaxation]:
    """Friction and pull-off force of each contact that limbs of the robot have."""
    for name, contact in task.document["robot"]["contacts"].items():
        for key, (dimension, unit, per_unit) in STRENGTHS.items():
            value = _stated(contact.get(key), dimension)
            if value is not None and 0.0 < value < math.inf:
                dotted = f"robot.contacts.{name}.{key}"
                yield key_dial(dotted, value, most=MOST * value, unit=unit, per_unit=per_unit, nested=True)


def _stated(raw: Any, dimension: str) -> float | None:
    try:
        return None if raw is None else read_quantity(raw, dimension)
    except UnitError:
        return None
