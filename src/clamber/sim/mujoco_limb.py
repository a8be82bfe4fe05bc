"""The limb in MuJoCo as a plant: one limb stepped in place, or a batch on all cores, with its encoders, delay and motor limits."""

from typing import Any

import numpy as np

from ..control.chain import Chain
from ..control.records import AXES
from ..execution.plant import Sensed, Truth
from ..types import Floats
from .chances import Chances
from .electronics import limit_torques, read_encoders
from .limb_flaws import LimbFlaws
from .limb_model import limb_spec


class MujocoLimb:
    """A batch of equal limbs in MuJoCo, with the sensors and motors of `flaws`. A `Plant`.

    Args:
        chain: The limb as it is.
        flaws: What is not ideal about it.
        gears: Motor turns per joint turn, shape (n,): encoder counts are of the motor.
        batch: Number of limbs.
        threads: Of the physics of a batch; 0: all cores.
    """

    def __init__(
        self, chain: Chain, flaws: LimbFlaws, *, gears: Floats | None = None, batch: int = 1, threads: int = 0
    ) -> None:
        import mujoco

        self.chain, self.flaws, self.batch = chain, flaws, batch
        self.period = flaws.period
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
            self._pushed = self._data.xfrc_applied[None]
        else:
            from mujoco.batch import Batch

            self._pool = Batch(self.model, batch, threads)
            self._qpos, self._qvel, self._ctrl = (self._pool.bind(name) for name in ("qpos", "qvel", "ctrl"))
            self._pushed = self._pool.bind("xfrc_applied")
        stride = 2 if flaws.backlash > 0.0 else 1
        self._motors = slice(0, stride * n, stride)
        self._play = slice(1, stride * n, stride) if stride == 2 else None
        self._angles, self._speeds = self._qpos[:, self._motors], self._qvel[:, self._motors]
        turns = np.ones(n) if gears is None else np.asarray(gears, dtype=np.float64)
        self._counts = flaws.encoder_counts * turns / (2.0 * np.pi)
        unlimited = np.full(n, np.inf)
        self._limits = chain.joints["limit"].copy() if flaws.motor_limits else unlimited
        self._no_load = chain.joints["speed"].copy() if flaws.motor_limits else unlimited
        self._chances = None if flaws.seed is None else Chances(flaws, batch, n, self._counts)
        self._ring = np.zeros((flaws.delay + 1, batch, 2, n))
        self._before = np.zeros((batch, n))
        self._wanted = np.zeros((batch, n))
        self._sensed = Sensed(np.zeros((batch, 2, n)), np.zeros((batch, AXES)))
        self._truth = Truth(np.zeros((batch, 2, n)), np.zeros((batch, n)), np.zeros((batch, AXES)))
        self._last_body = self.model.body(chain.joint_names[-1]).id
        self.tick = 0

    def reset(self, q: Floats) -> None:
        """See `Plant`."""
        if self._pool is None:
            import mujoco

            mujoco.mj_resetData(self.model, self._data)
        else:
            self._pool.reset()
        self._qpos[:, self._motors] = q
        self._qvel[:] = 0.0
        if self._chances is not None:
            self._chances.restart()
            if self._play is not None:
                self._qpos[:, self._play] = self._chances.play
        self._wanted[:] = 0.0
        self._ring[:] = 0.0
        self.tick = 0
        self._look()

    def sense(self) -> Sensed:
        """See `Plant`."""
        chances = self._chances
        read_encoders(
            self._angles if chances is None else self._angles + chances.phase,
            self._speeds,
            self._counts,
            self.period,
            self.tick,
            self._ring,
            self._before,
            self._sensed.states,
        )
        if chances is not None:
            self._sensed.wrenches[:] = 0.0  # no sensor of force; only noise would be felt
            chances.disturb(self._sensed.states, self._sensed.wrenches)
        return self._sensed

    def actuate(self, torques: Floats) -> None:
        """See `Plant`."""
        self._wanted[:] = torques

    def step(self) -> None:
        """See `Plant`. Where a motor's limit is near, the torque follows the speed at every physics step."""
        steps = self.flaws.steps
        if self.flaws.push is not None:
            self._push()
        near = limit_torques(self._wanted, self._speeds, self._limits, self._no_load, self._truth.torques)
        self._ctrl[:] = self._truth.torques
        if near:
            for k in range(steps):
                if k:
                    limit_torques(self._wanted, self._speeds, self._limits, self._no_load, self._truth.torques)
                    self._ctrl[:] = self._truth.torques
                self._advance(1)
        else:
            self._advance(steps)
        self.tick += 1
        self._look()

    def truth(self) -> Truth:
        """See `Plant`."""
        return self._truth

    def _advance(self, steps: int) -> None:
        if self._pool is None:
            self._step(self.model, self._data, steps)
        else:
            self._pool.step(nstep=steps)

    def _look(self) -> None:
        states = self._truth.states
        states[:, 0] = self._angles
        states[:, 1] = self._speeds
        if self._play is not None:
            states[:, 0] += self._qpos[:, self._play]
            states[:, 1] += self._qvel[:, self._play]

    def _push(self) -> None:
        """Put the push of this tick on the tip, as a force and its moment about the last link's centre of mass."""
        push = self.flaws.push
        assert push is not None
        fx, fy = push.at((self.tick + 0.5) * self.period)
        for b in range(self.batch):
            arm = self.chain.place(self._truth.states[b, 0]) - self._centre(b)
            self._pushed[b, self._last_body] = (fx, fy, 0.0, 0.0, 0.0, arm[0] * fy - arm[1] * fx)
            self._truth.wrenches[b, :2] = -fx, -fy

    def _centre(self, b: int) -> Floats:
        return self.chain.last_centre(self._truth.states[b, 0])
