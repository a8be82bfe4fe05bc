"""Laws that other packages add. They are Python, called limb by limb and tick by tick: on the limb bench, not in a body's compiled tick."""

from typing import Any, Final, Protocol

import numpy as np

from ..extensions import blamed, failure, load_outside
from ..types import Floats, Records
from .chain import Chain
from .controller import Controller
from .law_settings import LAWS, LawSettings
from .records import AXES, REPORT


class OutsideLaw(Protocol):
    """One limb's law, with what it remembers. Its factory has an entry point in the group `clamber.laws`."""

    def reset(self) -> None:
        """Forget what it remembers; called before each run."""

    def torques(self, aim: np.void, q: Floats, qd: Floats, wrench: Floats) -> Floats:
        """Torques of one tick, shape (n,) [N m]; what the motors cannot give is cut off.

        Args:
            aim: Record of `control.records.AIM`: "place" (3,) [m], "twist" and "acceleration" (6,) [m/s], [rad/s] and so on,
                "wrench" (6,) [N], [N m], and "turn" (3, 3), all in the base frame.
            q, qd: Sensed joint angles and speeds, shape (n,) [rad], [rad/s].
            wrench: Sensed wrench of the limb on what it touches, base frame, shape (6,) [N], [N m]; zero without a sensor.
        """


class LoopController(Protocol):
    """What `close_loop` needs of a controller."""

    @property
    def chain(self) -> Chain:
        """As the controller believes it to be."""

    @property
    def period(self) -> float:
        """Between two ticks [s]."""

    @property
    def batch(self) -> int:
        """Number of limbs."""

    @property
    def torques(self) -> Floats:
        """Of the last tick, shape (batch, n) [N m]; the same array for its whole life."""

    @property
    def reports(self) -> Records:
        """Of the last tick, records of `REPORT`, shape (batch,); the same array for its whole life."""

    def reset(self) -> None:
        """Forget what the laws remember."""

    def command(
        self, aims: Records, states: Floats, wrenches: Floats | None = None, mounts: Floats | None = None
    ) -> Floats:
        """See `Controller.command`."""


class OutsideController:
    """A law of another package on a batch of limbs of one chain; it takes the place of a `Controller` on the limb bench.

    Args:
        chain: The chain as the controller believes it to be.
        settings: The law by name, with its settings.
        period: Between two ticks [s].
        batch: Number of limbs.

    Raises:
        ExtensionError: If the law cannot be made, or later what it answers is no torque.
    """

    def __init__(self, chain: Chain, settings: LawSettings, *, period: float, batch: int = 1) -> None:
        self.chain, self.period, self.batch = chain, period, batch
        self.torques: Floats = np.zeros((batch, chain.n))
        self.reports: Records = np.zeros(batch, REPORT)
        self._name: Final = settings.law
        make = load_outside("controllers", self._name)
        with blamed("controllers", self._name):
            self._laws = [make(chain, settings, period) for _ in range(batch)]
        self._nothing_felt = np.zeros((batch, AXES))

    def reset(self) -> None:
        """See `Controller`."""
        with blamed("controllers", self._name):
            for law in self._laws:
                law.reset()

    def command(
        self, aims: Records, states: Floats, wrenches: Floats | None = None, mounts: Floats | None = None
    ) -> Floats:
        """See `Controller.command`; nobody but our own laws reads `mounts`."""
        felt = self._nothing_felt if wrenches is None else wrenches
        for b, law in enumerate(self._laws):
            aim, (q, qd) = aims[b if aims.size > 1 else 0], states[b]
            with blamed("controllers", self._name):
                wanted = law.torques(aim, q.copy(), qd.copy(), felt[b].copy())
            self.torques[b] = self._limited(wanted, qd)
            place = self.chain.place(q)
            self.reports["place"][b] = place
            self.reports["error"][b][:3] = aim["place"] - place
            self.reports["saturated"][b] = np.count_nonzero(self.torques[b] != wanted)
        return self.torques

    def _limited(self, wanted: Any, qd: Floats) -> Floats:
        """Torques within the motors' limits and torque-speed lines, as `drive` limits those of our laws, shape (n,)."""
        try:
            torques = np.asarray(wanted, np.float64)
        except (TypeError, ValueError):
            raise failure("controllers", self._name, f"torques are {wanted!r:.60}; they must be numbers") from None
        if torques.shape != (self.chain.n,) or not np.isfinite(torques).all():
            said = f"torques are {torques.tolist()!r:.60}, of shape {torques.shape}"
            raise failure("controllers", self._name, f"{said}; they must be finite, of shape ({self.chain.n},)")
        limit, speed = self.chain.joints["limit"], self.chain.joints["speed"]
        with np.errstate(invalid="ignore"):
            least = np.where(np.isinf(limit), -np.inf, np.clip(-limit * (1.0 + qd / speed), -limit, limit))
            most = np.where(np.isinf(limit), np.inf, np.clip(limit * (1.0 - qd / speed), -limit, limit))
        out: Floats = np.clip(torques, least, most)
        return out


def controller_of(chain: Chain, settings: LawSettings, *, period: float) -> Controller | OutsideController:
    """The controller of a law, ours or another package's, for one limb.

    Raises:
        LawError: If settings do not fit the chain.
        ExtensionError: If another package's law cannot be made.
    """
    kind = Controller if settings.law in LAWS else OutsideController
    return kind(chain, settings, period=period)
