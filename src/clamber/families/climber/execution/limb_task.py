"""What one limb of a climber is doing, and with what aim."""

from dataclasses import dataclass, field
from typing import Final, Literal, TypeAlias

import numpy as np

from ....types import Floats
from ..control import body_tick as at

LimbMode: TypeAlias = Literal["stance", "hang", "unloaded_contact", "swing_cartesian", "swing_joint", "contact_push"]
"""A limb holds the body, holds it alone while it swings as it will, clings to its hold without carrying, brings its tip or its joints
somewhere, or pulls along a direction."""
LIMB_MODES: Final = {
    "stance": at.STANCE, "hang": at.HANG, "unloaded_contact": at.UNLOADED_CONTACT, "swing_cartesian": at.SWING_CARTESIAN,
    "swing_joint": at.SWING_JOINT, "contact_push": at.CONTACT_PUSH,
}  # fmt: skip


@dataclass(slots=True)
class LimbTask:
    """What one limb is doing now."""

    mode: LimbMode
    hold: int = 0
    """Number of its hold; 0: none."""
    place: Floats = field(default_factory=lambda: np.zeros(2))
    """Of "stance": the hold, of "swing_cartesian": the aim, world frame [m]."""
    speed: Floats = field(default_factory=lambda: np.zeros(2))
    """Of the aim [m/s]."""
    angles: Floats = field(default_factory=lambda: np.zeros(2))
    """Of "swing_joint" and "hang" [rad]."""
    rates: Floats = field(default_factory=lambda: np.zeros(2))
    """Theirs [rad/s]."""
    accelerations: Floats = field(default_factory=lambda: np.zeros(2))
    """Of "swing_joint" [rad/s^2]."""
    loads: Floats = field(default_factory=lambda: np.zeros(2))
    """Of "hang": torques that bear the weight [N m]."""
    force: Floats = field(default_factory=lambda: np.zeros(2))
    """Of "contact_push": what the tip does to what it meets, world frame [N]."""
    tug: Floats = field(default_factory=lambda: np.zeros(2))
    """Of "contact_push": the steady part of that force which the body leans on; the limbs that hold carry that much less [N]."""
    damping: float = 150.0
    """Of "contact_push": of the tip's motion in the world [N s/m]."""
    side: int = 0
    """Where its elbow is kept by a soft stop before it is straight, +1 or -1; 0: it may pass."""
    pressed: bool = False
    """Of "contact_push": whether the tip has stopped against something, which then loads the joints."""

    def give_way(self) -> None:
        """Let the limb go where what it meets pushes it."""
        self.mode, self.pressed, self.force, self.tug = "contact_push", False, np.zeros(2), np.zeros(2)

    @property
    def pushes(self) -> bool:
        """Whether it pulls on something, and does not only give way."""
        return self.mode == "contact_push" and bool(self.force.any())

    def stay(self, angles: Floats) -> None:
        """Let the limb's joints keep to where they are, shape (2,) [rad]."""
        self.mode, self.angles = "swing_joint", angles.copy()
        self.rates, self.accelerations = np.zeros(2), np.zeros(2)

    @property
    def free(self) -> bool:
        """Whether the limb is moved through the air, and touches nothing that it knows of."""
        return self.mode in ("swing_cartesian", "swing_joint")

    @property
    def holds(self) -> bool:
        """Whether the limb carries the body."""
        return self.mode in ("stance", "hang")
