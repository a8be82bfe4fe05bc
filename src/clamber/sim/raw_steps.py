"""The physics of a closed loop without the loop: the same model, the same steps, the torques written down beforehand."""

from typing import Any

import numpy as np

from ..types import Floats


class RawSteps:
    """`mj_step` of one limb, or of a batch on all cores, as fast as MuJoCo goes from Python.

    Args:
        model: A compiled limb.
        steps: Physics steps in a tick.
        torques: Of the motors, tick by tick, shape (ticks, batch, n) [N m].
        q0: Joint angles at the start, shape (n,) [rad].
    """

    def __init__(self, model: Any, steps: int, torques: Floats, q0: Floats) -> None:
        import mujoco

        self._mujoco, self._model, self._steps, self._torques = mujoco, model, steps, torques
        self._start = np.zeros(model.nq)
        self._start[:: model.nq // len(q0)] = q0
        batch = torques.shape[1]
        self._data: Any = mujoco.MjData(model)
        self._pool: Any = None
        if batch > 1:
            from mujoco.batch import Batch

            self._pool = Batch(model, batch, 0)

    def run(self) -> Floats:
        """Step through all torques from the start; coordinates at the end, shape (batch, nq)."""
        if self._pool is not None:
            return self._run_batch()
        data, model, steps, step = self._data, self._model, self._steps, self._mujoco.mj_step
        self._mujoco.mj_resetData(model, data)
        data.qpos[:] = self._start
        ctrl = data.ctrl
        for torque in self._torques[:, 0]:
            ctrl[:] = torque
            step(model, data, steps)
        out: Floats = data.qpos[None].copy()
        return out

    def _run_batch(self) -> Floats:
        self._pool.reset()
        places, ctrl = self._pool.bind("qpos"), self._pool.bind("ctrl")
        places[:] = self._start
        for torque in self._torques:
            ctrl[:] = torque
            self._pool.step(nstep=self._steps)
        out: Floats = places.copy()
        return out
