"""The closed loop: sense, command, actuate, step, and write down what happened."""

import numpy as np

from ..control.controller import Controller, MeasurementError
from ..control.records import AXES
from ..types import Records
from .plant import Plant
from .trace import LimbTrace


def close_loop(plant: Plant, controller: Controller, aims: Records, *, keep: bool = False) -> LimbTrace:
    """Run `controller` on `plant`, from where it is, through `aims`.

    Args:
        plant: Reset to its start.
        controller: Of the plant's batch and period; its memory is cleared.
        aims: Records of `AIM`, shape (ticks, 1) or (ticks, batch).
        keep: Whether a measurement that is not finite ends the run with the trace so far, NaN after it, in place of an error.

    Raises:
        MeasurementError: If the plant's sensors say something that is not finite, and not `keep`.
    """
    ticks, batch, n = aims.shape[0], controller.batch, controller.chain.n
    trace = LimbTrace(
        chain=controller.chain,
        time=np.arange(ticks, dtype=np.float64) * controller.period,
        aims=aims,
        sensed=np.full((ticks, batch, 2, n), np.nan),
        true=np.full((ticks, batch, 2, n), np.nan),
        commanded=np.full((ticks, batch, n), np.nan),
        applied=np.full((ticks, batch, n), np.nan),
        wrenches=np.full((ticks, batch, AXES), np.nan),
        reports=np.zeros((ticks, batch), controller.reports.dtype),
    )
    controller.reset()
    truth = plant.truth()
    for k in range(ticks):
        sensed = plant.sense()
        try:
            torques = controller.command(aims[k], sensed.states, sensed.wrenches)
        except MeasurementError:
            if keep:
                return trace
            raise
        trace.sensed[k] = sensed.states
        trace.true[k] = truth.states
        trace.commanded[k] = torques
        trace.reports[k] = controller.reports
        plant.actuate(torques)
        plant.step()
        trace.applied[k] = truth.torques
        trace.wrenches[k] = truth.wrenches
    return trace
