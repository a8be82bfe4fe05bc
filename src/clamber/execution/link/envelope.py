"""Limits of a robot that its server keeps by itself, whatever a client commands: voltage, joint range, speed, heat of the motors."""

from dataclasses import dataclass
from typing import Final

import numpy as np

from ...types import Floats
from ..hardware import Decoder, Reading
from ..wiring import Wiring
from .messages import Kind, MessageError

RANGE_MARGIN: Final = np.radians(5.0)
"""Beyond a joint's range [rad]: plans may use the range to its end, and play, sag and the control's error come on top."""
SPEED_MARGIN: Final = 1.5
"""Times the speed without load [-]: a motor that its load drives turns faster than it could by itself."""
TICKS: Final = 3
"""For which a reading must be beyond a limit: one that is wrong for a single tick makes two wrong speeds."""
ROUNDING: Final = 1.0 + 1e-9
"""Factor on the largest command."""


@dataclass(frozen=True, slots=True, eq=False)
class JointLimits:
    """What the joints of a robot may do, each array of shape (n_joints,)."""

    names: tuple[str, ...]
    lower: Floats
    """Smallest angles [rad]."""
    upper: Floats
    """Largest angles [rad]."""
    speeds: Floats
    """Largest speeds, without load [rad/s]."""
    continuous: Floats
    """Torques that the motors bear for ever [N m]; infinite where nobody states them."""
    thermal_time: float = np.inf
    """Time constant of the windings' temperature [s]."""


class Envelope:
    """Watches the commands and readings of a robot.

    A winding heats by the square of its torque: h' = ((torque / continuous torque)^2 - h) / thermal time, with h the rise of its
    temperature as a share of that at the continuous torque; h = 1 is its limit (first-order model, as in motor drives' I^2 t protection).

    Args:
        wiring: Of the robot.
        limits: Of its joints, in the order of the wiring.
        period: Of the control [s].
    """

    def __init__(self, wiring: Wiring, limits: JointLimits, period: float) -> None:
        self._wiring, self._limits, self._period = wiring, limits, period
        self._decoder, self._beyond = Decoder(wiring, period), 0
        self.heat: Floats = np.zeros(wiring.n_joints)
        """Rise of each winding's temperature, as a share of what is allowed, shape (n_joints,) [-]."""

    def reset(self) -> None:
        """Begin anew with a new start; what is hot stays hot."""
        self._decoder.reset()
        self._beyond = 0

    def check(self, commands: Floats) -> None:
        """Make sure that commands are within what the amplifiers and the joints' torques allow, and switches on or off.

        Args:
            commands: Shape (n_commands,) [V].

        Raises:
            MessageError: If they are not.
        """
        n = self._wiring.n_joints
        over = np.abs(commands[:n]) > ROUNDING * self._wiring.most_volts
        if over.any():
            at = int(np.argmax(over))
            most = self._wiring.most_volts[at]
            allowed = f"must be {-most:.4g} to {most:.4g} V ({self._limits.names[at]})"
            raise MessageError(f"number {at + 1} of a {Kind.COMMAND.name}", f"{commands[at]:g}", allowed)
        for at in range(n, len(commands)):
            if commands[at] not in (0.0, 1.0):
                problem = f"number {at + 1} of a {Kind.COMMAND.name}"
                raise MessageError(problem, f"{commands[at]:g}", "must be 0 or 1, as a gripper's switch")

    def warm(self, commands: Floats) -> None:
        """Take a period of commands into account, the client's or the guard's, shape (n_commands,) [V]."""
        torques = self._wiring.torques(commands[: self._wiring.n_joints])
        share = self._period / self._limits.thermal_time
        self.heat += share * ((torques / self._limits.continuous) ** 2 - self.heat)

    def fault(self, reading: Reading) -> str | None:
        """Which limit the robot is beyond, or None; asked once a tick."""
        n, limits = self._wiring.n_joints, self._limits
        angles, speeds = (values[:n] for values in self._decoder.decode(reading))
        found = None
        outside = np.maximum(limits.lower - angles, angles - limits.upper)
        farthest, fastest = int(np.argmax(outside)), int(np.argmax(np.abs(speeds) / limits.speeds))
        if outside[farthest] > RANGE_MARGIN:
            lower, upper, here = np.degrees((limits.lower[farthest], limits.upper[farthest], angles[farthest]))
            found = f"{limits.names[farthest]} is at {here:.4g} deg; its file says {lower:.4g} to {upper:.4g} deg"
        elif abs(speeds[fastest]) > SPEED_MARGIN * limits.speeds[fastest]:
            speed, most = np.degrees((speeds[fastest], limits.speeds[fastest]))
            found = f"{limits.names[fastest]} turns at {speed:.4g} deg/s; its file says at most {most:.4g} deg/s"
        self._beyond = 0 if found is None else self._beyond + 1
        if self._beyond >= TICKS:
            return found
        hottest = int(np.argmax(self.heat))
        if self.heat[hottest] >= 1.0:
            return f"the motor of {limits.names[hottest]} is as hot as its continuous torque may make it"
        return None
