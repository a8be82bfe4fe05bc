"""The controller: a law with its parameters, its own copy of the chain, its memory and scratch, and a check of what comes in."""

from collections.abc import Sequence
from typing import Final

import numpy as np

from ..errors import ClamberError
from ..types import Floats, Records
from .chain import Chain
from .drive import drive
from .kinematics import FRAME
from .law_settings import LawError, LawSettings
from .moment import LINES, SQUARES, line_length
from .records import AIM, AXES, REPORT


class MeasurementError(ClamberError):
    """A measurement that is not a finite number: names the limb of the batch, the quantity and the value."""

    def __init__(self, chain: str, quantity: str, value: float, limb: int) -> None:
        super().__init__(chain, quantity, value, limb)
        self.chain, self.quantity, self.value, self.limb = chain, quantity, value, limb

    def __str__(self) -> str:
        return (
            f"{self.chain}, limb {self.limb} of the batch: measured {self.quantity} is {self.value}; it must be finite"
        )


def memory_length(n: int) -> int:
    """Numbers that a law remembers for a chain of `n` joints, at most."""
    return 1 + 2 * max(n, AXES)


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
        bases = {law.weight for law in laws} - {None, "none"}
        if len(bases) > 1:
            raise LawError("controller", "weight", sorted(map(str, bases)), "must be the same in one batch")
        weighing = next((law for law in laws if law.weight in bases), laws[0])
        self.chain: Final = weighing.weigh(chain)
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
        self._fixed = (
            self.chain.joints,
            self.chain.root,
            np.concatenate([law.record(self.chain, period) for law in laws]),
        )
        self._scratch = (
            self._memory,
            np.zeros((2 * n, FRAME)),
            np.zeros((LINES, length)),
            np.zeros((SQUARES, size, size)),
            self.torques,
            self.reports,
        )
        self._nothing_felt = np.zeros((batch, AXES))

    def reset(self) -> None:
        """Forget what the laws remember."""
        self._memory[:] = 0.0

    @property
    def memory(self) -> Floats:
        """What the laws remember, shape (batch, `memory_length`): the controller's own array, for those who analyse a loop."""
        return self._memory

    def command(self, aims: Records, states: Floats, wrenches: Floats | None = None) -> Floats:
        """Joint torques of one tick.

        Args:
            aims: Records of `AIM`, shape (1,) for all or (batch,).
            states: Sensed joint angles and speeds, shape (batch, 2, n) [rad], [rad/s].
            wrenches: Sensed wrench of each limb on what it touches, base frame, shape (batch, 6) [N], [N m]; None: nothing felt.

        Returns:
            Torques within the motors' limits, shape (batch, n) [N m]: the controller's own array, overwritten by the next tick.

        Raises:
            MeasurementError: If a measurement is not finite; the other limbs of the batch have their torques.
        """
        felt = self._nothing_felt if wrenches is None else wrenches
        bad = drive(*self._fixed, aims, states, felt, *self._scratch)
        if bad >= 0:
            self._complain(bad, states, felt)
        return self.torques

    def _complain(self, bad: int, states: Floats, wrenches: Floats) -> None:
        for row, quantity in enumerate(("angle", "speed")):
            for name, value in zip(self.chain.joint_names, states[bad, row], strict=True):
                if not np.isfinite(value):
                    raise MeasurementError(self.chain.name, f"{quantity} of the {name}", float(value), bad)
        for axis, value in zip(["Fx", "Fy", "Fz", "Mx", "My", "Mz"], wrenches[bad], strict=True):
            if not np.isfinite(value):
                raise MeasurementError(self.chain.name, f"wrench {axis}", float(value), bad)
        raise MeasurementError(self.chain.name, "state", float("inf"), bad)


def still_aim(place: Sequence[float] | Floats, batch: int = 1) -> Records:
    """Aims that stand still at a place of the base frame [m], records of `AIM`, shape (batch,)."""
    out = np.zeros(batch, AIM)
    out["place"][:, : len(place)] = place
    out["turn"] = np.eye(3)
    return out
