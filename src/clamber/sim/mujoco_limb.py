"""The limb in MuJoCo as a plant: one limb stepped in place, or a batch on all cores, with its encoders, delay and motor limits."""

from typing import Any

import numpy as np

from ..control.chain import Chain
from ..control.kinematics import FRAME
from ..types import Floats
from .force_sensing import ForceSensing, has_hand
from .limb_electronics import SimulatedLimb
from .limb_flaws import LimbFlaws
from .limb_kernels import look_behind_gears, push_tips
from .limb_model import limb_spec


class MujocoLimb(SimulatedLimb):
    """A batch of equal limbs in MuJoCo, with the sensors and motors of `flaws`. A `Plant`.

    Args:
        chain, flaws, gears, batch: As of any `SimulatedLimb`.
        threads: Of the physics of a batch; 0: all cores.
    """

    def __init__(
        self, chain: Chain, flaws: LimbFlaws, *, gears: Floats | None = None, batch: int = 1, threads: int = 0
    ) -> None:
        import mujoco

        super().__init__(chain, flaws, gears, batch)
        self._step_time = 1.0 / flaws.physics_rate
        self.model: Any = limb_spec(chain, flaws).compile()
        self._step = mujoco.mj_step
        self._data: Any = None
        self._pool: Any = None
        n = chain.n
        if batch == 1:
            self._data = mujoco.MjData(self.model)
            self._qpos, self._qvel, self._ctrl = (
                a[None, :] for a in (self._data.qpos, self._data.qvel, self._data.ctrl)
            )
            pushed, readings = self._data.xfrc_applied[None], self._data.sensordata[None]
        else:
            from mujoco.batch import Batch

            self._pool = Batch(self.model, batch, threads)
            self._qpos, self._qvel, self._ctrl = (self._pool.bind(name) for name in ("qpos", "qvel", "ctrl"))
            pushed = self._pool.bind("xfrc_applied")
            readings = self._pool.bind("sensordata") if self.model.nsensordata else np.zeros((batch, 0))
        stride = 2 if flaws.backlash > 0.0 else 1
        self._motors = slice(0, stride * n, stride)
        self._stride = stride
        self._angles, self._speeds = self._qpos[:, self._motors], self._qvel[:, self._motors]
        self._felt = self._forces = ForceSensing(chain, flaws, readings, self._sensed, self._truth)
        self._hand = pushed[:, self.model.body("hand").id] if has_hand(flaws) else None
        self._given = np.zeros((batch, n))
        # The centre of mass is that of what really moves, payload included
        carried = chain.with_payload(flaws.payload).joints
        last = self.model.body(chain.joint_names[-1]).id
        self._pushed_rows = pushed[:, last]
        self._push_arrays = (np.zeros((n, FRAME)), np.zeros(12), self._pushed_rows, self._truth.wrenches)
        self._push_chain = (carried, chain.root, self._truth.states)

    def reset(self, q: Floats) -> None:
        """See `Plant`."""
        if self._pool is None:
            import mujoco

            mujoco.mj_resetData(self.model, self._data)
        else:
            self._pool.reset()
        self._qpos[:, self._motors] = q
        self._qvel[:] = 0.0
        self._restart()
        if self._initial_conditions is not None and self._stride == 2:
            self._qpos[:, 1 : 2 * self.chain.n : 2] = self._initial_conditions.play
        self._felt.reset()
        self._look()

    def step(self) -> None:
        """See `Plant`. Where a motor's torque depends on its speed, it follows that at every physics step."""
        if self.flaws.push is not None:
            force = self.flaws.push.at((self.tick + 0.5) * self.period)
            if self._hand is None:
                push_tips(*self._push_chain, force, *self._push_arrays)
            else:
                self._hand[:, :2] = force
        steps, done, mean = self.flaws.steps, 0, self._truth.torques
        given = mean
        while done < steps:
            steady = self._electronics.limit(self._speeds, (steps - done) * self._step_time, given, self._ctrl)
            now = steps - done if steady else 1
            self._advance(now)
            done += now
            if done > now:
                mean += (given - mean) * (now / done)
            given = self._given
        self.tick += 1
        self._look()
        self._felt.look()

    def _advance(self, steps: int) -> None:
        if self._pool is None:
            self._step(self.model, self._data, steps)
        else:
            self._pool.step(nstep=steps)

    def _look(self) -> None:
        look_behind_gears(self._qpos, self._qvel, self._stride, self._truth.states)
