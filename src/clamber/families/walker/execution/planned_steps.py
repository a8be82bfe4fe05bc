"""A walker's plan as steps: one for each time that a frame is lifted, moved and put down."""

import numpy as np

from ....planning.problem.codes import Code
from ....planning.problem.problem import Replay
from ....types import Floats, Ints
from ..statics.stance import DELTA
from .course import PlannedStep


def planned_steps(codes: Ints, replay: Replay) -> tuple[PlannedStep, ...]:
    """The steps of a plan; a frame that is lifted and put down where it was makes none.

    Args:
        codes: The plan's actions, shape (n,).
        replay: The plan carried out in its task, of `n` actions.
    """
    steps: list[PlannedStep] = []
    corners: list[Floats] = []
    last: int | None = None
    for code, before, after in zip(codes.tolist(), replay.stances[:-1], replay.stances[1:], strict=True):
        swing = 1 - int(before["stands"])
        kind = Code.of(code).kind
        if kind == "move":
            if code == last:
                corners.pop()
            corners.append(np.array(after["pose"][swing]))
        elif kind == "release" and corners:
            steps.append(PlannedStep(swing, np.array(corners), np.array(before["pose"][1 - swing])))
            corners = []
        last = code
    if corners:
        end = replay.stances[-1]
        swing = 1 - int(end["stands"])
        steps.append(PlannedStep(swing, np.array(corners), np.array(end["pose"][1 - swing])))
    return tuple(steps)


def plan_start(replay: Replay) -> Floats:
    """Pose of the Delta-frame at a plan's start: x, y [m], heading [rad], shape (3,)."""
    return np.array(replay.stances[0]["pose"][DELTA])
