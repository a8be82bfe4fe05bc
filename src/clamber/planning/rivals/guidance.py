"""What guides the rivals: the genetic planner's own weights of progress, so that nobody knows more of a task than another."""

from typing import Final

import numpy as np

from ...types import Floats
from ..problem.problem import CompiledProblem

WEIGHTS: Final = {"body": 1.0, "limbs": 0.1, "stages": 0.5}
"""Feature -> weight, as in the genetic planner's profile `default`: per metre, per metre, per goal."""


def guidance(problem: CompiledProblem) -> Floats:
    """The weights in the order of the family's features; a feature that a family lacks weighs nothing."""
    return np.array([WEIGHTS.get(name, 0.0) for name in problem.features])
