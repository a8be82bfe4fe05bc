"""What happened, tick by tick: aims, measurements, torques, truth, as arrays with a time axis first."""

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from typing import Any, Final

import numpy as np

from ..control.chain import Chain
from ..control.controller import still_aim
from ..control.records import AXES, REPORT
from ..types import Floats, Records
from .log import Log


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


_AXES: Final = ("x", "y", "z", "about x", "about y", "about z")
_STATES: Final = (
    ("sensed", 0, "angle", "rad"),
    ("sensed", 1, "speed", "rad/s"),
    ("true", 0, "output angle", "rad"),
    ("true", 1, "output speed", "rad/s"),
)
_TORQUES: Final = (("commanded", "torque commanded"), ("applied", "torque"))


def trace_log(trace: LimbTrace, item: int = 0, notes: Mapping[str, str] | None = None) -> Log:
    """One limb of a trace as a log, up to where it left the finite numbers, if it did.

    Columns of aims, wrenches and reports that never leave their rest are left out.

    Args:
        trace: What happened.
        item: Which of the batch, from 0.
        notes: To be kept in the file, such as robot and limb.

    Raises:
        LogError: If not even the first tick is finite.
    """
    trace = _finite(trace, item)
    columns: dict[str, Floats] = {"time": trace.time.copy()}
    units = {"time": "s"}
    for j, joint in enumerate(trace.chain.joint_names):
        for key, which, word, unit in _STATES:
            columns[f"{joint} {word}"] = getattr(trace, key)[:, item, which, j].copy()
            units[f"{joint} {word}"] = unit
        for key, word in _TORQUES:
            columns[f"{joint} {word}"] = getattr(trace, key)[:, item, j].copy()
            units[f"{joint} {word}"] = "N m"
    aims = trace.aims[:, min(item, trace.aims.shape[1] - 1)]
    for name, values, rest in (
        *_cells("aim", aims, still_aim((0.0, 0.0))[0]),
        *_cells("report", trace.reports[:, item], np.zeros(1, REPORT)[0]),
        *((f"wrench {axis}", trace.wrenches[:, item, k], 0.0) for k, axis in enumerate(_AXES)),
    ):
        if np.any(values != rest):
            columns[name] = np.array(values, dtype=np.float64)
    return Log(columns, units, dict(notes or {}), "trace")


def _finite(trace: LimbTrace, item: int) -> LimbTrace:
    """The trace up to the first tick of which something is not finite."""
    parts = (getattr(trace, key)[:, item] for key in ("sensed", "true", "commanded", "applied", "wrenches"))
    bad = [~np.isfinite(part.reshape(len(part), -1)).all(axis=1) for part in parts]
    odd = np.flatnonzero(np.any(bad, axis=0))
    return trace.first(int(odd[0])) if odd.size else trace


def _cells(label: str, records: Records, rest: Any) -> list[tuple[str, Any, float]]:
    """Every number of a list of records: its column's name, its values, what it is at rest."""
    out = []
    for field in records.dtype.names or ():
        shape = records.dtype[field].shape
        for place in np.ndindex(*shape):
            name = " ".join((label, field, *map(str, place)))
            out.append(
                (name, records[field][(slice(None), *place)], float(rest[field][place] if shape else rest[field]))
            )
    return out
