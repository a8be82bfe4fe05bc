"""The closed loop: sense, command, actuate, step, and write down what happened."""

from ..control.controller import MeasurementError
from ..control.outside_law import LoopController
from ..types import Records
from .plant import LimbPlant
from .recorder import Recorder
from .trace import LimbTrace, empty_trace


def close_loop(plant: LimbPlant, controller: LoopController, aims: Records, *, keep: bool = False) -> LimbTrace:
    """Run `controller` on `plant`, from where it is, through `aims`.

    Args:
        plant: Reset to its start.
        controller: Of the plant's batch and period; its memory is cleared.
        aims: Records of `AIM`, shape (ticks, 1) or (ticks, batch).
        keep: Whether a measurement that is not finite ends the run with the trace so far, NaN after it, in place of an error.

    Raises:
        MeasurementError: If the plant's sensors say something that is not finite, and not `keep`.
    """
    ticks = aims.shape[0]
    trace = empty_trace(controller.chain, aims, controller.period, controller.batch)
    controller.reset()
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
        try:
            torques = controller.command(aims[k], sensed.states, sensed.wrenches, sensed.mounts)
        except MeasurementError:
            if keep:
                return trace
            raise
        plant.actuate(torques)
        before.note(k)
        plant.step()
        after.note(k)
    return trace
