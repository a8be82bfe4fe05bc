"""The closed loop: sense, command, actuate, step, and write down what happened."""

from collections.abc import Sequence
from typing import TypeAlias

import numpy as np

from ..compiled import ready
from ..control.chain import Chain
from ..control.controller import MeasurementError
from ..control.outside_law import LoopController
from ..types import Floats, Records
from .copy_rows import BASE, SIZE, SOURCE, copy_rows
from .plant import LimbPlant, Sensed
from .posture_guard import JointHold
from .reading_monitor import Channel, ReadingMonitor
from .run_report import FaultError
from .trace import LimbTrace, empty_trace

Rows: TypeAlias = Floats | Records


class Recorder:
    """Copies arrays into the rows of others, as bytes.

    Args:
        pairs: An array of rows, shape (ticks, ...), and the array that fills one, shape (...), of the same type; both contiguous.
    """

    def __init__(self, pairs: Sequence[tuple[Rows, Rows]]) -> None:
        self._kept = tuple(pairs)  # the table knows only addresses
        self._table = np.zeros((len(pairs), 3), np.int64)
        for line, (rows, source) in zip(self._table, pairs, strict=True):
            assert rows.dtype == source.dtype and rows.shape[1:] == source.shape
            assert rows.flags.c_contiguous and source.flags.c_contiguous
            line[BASE], line[SOURCE], line[SIZE] = rows.ctypes.data, source.ctypes.data, source.nbytes
        self._copy_rows = ready(copy_rows, self._table, 0)

    def note(self, tick: int) -> None:
        """Write what the arrays hold now into row `tick` of each."""
        assert 0 <= tick < len(self._kept[0][0])
        self._copy_rows(self._table, tick)


class LimbGuard:
    """Believes or bridges the readings of a limb's joints, and holds its posture once one of them, or the link, has failed.

    Args:
        chain: The limb as it is believed to be.
        period: Of the control [s].
    """

    def __init__(self, chain: Chain, period: float) -> None:
        joints = chain.joints
        self.monitor = ReadingMonitor(
            [
                Channel(name=name, fastest=float(joint["speed"]), limit=float(joint["limit"]))
                for name, joint in zip(chain.joint_names, joints, strict=True)
            ],
            period,
        )
        self._chain, self._law = chain, JointHold(joints["rotor"].copy())
        self.states = np.zeros((1, 2, chain.n))
        """As believed, shape (1, 2, n)."""
        self.torques = np.zeros((1, chain.n))
        """That hold the posture, shape (1, n) [N m]."""
        self._held: tuple[Floats, Floats] | None = None
        """Posture that is held, and the torques of its weight there; None before a fault."""

    @property
    def held(self) -> bool:
        """Whether the limb holds its posture, as a fault has ended its run."""
        return self._held is not None

    def reset(self) -> None:
        """Begin anew, as if all were well."""
        self.monitor.reset()
        self._held = None

    def see(self, sensed: Sensed, torques: Floats) -> bool:
        """Take in a tick's readings and the torques before it; whether the limb is to hold its posture by `torques`, for good."""
        monitor = self.monitor
        monitor.values[:], monitor.speeds[:] = sensed.states[0]
        monitor.commands[:] = torques[0]
        try:
            monitor.see(int(sensed.number[0]))
        except FaultError:
            if self._held is None:
                posture = monitor.values.copy()
                self._held = posture, self._chain.bias(posture, np.zeros(self._chain.n))
        self.states[0, 0], self.states[0, 1] = monitor.values, monitor.speeds
        if self._held is None:
            return False
        self.torques[0] = self._law.torques(*self._held, monitor.values, monitor.speeds)
        failed = list(monitor.bad)
        self.torques[0, failed] = self._held[1][failed]
        return True


def close_loop(
    plant: LimbPlant, controller: LoopController, aims: Records, *, keep: bool = False, guard: LimbGuard | None = None
) -> LimbTrace:
    """Run `controller` on `plant`, from where it is, through `aims`.

    Args:
        plant: Reset to its start.
        controller: Of the plant's batch and period; its memory is cleared.
        aims: Records of `AIM`, shape (ticks, 1) or (ticks, batch).
        keep: Whether a measurement that is not finite ends the run with the trace so far, NaN after it, in place of an error.
        guard: Of a batch of one: bridges readings that fail and holds the posture after a fault, which its monitor tells; None: none.

    Raises:
        MeasurementError: If the plant's sensors say something that is not finite, and not `keep`.
    """
    ticks = aims.shape[0]
    trace = empty_trace(controller.chain, aims, controller.period, controller.batch)
    controller.reset()
    if guard is not None:
        assert plant.batch == 1
        guard.reset()
    truth, sensed = plant.truth(), plant.sense()
    before = Recorder(
        (
            (trace.sensed, sensed.states),
            (trace.true, truth.states),
            (trace.commanded, controller.torques),
            (trace.reports, controller.reports),
        )
    )
    after = Recorder(((trace.applied, truth.torques), (trace.wrenches, truth.wrenches)))
    for k in range(ticks):
        if k:
            plant.sense()
        states = sensed.states
        if guard is not None:
            holds = guard.see(sensed, controller.torques)
            states = guard.states
            if holds:
                controller.torques[:] = guard.torques
                if guard.monitor.linked:  # else it is to hold by itself
                    plant.actuate(controller.torques)
                before.note(k)
                plant.step()
                after.note(k)
                continue
        try:
            torques = controller.command(aims[k], states, sensed.wrenches, sensed.mounts)
        except MeasurementError:
            if keep:
                return trace
            raise
        plant.actuate(torques)
        before.note(k)
        plant.step()
        after.note(k)
    return trace
