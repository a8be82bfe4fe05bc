"""A body that a free limb pushes away by what it has met: pushed on, or only stood against, its hooks would come off."""

import math
from typing import Final

import numpy as np

from ....compiled import Handle, ready
from ..control.felt_force import see_push
from .climber import Climber

MOVED: Final = (0.002, 0.003)
"""A body moved so far off its aim is pushed away if a hook that held it holds no longer: by a limb that goes slowly, or briskly [m] ..."""
TURNED: Final = (math.radians(0.9), math.radians(1.3))
"""... or turned so far [rad]: a limb that sets out with all that its motors have turns it by a degree, too."""
IN_ANY_CASE: Final = (0.007, math.radians(3.0))
"""What a limb that goes slowly has moved or turned so far it pushes away [m], [rad]."""
COMES_BACK: Final = 0.25
"""For so long the limb then gives way [s]."""
HELD: Final = 5.0
"""A hook that pulled with more than this when the limb set out held the body [N] ..."""
LOOSE: Final = 1.5
"""... and no longer does when it pulls with less than this [N]."""


class PushedBody:
    """Watches a body at rest while a free limb goes somewhere; one that hangs on a single limb goes where it will.

    Args:
        climber: The robot, as the limb sets out.
        brisk: Whether the limb goes as fast as it can, and the body sways for that alone.
    """

    def __init__(self, climber: Climber, *, brisk: bool = False) -> None:
        self._climber, work = climber, climber.body.work
        # the least that it has been off its aim: what it learns of its holds moves its pose, and it then goes to its aim
        off, sways = np.full(2, math.inf), np.array((MOVED[brisk], TURNED[brisk]))
        surely = np.full(2, math.inf) if brisk else np.array(IN_ANY_CASE)
        self._see = ready(see_push, Handle(work.pose, work.aimed, work.jobs, off, sways, surely))
        self._held = [i for i in climber.holding() if self._pull(i) > HELD]

    def gives_way(self, i: int) -> bool:
        """Whether the body is pushed away, by the tick that has just been; limb `i` then lets what it has met push it back, for a while.

        Raises:
            SlippedError: If a hook has come off.
            FallenError: If the robot falls.
        """
        pushed = self._see()
        if not pushed or (pushed == 1 and all(self._pull(i) >= LOOSE for i in self._held)):
            return False
        body = self._climber.body
        body.tasks[i].give_way()
        self._climber.wait(COMES_BACK)
        body.tasks[i].stay(body.q[i])
        return True

    def _pull(self, i: int) -> float:
        """With what the hook of limb `i` pulls along its grab direction [N]; infinite where that cannot be told."""
        x, y = self._climber.fall.forces[i].tolist()
        along = self._climber.body.grab_direction(i)
        return x * along.item(0) + y * along.item(1) if math.isfinite(x + y) else math.inf
