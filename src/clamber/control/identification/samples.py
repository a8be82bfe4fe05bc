"""What identification is given: the samples of one joint, in SI units, all of equal length."""

from dataclasses import dataclass, replace

import numpy as np

from ...types import Floats


@dataclass(frozen=True, slots=True, eq=False)
class JointSamples:
    """Samples of one joint; what was not measured is None."""

    name: str
    time: Floats
    """Increasing, shape (rows,) [s]."""
    angle: Floats
    """By the encoder, on the motor's side of the gear, at the joint's scale [rad]."""
    torque: Floats | None = None
    """Of the motor at the joint [N m]."""
    current: Floats | None = None
    """Of the motor [A]."""
    command: Floats | None = None
    """Voltage that the amplifier is commanded [V]."""
    output_angle: Floats | None = None
    """By an encoder behind the gear, or measured from outside [rad]."""
    sensed_torque: Floats | None = None
    """By a sensor at the output [N m]."""

    @property
    def period(self) -> float:
        """Median time between samples [s]."""
        return float(np.median(np.diff(self.time)))

    def evened(self) -> "JointSamples":
        """These samples at even times, one median period apart, by straight lines; unchanged where they are even already."""
        period = self.period
        if float(np.max(np.abs(np.diff(self.time) - period))) < 0.01 * period:
            return self
        time = np.arange(self.time[0], self.time[-1], period)

        def at(values: Floats | None) -> Floats | None:
            return None if values is None else np.interp(time, self.time, values)

        return replace(
            self,
            time=time,
            angle=np.interp(time, self.time, self.angle),
            torque=at(self.torque),
            current=at(self.current),
            command=at(self.command),
            output_angle=at(self.output_angle),
            sensed_torque=at(self.sensed_torque),
        )
