"""Grab and release with whatever a limb ends in: one pair of motions per kind of end effector."""

from collections.abc import Callable
from typing import Final

from ...types import Floats
from . import grip, motions
from .climber import Climber, Grabbed

GRABS: Final[dict[str, Callable[..., Grabbed]]] = {
    "hook": motions.grab,
    "foot": motions.grab,
    "gripper": grip.grab_with_gripper,
}
"""Kind of end effector -> how it takes a hold."""
RELEASES: Final[dict[str, Callable[[Climber, int], None]]] = {
    "hook": motions.release,
    "foot": motions.release,
    "gripper": grip.release_gripper,
}
"""Kind of end effector -> how it leaves its hold."""


def grab(climber: Climber, i: int, number: int, *, elbow: int = 0, home: Floats | None = None) -> Grabbed:
    """Bring limb `i` to a hold and hold on, with the elbow on a side: +1, -1, or 0 for either.

    The body goes to the pose `home` first where there is no way from where it is.

    Raises:
        FallenError: If the robot falls.
    """
    return GRABS[climber.robot.limbs[i].end.kind](climber, i, number, elbow=elbow, home=home)


def release(climber: Climber, i: int) -> None:
    """Take limb `i` off its hold; the others carry.

    Raises:
        FallenError: If the robot falls.
    """
    RELEASES[climber.robot.limbs[i].end.kind](climber, i)
