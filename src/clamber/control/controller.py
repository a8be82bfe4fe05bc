"""The controller: a law with its parameters, its own copy of the chain, its memory and scratch, and a check of what comes in."""

from collections.abc import Sequence
from typing import Any, Final, NoReturn

import numpy as np
from numpy.typing import NDArray

from ..compiled import ready
from ..errors import StatedError
from ..types import Floats, Records
from .chain import Chain
from .drive import ARRAYS, CONTROLLER_BUFFERS, JOINTS, LAWS, LENGTH, MEMORY, SIDE, drive_packed
from .kinematics import FRAME
from .law_settings import LawError, LawSettings
from .law_state import LINES, SQUARES, line_length
from .records import AIM, AXES, JOINT, REPORT, ROOT, SETTINGS


class MeasurementError(StatedError):
    """A measurement that is not a finite number: names the limb of the batch, the quantity and the value."""

    says = "{chain}, limb {limb} of the batch: measured {quantity} is {value}; it must be finite"
    chain: str
    quantity: str
    value: float
    limb: int


class AimError(StatedError):
    """An aim that is not a finite number: names the limb of the batch, the quantity and the value."""

    says = "{chain}, limb {limb} of the batch: the aim's {quantity} is {value}; it must be finite"
    chain: str
    quantity: str
    value: float
    limb: int


class ShapeError(StatedError):
    """An array of the wrong shape or kind: names the chain, the array, what it is and what is allowed."""

    says = "{chain}: {array} {value}: {allowed}"
    chain: str
    array: str
    value: str
    allowed: str


FLOAT: Final = np.dtype(np.float64)


def memory_length(n: int) -> int:
    """Numbers that a controller remembers for a chain of `n` joints: its law's, then by joint the torque loop's and the last motion's."""
    return 1 + max(2 * max(n, AXES), n + 12) + 2 * n


