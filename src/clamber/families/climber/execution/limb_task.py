"""What one limb of a climber is doing, and with what aim."""

from dataclasses import dataclass, field
from typing import Any, ClassVar, Final, Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

from ....types import Floats, Records
from ..control import planar_limb as at

LimbMode: TypeAlias = Literal["stance", "hang", "unloaded_contact", "swing_cartesian", "swing_joint", "contact_push"]
"""A limb holds the body, holds it alone while it swings as it will, clings to its hold without carrying, brings its tip or its joints
somewhere, or pulls along a direction."""
LIMB_MODES: Final = {
    "stance": at.STANCE, "hang": at.HANG, "unloaded_contact": at.UNLOADED_CONTACT, "swing_cartesian": at.SWING_CARTESIAN,
    "swing_joint": at.SWING_JOINT, "contact_push": at.CONTACT_PUSH,
}  # fmt: skip


@dataclass
class LimbTask:
    """What one limb is doing now. Once it is attached, a compiled tick reads what is assigned to it; arrays are assigned whole."""

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

    _read: ClassVar[dict[str, NDArray[Any]]] = {}
    """Field -> where a compiled tick reads it."""

    def __setattr__(self, name: str, value: Any) -> None:
        """Assign, and let the compiled tick read it."""
        object.__setattr__(self, name, value)
        read = self._read.get(name)
        if read is not None:
            read[:] = LIMB_MODES[value] if name == "mode" else value

    def attach(self, records: Records, i: int) -> None:
        """Let record `i` of `LIMB_TASK` be what this is, from now on."""
        names = records.dtype.names or ()
        object.__setattr__(self, "_read", {name: records[name][i : i + 1] for name in names})
        for name in names:
            setattr(self, name, getattr(self, name))

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
