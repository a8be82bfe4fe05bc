"""Grab and release with whatever a limb ends in."""

from typing import Final

from ....types import Floats
from . import grabbing, grip, hook
from .climber import Climber, Grabbed

ENDS: Final[dict[str, grabbing.End]] = {"hook": hook, "foot": hook, "gripper": grip}
"""Kind of end effector -> how it takes holds and leaves them."""


def grab(climber: Climber, i: int, number: int, *, elbow: int = 0, home: Floats | None = None) -> Grabbed:
    """Bring limb `i` to a hold and hold on, with the elbow on a side: +1, -1, or 0 for either (`grabbing.grab`).

    The body goes to the pose `home` first where there is no way from where it is.

    Raises:
        FallenError: If the robot falls.
    """
    end = ENDS[climber.robot.limbs[i].end.kind]
    return grabbing.grab(climber, i, number, end, elbow=elbow, home=home)


def press_on(climber: Climber, i: int) -> bool:
    """Bring limb `i`, which has slid on its hold, but not off it, home from where it is; whether it holds (`grabbing.press_on`).

    Raises:
        FallenError: If the robot falls.
    """
    return grabbing.press_on(climber, i, ENDS[climber.robot.limbs[i].end.kind])


def release(climber: Climber, i: int) -> None:
    """Take limb `i` off its hold; the others carry.

    Raises:
        FallenError: If the robot falls.
    """
    ENDS[climber.robot.limbs[i].end.kind].release(climber, i)
