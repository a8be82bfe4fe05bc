"""A walker's plant with a fault."""

from dataclasses import replace

import numpy as np

from ....execution.fault import Fault, Injector
from ....execution.faulty_plants import step_on
from ....execution.plant import PlantLayer
from ....types import Floats
from .plant import WalkerPlant, WalkerSensed, WalkerTruth


class FaultyWalker(PlantLayer[WalkerPlant, WalkerTruth | None]):
    """A walker with a fault; a `WalkerPlant`. A motor of length that is dead stays where it is; a weak one lags behind its aims.

    Args:
        plant: What moves.
        fault: Channels are lengths of actuators and legs, forces of the legs, inclines, joints of the arm; motors those without forces and
            inclines.
    """

    def __init__(self, plant: WalkerPlant, fault: Fault) -> None:
        super().__init__(plant)
        self._injector = Injector(fault, plant.period)
        self._aims, self._at = np.zeros(0), np.zeros(0)

    def reset(self, pose: Floats, place: Floats, legs: Floats, arm: Floats) -> None:
        """See `WalkerPlant`."""
        self.plant.reset(pose, place, legs, arm)
        self._injector.reset()
        self._aims = self._at = np.zeros(0)

    def sense(self) -> WalkerSensed:
        """See `WalkerPlant`."""
        sensed = self.plant.sense()
        parts = sensed.actuators, sensed.legs.ravel(), sensed.forces.ravel(), sensed.inclines, sensed.arm
        values, number = self._injector.read(np.concatenate(parts), sensed.number)
        if self._at.size == 0:
            self._at = np.concatenate((sensed.actuators, sensed.legs.ravel(), sensed.arm))
        return replace(
            sensed, actuators=values[:3], legs=values[3:9].reshape(2, 3), forces=values[9:15].reshape(2, 3),
            inclines=values[15:17], arm=values[17:], number=number,
        )  # fmt: skip

    def actuate(self, actuators: Floats, legs: Floats, arm: Floats) -> None:
        """See `WalkerPlant`."""
        arrived = self._injector.command(np.concatenate((actuators, np.ravel(legs), arm)))
        if arrived is not None:
            self._aims = arrived

    def step(self) -> None:
        """See `WalkerPlant`."""
        if self._aims.size:
            self._at = self._injector.weaken(self._aims.copy(), self._at)
            self.plant.actuate(self._at[:3], self._at[3:9].reshape(2, 3), self._at[9:])
        step_on(self.plant, self._injector.passed())
