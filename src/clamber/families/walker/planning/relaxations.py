"""What can be relaxed in a two-frame walker's task. Each number is read by one check alone, so all of them are nested."""

from collections.abc import Iterator
from typing import Final

from ....planning.infeasibility.relaxations import Relaxation, Switch, key_dial
from ....toml_text import toml_value
from .task import WalkerTask

MM: Final = 1e-3
"""One millimetre [m]."""
LONGEST: Final = 4.0
"""Strokes up to so many times the present one are tried [-]."""


def walker_relaxations(task: WalkerTask) -> Iterator[Relaxation]:
    """Every kind of single relaxation of a walker's task."""
    rules, mechanism = task.rules, task.robot.mechanism
    if "stroke" in rules.hard:
        stroke = mechanism.stroke / MM
        yield key_dial("mechanism.stroke", stroke, most=LONGEST * stroke, unit="mm", per_unit=10, nested=True)
    if "stroke" in rules.hard and rules.stroke > 0.0:
        yield key_dial("rules.stroke", rules.stroke / MM, most=0.0, unit="mm", per_unit=10, nested=True)
    if "singular" in rules.hard and mechanism.guard < 1.0:
        yield key_dial("mechanism.guard", mechanism.guard, most=1.0, unit="", per_unit=1000, nested=True)
    if "foothold" in rules.hard and rules.clearance > 0.0:
        yield key_dial("rules.clearance", rules.clearance / MM, most=0.0, unit="mm", per_unit=10, nested=True)
    if "balance" in rules.hard and rules.balance > 0.0:
        yield key_dial("rules.balance", rules.balance / MM, most=0.0, unit="mm", per_unit=10, nested=True)
    if "legs" in rules.hard:
        stroke = task.robot.legs.stroke / MM
        yield key_dial("legs.stroke", stroke, most=LONGEST * stroke, unit="mm", per_unit=10, nested=True)
    if "foothold" in rules.hard:
        yield from _patches(task)


def _patches(task: WalkerTask) -> Iterator[Switch]:
    """Each patch that is not there."""
    raw = task.document["ground"].get("patches", [])
    for k in range(len(raw)):
        rest = toml_value([patch for other, patch in enumerate(raw) if other != k])
        yield Switch(key="ground.patches", before=f"patch {k}", after="dropped", overrides=(f"ground.patches={rest}",))