class Controller:
    """One law or several on a batch of limbs of one chain.

    Args:
        chain: The chain as the controller believes it to be; its K' is renewed by each law's `weight`.
        settings: One law for the whole batch, or one for each limb of it.
        period: Between two ticks [s].
        batch: Number of limbs.

    Raises:
        LawError: If a law's settings do not fit the chain, or laws of one batch weigh the joints differently.
    """

    def __init__(
        self, chain: Chain, settings: LawSettings | Sequence[LawSettings], *, period: float, batch: int = 1
    ) -> None:
        laws = (settings,) if isinstance(settings, LawSettings) else tuple(settings)
        if len(laws) not in (1, batch):
            raise LawError("controller", "settings", len(laws), f"must be one law, or {batch}: one for each limb")
        if batch < 1:
            raise LawError("controller", "batch", batch, "must be 1 or more")
        self.chain: Final = _weighed(chain, laws)
        self.laws: Final = laws
        self.period: Final = period
        self.batch: Final = batch
        n = chain.n
        self.torques: Final = np.zeros((batch, n))
        """Of the last tick, shape (batch, n) [N m]; overwritten by the next."""
        self.reports: Final = np.zeros(batch, REPORT)
        """Of the last tick, records of `REPORT`."""
        self._memory = np.zeros((batch, memory_length(n)))
        length = line_length(n)
        size = max(n, AXES)
        self._arrays = (
            _as_records(self.chain.joints, JOINT),
            _as_records(self.chain.root, ROOT),
            _as_records(np.concatenate([law.record(self.chain, period) for law in laws]), SETTINGS),
            self._memory,
            np.zeros((2 * n, FRAME)),
            np.zeros((LINES, length)),
            np.zeros((SQUARES, size, size)),
            self.torques,
            self.reports,
        )
        self._buffers = np.zeros(CONTROLLER_BUFFERS, np.int64)
        self._buffers[:ARRAYS] = [array.ctypes.data for array in self._arrays]
        self._buffers[[JOINTS, LAWS, MEMORY, LENGTH, SIDE]] = n, len(laws), self._memory.shape[1], length, size
        self._nothing_felt = felt = np.zeros((batch, AXES))
        self._drive = ready(drive_packed, self._buffers, still_aim((0.0, 0.0)), np.zeros((batch, 2, n)), felt, felt)
        self._state_shape, self._felt_shape = (batch, 2, n), (batch, AXES)
        self._aim_shapes = ((1,), (batch,))

    def __reduce__(self) -> NoReturn:
        raise TypeError("a controller stays where it was made: copy its chain and settings instead")

    def reset(self) -> None:
        """Forget what the laws remember."""
        self._memory[:] = 0.0

    @property
    def memory(self) -> Floats:
        """What the laws remember, shape (batch, `memory_length`): the controller's own array, for those who analyse a loop."""
        return self._memory

    @property
    def buffers(self) -> NDArray[np.int64]:
        """Addresses for `drive_packed`, so that a kernel can call this controller: its own array, shape (DESK,), valid while it lives."""
        return self._buffers

    def command(
        self, aims: Records, states: Floats, wrenches: Floats | None = None, mounts: Floats | None = None
    ) -> Floats:
        """Joint torques of one tick.

        Args:
            aims: Records of `AIM`, shape (1,) for all or (batch,).
            states: Sensed joint angles and speeds, shape (batch, 2, n) [rad], [rad/s].
            wrenches: Sensed wrench of each limb on what it touches, base frame, shape (batch, 6) [N], [N m]; None: nothing felt.
            mounts: Sensed wrench of each limb on its mount, about the origin of the base frame, shape (batch, 6) [N], [N m]; None: nothing
                felt. Only a law whose `torque_sensor` is the base reads it.

        Returns:
            Torques within the motors' limits, shape (batch, n) [N m]: the controller's own array, overwritten by the next tick.

        Raises:
            MeasurementError: If a measurement is not finite; the other limbs of the batch have their torques.
            AimError: Likewise of an aim.
            ShapeError: If something is not an array of this shape and kind, nor numbers that make one.
        """
        felt = self._nothing_felt if wrenches is None else wrenches
        carried = self._nothing_felt if mounts is None else mounts
        try:  # as cheap as can be: the rest is done only if something is not as it should be
            fits = (
                states.shape == self._state_shape
                and states.dtype is FLOAT
                and states.flags.c_contiguous
                and felt.shape == self._felt_shape
                and felt.dtype is FLOAT
                and felt.flags.c_contiguous
                and carried.shape == self._felt_shape
                and carried.dtype is FLOAT
                and carried.flags.c_contiguous
                and aims.shape in self._aim_shapes
                and aims.dtype is AIM
                and aims.flags.c_contiguous
            )
        except AttributeError:
            fits = False
        if not fits:
            states = self._as_floats("states", states, self._state_shape)
            felt = self._as_floats("wrenches", felt, self._felt_shape)
            carried = self._as_floats("mounts", carried, self._felt_shape)
            aims = self._as_aims(aims)
        bad = self._drive(self._buffers, aims, states, felt, carried)
        if bad >= 0:
            self._complain(bad, aims, states, felt, carried)
        return self.torques

    def explain(self, limb: int = 0) -> str:
        """What bore on the last tick of one limb, in one line: nearness to a singular pose, damping, motors at their limits."""
        report, law = self.reports[limb], self.laws[limb if len(self.laws) > 1 else 0]
        damping, limited = float(np.sqrt(report["lambda2"])), int(report["saturated"])
        damped = f"damping lambda = {damping:.3g}" if damping > 0.0 else "no damping"
        motors = f"{limited} of {self.chain.n} motors at a limit" if limited else "no motor at a limit"
        return (
            f"{law.law} on {self.chain.name}: smallest singular value {report['sigma']:.3g}, {damped} "
            f"(it starts below {law.sigma:g}); {motors}"
        )

    def _as_floats(self, name: str, values: Any, shape: tuple[int, ...]) -> Floats:
        try:
            out: Floats = np.ascontiguousarray(values, dtype=np.float64)
        except (TypeError, ValueError):
            raise ShapeError(self.chain.name, name, repr(values)[:80], f"must be numbers of shape {shape}") from None
        if out.shape != shape:
            raise ShapeError(self.chain.name, name, f"of shape {out.shape}", f"must be of shape {shape}")
        return out

    def _as_aims(self, aims: Any) -> Records:
        allowed = f"must be records of AIM, of shape {' or '.join(map(str, dict.fromkeys(self._aim_shapes)))}"
        if getattr(aims, "dtype", None) != AIM:
            raise ShapeError(self.chain.name, "aims", getattr(aims, "dtype", type(aims).__name__), allowed)
        if aims.shape not in self._aim_shapes:
            raise ShapeError(self.chain.name, "aims", f"of shape {aims.shape}", allowed)
        out: Records = np.ascontiguousarray(aims).view(AIM)
        return out

    def _complain(self, bad: int, aims: Records, states: Floats, wrenches: Floats, mounts: Floats) -> None:
        for row, quantity in enumerate(("angle", "speed")):
            for name, value in zip(self.chain.joint_names, states[bad, row], strict=True):
                if not np.isfinite(value):
                    raise MeasurementError(self.chain.name, f"{quantity} of the {name}", float(value), bad)
        for where, wrench in (("wrench", wrenches), ("wrench on the mount", mounts)):
            for axis, value in zip(["Fx", "Fy", "Fz", "Mx", "My", "Mz"], wrench[bad], strict=True):
                if not np.isfinite(value):
                    raise MeasurementError(self.chain.name, f"{where} {axis}", float(value), bad)
        aim = aims[bad if aims.size > 1 else 0]
        for quantity in AIM.names or ():
            for value in np.ravel(aim[quantity]):
                if not np.isfinite(value):
                    raise AimError(self.chain.name, quantity, float(value), bad)
        raise MeasurementError(self.chain.name, "sum of angles, speeds, wrench and aim", float("inf"), bad)


def _weighed(chain: Chain, laws: Sequence[LawSettings]) -> Chain:
    """The chain with the K' that all laws of a batch agree on.

    Raises:
        LawError: If they do not.
    """
    found: dict[tuple[float, ...], tuple[str, Chain]] = {}
    for law in {(law.law, law.weight): law for law in laws if law.weighs_joints()}.values():
        weighed = law.weigh(chain)
        found.setdefault(
            tuple(weighed.joints["share"].tolist()), (f"{law.weight or 'the chain'} for {law.law}", weighed)
        )
    if len(found) > 1:
        choices = ", ".join(label for label, _ in found.values())
        raise LawError("controller", "weight", choices, "must give the same K' to all laws of one batch")
    return next(iter(found.values()))[1] if found else chain


def _as_records(records: Records, dtype: Any) -> Records:
    out = np.zeros(records.shape, dtype)
    out[:] = records
    return out


def still_aim(place: Sequence[float] | Floats, batch: int = 1) -> Records:
    """Aims that stand still at a place of the base frame [m], records of `AIM`, shape (batch,)."""
    out = np.zeros(batch, AIM)
    out["place"][:, : len(place)] = place
    out["turn"] = np.eye(3)
    return out
