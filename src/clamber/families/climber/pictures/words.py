"""Holds and actions of a climber in words."""

import cmath
import math

import numpy as np

from ....units import DEGREE
from ....viewing.words import DIRECTIONS, length_unit
from ..planning.arrays import CHECKS
from ..planning.task import LimbedTask


def describe_holds(task: LimbedTask, stance: np.void) -> str:
    """Which limb is on which hold."""
    words = []
    for i, name in enumerate(task.robot.limb_names):
        h = int(stance["hold"][i])
        words.append(f"{name} {task.world.holds[h].number if h >= 0 else 'free'}")
    return ", ".join(words)


def describe_action(task: LimbedTask, before: np.void, after: np.void, reason: int) -> str:
    """The action that led from one stance to the next, in a few words, from what it changed."""
    names, holds = task.robot.limb_names, task.world.holds
    words = []
    if int(after["resolved"]) >= 0:
        words.append(f"{names[int(after['in_use'])]} grabs {holds[int(after['resolved'])].number}")
    else:
        for i, name in enumerate(names):
            if int(before["hold"][i]) >= 0 and int(after["hold"][i]) < 0:
                words.append(f"{name} lets go of {holds[int(before['hold'][i])].number}")
    turned = float(after["turned"])
    if not words:
        words.append(_moved(task, before, after))
    if abs(turned) > 0.5 * DEGREE:
        words.append(f"swings {abs(turned) / DEGREE:.0f}°")
    if reason >= 0:
        words.append(f"violates {CHECKS[reason].replace('_', '-')}")
    return ", ".join(words)


def _moved(task: LimbedTask, before: np.void, after: np.void) -> str:
    start, end = complex(before["x"], before["y"]), complex(after["x"], after["y"])
    angle = float(after["angle"]) - float(before["angle"])
    held = [int(h) for h in after["hold"][: len(task.robot.limbs)] if h >= 0]
    if len(held) == 1:  # take the hang back, so that the move itself can be seen
        pivot = complex(task.world.holds[held[0]].x, task.world.holds[held[0]].y)
        end = pivot + (end - pivot) * cmath.exp(-1j * float(after["turned"]))
        angle -= float(after["turned"])
    way, turn = end - start, math.remainder(angle, math.tau) / DEGREE
    unit, size = length_unit(task)
    if abs(way) > 1e-6:
        name = max(DIRECTIONS, key=lambda d: (way * d[1].conjugate()).real)[0]
        return f"body {name} {abs(way) / size:.3g} {unit}"
    if abs(turn) > 1e-3:
        return f"body turns {turn:+.0f}°"
    return "stays"
