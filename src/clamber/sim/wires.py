"""Simulated plants as hardware has it: amplifiers between volts and torques, counters behind the encoders."""

from typing import Final

import numpy as np

from ..execution.hardware import Reading, flat_body_truth
from ..execution.plant import BodyPlant
from ..execution.wiring import COMMAND_LIMIT, Wiring, within
from ..types import Floats
from .plant_rules import PlantError

MOST_DAC_BITS: Final = 24


class Amplifiers:
    """Converters and current amplifiers of all joints.

    Args:
        wiring: Their gains, and the motors' gears and constants.
        dac_bits: Of the converters before them, which span both limits; 0: as fine as a float.

    Raises:
        PlantError: If there cannot be as many bits.
    """

    def __init__(self, wiring: Wiring, dac_bits: int = 0) -> None:
        if not 0 <= dac_bits <= MOST_DAC_BITS:
            raise PlantError("dac_bits", dac_bits, f"must be 0 to {MOST_DAC_BITS}")
        self._wiring = wiring
        self._step = 2 * COMMAND_LIMIT / 2**dac_bits if dac_bits else 0.0

    def torques(self, volts: Floats) -> Floats:
        """What the motors are driven to, shape (n_joints,) [N m]."""
        if self._step:
            volts = np.rint(within(volts, COMMAND_LIMIT) / self._step) * self._step
        return self._wiring.torques(volts)


class ClimberWires:
    """A simulated climber as `Hardware`: encoders of its joints, limb by limb, and of its body, then its grippers' switches.

    Starts are pose and joint angles.

    Args:
        plant: With encoders that count as `wiring` says.
        wiring: Of the robot.
        dac_bits: See `Amplifiers`.
    """

    def __init__(self, plant: BodyPlant, wiring: Wiring, *, dac_bits: int = 0) -> None:
        self.plant, self.wiring, self.period = plant, wiring, plant.period
        self._amplifiers, self._tick = Amplifiers(wiring, dac_bits), 0
        self._angles = np.zeros(wiring.n_encoders)
        self._switches = list(wiring.grippers)
        self._grips = np.zeros(wiring.n_joints // 2, np.int32)

    def reset(self, start: Floats) -> None:
        """See `Hardware`."""
        self.plant.reset(start[:3], start[3:].reshape(-1, 2))
        self._tick = 0

    def sense(self) -> Reading:
        """See `Hardware`."""
        sensed = self.plant.sense()
        self._angles[:-1], self._angles[-1] = sensed.q.ravel(), sensed.angle
        counts = self.wiring.counts(self._angles)
        return Reading(np.append(counts, sensed.gripped[self._switches]), self._tick)

    def actuate(self, commands: Floats) -> None:
        """See `Hardware`."""
        n = self.wiring.n_joints
        self._grips[self._switches] = commands[n:] > 0.5
        self.plant.actuate(self._amplifiers.torques(commands[:n]).reshape(-1, 2), self._grips)

    def pause(self) -> None:
        """See `Hardware`: nothing to do, as time stands still meanwhile."""

    def step(self) -> None:
        """See `Hardware`."""
        self.plant.step()
        self._tick += 1

    def truth(self) -> Floats:
        """See `Hardware`: pose, joint angles, tips, torques."""
        truth = self.plant.truth()
        return np.zeros(0) if truth is None else flat_body_truth(truth)
