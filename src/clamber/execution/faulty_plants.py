"""Plants with a fault: one layer over any plant of its kind, simulated or wired, that the controller cannot tell from a plant."""

from typing import Protocol

import numpy as np

from ..types import Floats, Ints
from .fault import Fault, Injector
from .plant import BodyPlant, BodySensed, BodyTruth, PlantLayer
from .posture_guard import JointHold


class Weakened(Protocol):
    """A plant whose holds may have another strength than its board states."""

    def weaken(self, hold: int, strength: float) -> None:
        """Give a hold another strength [N], until the next reset."""


class Stepping(Protocol):
    """A plant of any kind."""

    def sense(self) -> object:
        """Read the sensors."""

    def step(self) -> None:
        """Let one control period pass."""


def step_on(plant: Stepping, periods: int) -> None:
    """Let periods pass; a plant reads its sensors in each of them, whoever looks."""
    for k in range(periods):
        if k:
            plant.sense()
        plant.step()


class OwnHold:
    """What a robot does by itself that has had no command for a while: it holds the posture that it has then.

    Args:
        inertias: Of each joint with its motor and gear, shape (joints,) [kg m^2].
    """

    def __init__(self, inertias: Floats) -> None:
        self._law = JointHold(inertias)
        self._posture: Floats | None = None

    def reset(self) -> None:
        """Forget the posture."""
        self._posture = None

    def torques(self, fed: Floats, q: Floats, qd: Floats) -> Floats:
        """Of a tick without commands, shape (joints,) [N m]; `fed`: the last ones that came."""
        if self._posture is None:
            self._posture = q.copy()
        return self._law.torques(self._posture, fed, q, qd)


class FaultyBody(PlantLayer[BodyPlant, BodyTruth | None]):
    """A climber with a fault; a `BodyPlant`.

    Args:
        plant: What moves; for a weak hold, one that can `weaken` it.
        fault: Channels are the joints' encoders, limb by limb, then the body's; motors are the joints'.
        inertias: Of each joint with its motor and gear, shape (joints,) [kg m^2]: a robot without commands holds its posture.
    """

    def __init__(self, plant: BodyPlant, fault: Fault, inertias: Floats) -> None:
        super().__init__(plant)
        self._injector, self._own = Injector(fault, plant.period), OwnHold(inertias)
        self._sensed: BodySensed | None = None
        self._torques, self._grips = np.zeros(len(inertias)), np.zeros(len(inertias) // 2, np.int32)
        self._weakened = False

    def reset(self, pose: Floats, q: Floats) -> None:
        """See `BodyPlant`."""
        self.plant.reset(pose, q)
        self._injector.reset()
        self._own.reset()
        self._torques[:], self._weakened = 0.0, False

    def sense(self) -> BodySensed:
        """See `BodyPlant`."""
        sensed, injector, at = self.plant.sense(), self._injector, self._injector.fault.channel
        self._sensed = sensed
        values = np.append(sensed.q.ravel(), sensed.angle)
        speeds = np.append(sensed.qd.ravel(), sensed.angle_speed)
        n = len(values)
        if injector.fault.target == "sensor":
            values, _ = injector.read(values, sensed.number)
            speeds[at] = injector.speed(float(values[at]), float(speeds[at]))
            number = sensed.number
        else:
            packet, number = injector.read(np.concatenate((values, speeds)), sensed.number)
            values, speeds = packet[:n], packet[n:]
        return BodySensed(
            values[:-1].reshape(-1, 2),
            speeds[:-1].reshape(-1, 2),
            float(values[-1]),
            float(speeds[-1]),
            sensed.gripped,
            number,
        )

    def actuate(self, torques: Floats, grips: Ints) -> None:
        """See `BodyPlant`."""
        n = len(self._torques)
        arrived = self._injector.command(np.concatenate((np.ravel(torques), grips)))
        if arrived is not None:
            self._torques[:], self._grips[:] = arrived[:n], arrived[n:] > 0.5

    def step(self) -> None:
        """See `BodyPlant`."""
        injector = self._injector
        fault = injector.fault
        if fault.target == "hold" and injector.on and not self._weakened:
            weakened: Weakened = self.plant  # type: ignore[assignment]
            weakened.weaken(fault.channel, fault.size)
            self._weakened = True
        torques = self._torques
        if injector.silent and self._sensed is not None:
            torques = self._own.torques(torques, self._sensed.q.ravel(), self._sensed.qd.ravel())
        driven = injector.weaken(torques.copy(), np.zeros(len(torques)))
        self.plant.actuate(driven.reshape(-1, 2), self._grips)
        step_on(self.plant, injector.passed())
