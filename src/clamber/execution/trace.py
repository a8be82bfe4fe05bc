"""What happened, tick by tick: aims, measurements, torques, truth, as arrays with a time axis first."""

from dataclasses import dataclass, fields, replace

import numpy as np

from ..control.chain import Chain
from ..control.records import AXES, REPORT
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

    def first(self, ticks: int) -> "LimbTrace":
        """The trace of the first `ticks` ticks."""
        parts = (field.name for field in fields(self) if field.name != "chain")
        return replace(self, **{part: getattr(self, part)[:ticks] for part in parts})

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


def empty_trace(chain: Chain, aims: Records, period: float, batch: int) -> LimbTrace:
    """A trace whose ticks are still to be filled: NaN all over, but for its time, its aims and reports of zeros.

    Args:
        chain: As the controller believes it.
        aims: Records of `AIM`, shape (ticks, 1 or batch).
        period: Between two ticks [s].
        batch: Number of limbs.
    """
    ticks, n = aims.shape[0], chain.n
    return LimbTrace(
        chain=chain,
        time=np.arange(ticks, dtype=np.float64) * period,
        aims=aims,
        sensed=np.full((ticks, batch, 2, n), np.nan),
        true=np.full((ticks, batch, 2, n), np.nan),
        commanded=np.full((ticks, batch, n), np.nan),
        applied=np.full((ticks, batch, n), np.nan),
        wrenches=np.full((ticks, batch, AXES), np.nan),
        reports=np.zeros((ticks, batch), REPORT),
    )
