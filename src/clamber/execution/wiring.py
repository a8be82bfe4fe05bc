"""What lies between a controller's units and those of a robot's wires: counts of encoders are angles, volts of amplifiers are torques."""

from dataclasses import dataclass
from typing import Final

import numpy as np

from ..types import Floats, Ints

BODY_COUNTS: Final = 4000
"""Of the body's own encoder, a turn; nobody prints it, so ours."""
LOST_COUNT: Final = -(2**31)
"""What a counter says that has lost its count."""
COMMAND_LIMIT: Final = 10.0
"""Most volts that an amplifier takes, either way: inferred, as k_t is, from 10 V giving LIBRA's 3000 oz-in at a gear ratio of 574 [V]."""


@dataclass(frozen=True, slots=True, eq=False)
class Wiring:
    """Encoders and amplifiers of a robot. The first `n_joints` encoders are those of its joints, in the order of its actuators."""

    resolution: Floats
    """Counts of each encoder per radian of what it measures, shape (n_encoders,)."""
    torque_per_volt: Floats
    """Of each joint: amplifier gain, times motor constant, times gear, shape (n_joints,) [N m/V]."""
    most_volts: Floats
    """Largest command of each joint, either way: by its torque limit or by its amplifier, shape (n_joints,) [V]."""
    grippers: tuple[int, ...] = ()
    """Indices of the limbs that end in one: each has a switch behind the volts, and one behind the counts."""

    @property
    def n_joints(self) -> int:
        """Actuators."""
        return len(self.torque_per_volt)

    @property
    def n_encoders(self) -> int:
        """Of joints, and of whatever else turns."""
        return len(self.resolution)

    @property
    def n_commands(self) -> int:
        """Volts of joints, then 1 or 0 for each gripper that is to be shut or open."""
        return self.n_joints + len(self.grippers)

    @property
    def n_readings(self) -> int:
        """Counts of encoders, then 1 or 0 for each gripper that is closed about something, or not."""
        return self.n_encoders + len(self.grippers)

    def angles(self, readings: Ints) -> Floats:
        """What the encoders say, of readings of shape (n_readings,) or counts alone: shape (n_encoders,) [rad]; NaN of a lost count."""
        counts = readings[: self.n_encoders]
        angles: Floats = counts / self.resolution
        if counts.min(initial=0) == LOST_COUNT:
            angles[counts == LOST_COUNT] = np.nan
        return angles

    def counts(self, angles: Floats) -> Ints:
        """The nearest counts, shape (n_encoders,)."""
        return np.floor(angles * self.resolution + 0.5).astype(np.int32)

    def volts(self, torques: Floats) -> Floats:
        """Commands that ask for torques, within the limits, shape (n_joints,) [V]."""
        return within(torques / self.torque_per_volt, self.most_volts)

    def torques(self, volts: Floats) -> Floats:
        """What the amplifiers make of commands, before the motors' own limits, shape (n_joints,) [N m]."""
        return within(volts, COMMAND_LIMIT) * self.torque_per_volt


def within(values: Floats, most: Floats | float) -> Floats:
    """Values cut at a limit either way; twice as fast as `numpy.clip` on the few joints of a robot."""
    return np.minimum(np.maximum(values, -most), most)
