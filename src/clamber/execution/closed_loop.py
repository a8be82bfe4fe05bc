"""The closed loop: sense, command, actuate, step, and write down what happened."""

import numpy as np

from ..control.controller import Controller
from ..control.records import AXES
from ..types import Records
from .plant import Plant
from .recorder import Recorder
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
        plant.actuate(controller.command(aims[k], sensed.states, sensed.wrenches))
        before.note(k)
        plant.step()
        after.note(k)
    return trace
