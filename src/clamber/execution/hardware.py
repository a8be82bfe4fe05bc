"""A robot as its wires have it, volts in and counts out, and what makes a plant of it that takes torques and tells angles."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from ..types import Floats, Ints
from .plant import BodySensed, BodyTruth, PausingPlant
from .wiring import Wiring


@dataclass(frozen=True, slots=True, eq=False)
class Reading:
    """What the encoders say at a tick."""

    counts: Ints
    """Of the encoders, then the switches of the grippers, shape (n_readings,)."""
    tick: int
    """Number of the tick since the reset; ticks that nobody read are skipped."""


class Hardware(PausingPlant[Reading, Floats], Protocol):
    """A driver, a simulation of one, or the way to one in another process.

    `truth` is flat, as the kind of robot has it, and empty where nobody knows it. Without power a gearbox does not hold a robot up: whoever
    drives one keeps commanding, every period.
    """

    def reset(self, start: Floats) -> None:
        """Put the robot at rest at its start, flat: joint angles, of a climber after the body's pose.

        A real robot has been put there by hand, and its counters are set.
        """

    def actuate(self, commands: Floats) -> None:
        """Set volts of the joints, then switches of the grippers, held until the next call, shape (n_commands,) [V]."""


class Decoder:
    """Angles and speeds from readings, the speeds by difference."""

    def __init__(self, wiring: Wiring, period: float) -> None:
        self._wiring, self._period = wiring, period
        self._angles, self._tick = np.zeros(wiring.n_encoders), -1

    def reset(self) -> None:
        """Forget the reading before."""
        self._tick = -1

    def decode(self, reading: Reading) -> tuple[Floats, Floats]:
        """Angles [rad] and speeds [rad/s], each of shape (n_encoders,); no speeds at the first reading, nor at one read before."""
        angles = self._wiring.angles(reading.counts)
        ticks = reading.tick - self._tick
        speeds = np.zeros_like(angles)
        if self._tick >= 0 and ticks > 0:
            speeds = (angles - self._angles) / (ticks * self._period)
        self._angles, self._tick = angles, reading.tick
        return angles, speeds


class WiredClimber:
    """A climber driven through its wires. A `BodyPlant`.

    Args:
        hardware: Its encoders are the joints', limb by limb, then the body's.
        wiring: Of the robot.
    """

    def __init__(self, hardware: Hardware, wiring: Wiring) -> None:
        self.hardware, self.wiring, self.period = hardware, wiring, hardware.period
        self._decoder = Decoder(wiring, hardware.period)
        self._switches = list(wiring.grippers)
        self._gripped = np.zeros(wiring.n_joints // 2, np.int32)

    def reset(self, pose: Floats, q: Floats) -> None:
        """See `BodyPlant`."""
        self._decoder.reset()
        self.hardware.reset(np.concatenate((pose, np.ravel(q))))

    def sense(self) -> BodySensed:
        """See `BodyPlant`."""
        reading = self.hardware.sense()
        angles, speeds = self._decoder.decode(reading)
        self._gripped[self._switches] = reading.counts[self.wiring.n_encoders :]
        return BodySensed(
            angles[:-1].reshape(-1, 2),
            speeds[:-1].reshape(-1, 2),
            float(angles[-1]),
            float(speeds[-1]),
            self._gripped,
            reading.tick,
        )

    def actuate(self, torques: Floats, grips: Ints) -> None:
        """See `BodyPlant`."""
        self.hardware.actuate(np.append(self.wiring.volts(np.ravel(torques)), grips[self._switches]))

    def pause(self) -> None:
        """See `BodyPlant`."""
        self.hardware.pause()

    def step(self) -> None:
        """See `BodyPlant`."""
        self.hardware.step()

    def truth(self) -> BodyTruth | None:
        """See `BodyPlant`."""
        flat = self.hardware.truth()
        return body_truth(flat) if len(flat) else None


def flat_body_truth(truth: BodyTruth) -> Floats:
    """Pose, joint angles, tips, torques, one after the other, shape (3 + 6 limbs,)."""
    return np.concatenate((truth.pose, truth.q.ravel(), truth.tips.ravel(), truth.torques.ravel()))


def body_truth(flat: Floats) -> BodyTruth:
    """What `flat_body_truth` made flat."""
    q, tips, torques = flat[3:].reshape(3, -1, 2)
    return BodyTruth(flat[:3], q, tips, torques)
