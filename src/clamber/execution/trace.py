"""What happened, tick by tick: aims, measurements, torques, truth, as arrays with a time axis first."""

from dataclasses import dataclass

from ..control.chain import Chain
from ..types import Floats, Records


@dataclass(frozen=True, slots=True, eq=False)
class LimbTrace:
    """A batch of limbs over a run of `ticks`; row k holds tick k: what was sensed then, what was commanded, and the truth then."""

    chain: Chain
    """The chain as the controller believed it."""
    time: Floats
    """Shape (ticks,) [s]."""
    aims: Records
    """Records of `control.records.AIM`, shape (ticks, 1 or batch)."""
    sensed: Floats
    """Encoder angles and speeds, shape (ticks, batch, 2, n)."""
    true: Floats
    """True angles and speeds, shape (ticks, batch, 2, n)."""
    commanded: Floats
    """Torques of the controller, shape (ticks, batch, n) [N m]."""
    applied: Floats
    """Torques of the motors over the tick, shape (ticks, batch, n) [N m]."""
    wrenches: Floats
    """True wrench of the limb on what it touches, shape (ticks, batch, 6) [N], [N m]."""
    reports: Records
    """Records of `control.records.REPORT`, shape (ticks, batch)."""

    def sensed_places(self) -> Floats:
        """Tip by the encoders, base frame, shape (ticks, batch, 3) [m]."""
        return self._places(self.sensed)

    def true_places(self) -> Floats:
        """Tip in truth, base frame, shape (ticks, batch, 3) [m]."""
        return self._places(self.true)

    def wanted_places(self) -> Floats:
        """Where the tip was to be, base frame, shape (ticks, 1 or batch, 3) [m]."""
        places: Floats = self.aims["place"]
        return places

    def _places(self, states: Floats) -> Floats:
        ticks, batch, _, n = states.shape
        return self.chain.places(states[:, :, 0].reshape(-1, n)).reshape(ticks, batch, 3)
