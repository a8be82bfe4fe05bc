"""The forces on a limb in MuJoCo: what they truly are, and what sensors at the wrist and at the mount say of them."""

from typing import Any

import numpy as np

from ..control.chain import Chain
from ..control.kinematics import FRAME
from ..control.records import AXES
from ..execution.plant import Sensed, Truth
from ..types import Floats
from .limb_flaws import ForceSensor, LimbFlaws
from .limb_kernels import turn_wrenches


class WrenchReader:
    """One kind of force sensor on a batch of limbs, read once a control period, in the sensor's own frame.

    Args:
        sensor: What is wrong about it.
        period: Of the control [s].
        delay: Control periods between a reading and its use.
        batch: Number of limbs.
    """

    def __init__(self, sensor: ForceSensor, *, period: float, delay: int, batch: int) -> None:
        self._sensor = sensor
        self._spread = np.repeat((sensor.noise, sensor.moment_noise), 3)
        self._offset = np.repeat((sensor.bias, 0.0), 3)
        # Of a first-order lag over one period, exact for a reading that holds still
        self._blend = 1.0 if sensor.time_constant == 0.0 else -np.expm1(-period / sensor.time_constant)
        self._ring = np.zeros((delay + 1, batch, AXES))
        self._filtered = np.zeros((batch, AXES))
        self.reset()

    def reset(self) -> None:
        """Forget all readings, and start the noise anew."""
        self._random = np.random.default_rng(self._sensor.seed)
        self._filtered[:] = 0.0
        self._ring[:] = 0.0

    def read(self, true: Floats, tick: int) -> Floats:
        """The reading that a controller gets at a tick, of the true wrench then, shape (batch, 6) [N], [N m]."""
        raw = true + self._offset
        if self._spread.any():
            raw = raw + self._spread * self._random.standard_normal(raw.shape)
        self._filtered += self._blend * (raw - self._filtered)
        depth = len(self._ring)
        self._ring[tick % depth] = self._filtered
        reading: Floats = self._ring[max(0, tick - depth + 1) % depth]
        return reading


def has_hand(flaws: LimbFlaws) -> bool:
    """Whether the tip is a body of its own, without mass, so that what acts on it can be told."""
    return flaws.wall is not None or flaws.wrist is not None


def add_sensor(mujoco: Any, spec: Any, name: str, body: Any) -> None:
    """Sense force and moment on `body` by what carries it, at the body's origin and in its frame: six numbers."""
    body.add_site(name=name)
    for kind in (mujoco.mjtSensor.mjSENS_FORCE, mujoco.mjtSensor.mjSENS_TORQUE):
        spec.add_sensor(type=kind, objtype=mujoco.mjtObj.mjOBJ_SITE, objname=name)


class ForceSensing:
    """Reads the sensors of a model of `limb_spec`.

    MuJoCo works forces out at the start of a physics step, so all of them are those of one physics step ago.

    Args:
        chain: The limb.
        flaws: Which sensors there are.
        readings: MuJoCo's sensor values, shape (batch, any): those of the mount first, those of the hand last.
        sensed, truth: Where wrenches are written.
    """

    def __init__(self, chain: Chain, flaws: LimbFlaws, readings: Floats, sensed: Sensed, truth: Truth) -> None:
        self._fixed = chain.joints, chain.root
        self._sensed, self._truth = sensed, truth
        # MuJoCo tells what carries a body does to it: at the tip that is what the tip does to its surroundings, at the mount its opposite
        self._on_mount = readings[:, :AXES] if flaws.base is not None else None
        self._by_hand = readings[:, -AXES:] if has_hand(flaws) else None
        self._scratch = np.zeros((chain.n, FRAME)), np.zeros(12)

        def reader(sensor: ForceSensor | None) -> WrenchReader | None:
            if sensor is None:
                return None
            return WrenchReader(sensor, period=flaws.period, delay=flaws.delay, batch=readings.shape[0])

        self._wrist, self._base = reader(flaws.wrist), reader(flaws.base)

    def reset(self) -> None:
        """Forget all readings."""
        for each in (self._wrist, self._base):
            if each is not None:
                each.reset()
        self._sensed.wrenches[:] = 0.0
        self._sensed.mounts[:] = 0.0

    def sense(self, tick: int) -> None:
        """Read the sensors; a wrist's reading is turned by the joint angles that the encoders tell."""
        if self._wrist is not None:
            assert self._by_hand is not None
            local = self._wrist.read(self._by_hand, tick)
            turn_wrenches(*self._fixed, self._sensed.states, local, *self._scratch, self._sensed.wrenches)
        if self._base is not None:
            assert self._on_mount is not None
            self._sensed.mounts[:] = self._base.read(-self._on_mount, tick)

    def look(self) -> None:
        """Write the true wrench of the tip on what it touches or is pushed by, where the tip is a body."""
        if self._by_hand is not None:
            turn_wrenches(*self._fixed, self._truth.states, self._by_hand, *self._scratch, self._truth.wrenches)
