"""What pictures say in words: units that suit the task, the action between two stances, poses and holds."""

import math
from typing import Final

from ..tasks import Task
from ..units import DEGREE, INCH

DIRECTIONS: Final = (("right", 1.0 + 0j), ("left", -1.0 + 0j), ("up", 1j), ("down", -1j))


def length_unit(task: Task) -> tuple[str, float]:
    """Unit of length for people, and its size [m]: inches where the task steps by quarter inches, else centimetres."""
    quarters = 4.0 * task.step.length / INCH
    return ("in", INCH) if abs(quarters - round(quarters)) < 1e-6 else ("cm", 0.01)


def describe_pose(task: Task, x: float, y: float, angle: float) -> str:
    """A pose in words: x, y in the task's unit, angle in degrees."""
    unit, size = length_unit(task)
    turn = math.remainder(angle, math.tau) / DEGREE
    return f"x {x / size:.1f} {unit},  y {y / size:.1f} {unit},  {round(turn)}°"
