"""Plants with a fault: one layer over any plant of its kind, simulated or wired, that the controller cannot tell from a plant."""

from typing import Protocol

import numpy as np

from ..types import Floats, Ints
from .fault import Fault, Injector
from .hardware import Hardware, Reading
from .plant import BodyPlant, BodySensed, BodyTruth, LimbPlant, PlantLayer, Sensed, Truth
from .posture_guard import JointHold, PostureGuard
from .wiring import LOST_COUNT


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


class FaultyLimb:
    """A limb with a fault; a `LimbPlant` with a batch of one.

    Args:
        plant: What moves.
        fault: Channels are its joints.
        inertias: As in `FaultyBody`.
    """

    batch: int = 1

    def __init__(self, plant: LimbPlant, fault: Fault, inertias: Floats) -> None:
        assert plant.batch == 1
        self.plant, self.period = plant, plant.period
        self._injector, self._own = Injector(fault, plant.period), OwnHold(inertias)
        self._states = np.zeros((2, len(inertias)))
        n = plant.truth().torques.shape[1]
        self._told = Sensed(np.zeros((1, 2, n)), np.zeros((1, 6)), np.zeros((1, 6)))
        self._torques = np.zeros(n)

    def reset(self, q: Floats) -> None:
        """See `LimbPlant`."""
        self.plant.reset(q)
        self._injector.reset()
        self._own.reset()
        self._torques[:] = self._states[:] = 0.0

    def sense(self) -> Sensed:
        """See `LimbPlant`."""
        sensed, injector, told = self.plant.sense(), self._injector, self._told
        told.wrenches[:], told.mounts[:] = sensed.wrenches, sensed.mounts
        states, number, at = sensed.states[0], int(sensed.number[0]), injector.fault.channel
        self._states[:] = states
        if injector.fault.target == "sensor":
            told.states[0], told.number[0] = states, number
            told.states[0, 0], _ = injector.read(states[0], number)
            told.states[0, 1, at] = injector.speed(float(told.states[0, 0, at]), float(states[1, at]))
        else:
            packet, told.number[0] = injector.read(states.ravel(), number)
            told.states[0] = packet.reshape(2, -1)
        return told

    def actuate(self, torques: Floats) -> None:
        """See `LimbPlant`."""
        arrived = self._injector.command(np.ravel(torques))
        if arrived is not None:
            self._torques[:] = arrived

    def step(self) -> None:
        """See `LimbPlant`."""
        torques = self._own.torques(self._torques, *self._states) if self._injector.silent else self._torques
        self.plant.actuate(self._injector.weaken(torques.copy(), np.zeros(len(torques)))[None])
        step_on(self.plant, self._injector.passed())

    def truth(self) -> Truth:
        """See `LimbPlant`."""
        return self.plant.truth()


class FaultyHardware(PlantLayer[Hardware, Floats]):
    """A robot's wires with a fault; `Hardware`. A counter that is to say no number says that it has lost its count.

    Args:
        hardware: What is wired.
        fault: Channels are its encoders; motors are its amplifiers.
        resolution: Counts of each encoder per radian, shape (n_encoders,).
        guard: What holds the posture when no commands come; None: the last ones stay.
    """

    def __init__(self, hardware: Hardware, fault: Fault, resolution: Floats, guard: PostureGuard | None = None) -> None:
        super().__init__(hardware)
        self._resolution, self._injector, self._guard = resolution, Injector(fault, hardware.period), guard
        self._commands: Floats | None = None
        self._reading: Reading | None = None
        self._guards = False

    def reset(self, start: Floats) -> None:
        """See `Hardware`."""
        self.plant.reset(start)
        self._injector.reset()
        self._commands, self._reading, self._guards = None, None, False

    def sense(self) -> Reading:
        """See `Hardware`."""
        reading, n = self.plant.sense(), len(self._resolution)
        self._reading = reading
        values = reading.counts.astype(np.float64)
        values[:n] /= self._resolution
        values, number = self._injector.read(values, reading.tick)
        values[:n] *= self._resolution
        counts = np.where(np.isfinite(values), np.rint(np.nan_to_num(values)), LOST_COUNT).astype(np.int32)
        return Reading(counts, number)

    def actuate(self, commands: Floats) -> None:
        """See `Hardware`."""
        arrived = self._injector.command(commands)
        if arrived is not None:
            self._commands = arrived

    def step(self) -> None:
        """See `Hardware`."""
        commands = self._commands
        if commands is not None and self._injector.silent and self._guard is not None and self._reading is not None:
            if not self._guards:
                self._guard.hold(self._reading, commands)
            self._guards, commands = True, self._guard.commands(self._reading)
        if commands is not None:
            self.plant.actuate(self._injector.weaken(commands.copy(), np.zeros(len(commands))))
        step_on(self.plant, self._injector.passed())
