"""The closed loop: sense, command, actuate, step, and write down what happened."""

import numpy as np

from ..control.controller import Controller
from ..control.records import AXES
from ..types import Records
from .plant import Plant
from .trace import LimbTrace


def close_loop(plant: Plant, controller: Controller, aims: Records) -> LimbTrace:
    """Run `controller` on `plant`, from where it is, through `aims`.

    Args:
        plant: Reset to its start.
        controller: Of the plant's batch and period; its memory is cleared.
        aims: Records of `AIM`, shape (ticks, 1) or (ticks, batch).

    Raises:
        MeasurementError: If the plant's sensors say something that is not finite.
    """
    ticks, batch, n = aims.shape[0], controller.batch, controller.chain.n
    trace = LimbTrace(
        chain=controller.chain,
        time=np.arange(ticks, dtype=np.float64) * controller.period,
        aims=aims,
        sensed=np.empty((ticks, batch, 2, n)),
        true=np.empty((ticks, batch, 2, n)),
        commanded=np.empty((ticks, batch, n)),
        applied=np.empty((ticks, batch, n)),
        wrenches=np.empty((ticks, batch, AXES)),
        reports=np.empty((ticks, batch), controller.reports.dtype),
    )
    controller.reset()
    truth = plant.truth()
    for k in range(ticks):
        sensed = plant.sense()
        torques = controller.command(aims[k], sensed.states, sensed.wrenches)
        trace.sensed[k] = sensed.states
        trace.true[k] = truth.states
        trace.commanded[k] = torques
        trace.reports[k] = controller.reports
        plant.actuate(torques)
        plant.step()
        trace.applied[k] = truth.torques
        trace.wrenches[k] = truth.wrenches
    return trace
