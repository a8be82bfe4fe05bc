"""What can be relaxed in a two-frame walker's task. Each number is read by one check alone, so all of them are nested."""

from collections.abc import Iterator
from functools import partial
from typing import Final

from ...tasks.walker import WalkerTask
from ...toml_text import toml_value
from .relaxations import Dial, Relaxation, Switch

MM: Final = 1e-3
"""One millimetre [m]."""
LONGEST: Final = 4.0
"""Strokes up to so many times the present one are tried [-]."""


def walker_relaxations(task: WalkerTask) -> Iterator[Relaxation]:
    """Every kind of single relaxation of a walker's task."""
    rules, mechanism = task.rules, task.robot.mechanism
    if "stroke" in rules.hard:
        yield _dial("mechanism.stroke", mechanism.stroke / MM, "mm", 10, most=LONGEST * mechanism.stroke / MM)
    if "singular" in rules.hard and mechanism.guard < 1.0:
        yield _dial("mechanism.guard", mechanism.guard, "", 1000, most=1.0)
    if "foothold" in rules.hard and rules.clearance > 0.0:
        yield _dial("rules.clearance", rules.clearance / MM, "mm", 10, most=0.0)
    if "balance" in rules.hard and rules.balance > 0.0:
        yield _dial("rules.balance", rules.balance / MM, "mm", 10, most=0.0)
    if "foothold" in rules.hard:
        yield from _patches(task)


def _dial(key: str, present: float, unit: str, per_unit: int, *, most: float) -> Dial:
    return Dial(
        key=key,
        present=present,
        most=most,
        unit=unit,
        per_unit=per_unit,
        overrides=partial(_set, key, unit),
        nested=True,
    )


def _set(key: str, unit: str, value: float) -> tuple[str, ...]:
    return (f"{key}={value:.10g} {unit}".rstrip(),)


def _patches(task: WalkerTask) -> Iterator[Switch]:
    """Each patch that is not there."""
    for kind in ("boxes", "polygons"):
        raw = task.document["field"].get(kind, [])
        for k in range(len(raw)):
            rest = toml_value([patch for other, patch in enumerate(raw) if other != k])
            key = f"field.{kind}"
            yield Switch(key=key, before=f"patch {k}", after="dropped", overrides=(f"{key}={rest}",))
