"""What the commands of `limb` print that write and read logs."""

from .base import Count, Pair, Printed
from .meanings import means_as


class Recorded(Printed):
    """A log that was written."""

    file: str
    rows: Count
    seconds: float
    columns: list[str]
    notes: dict[str, str]


@means_as("control/identification/estimate.py:Estimate")
class Estimate(Printed):
    """One property of a joint."""

    name: str
    unit: str
    value: float | None
    standard_error: float | None
    interval_95: Pair | None
    method: str
    needs: str | None
    """What the log would have to hold for a value."""
    stated: float | None
    difference: float | None
    """Value over stated, less 1."""


class Rough(Printed):
    """The same by moves with constant torque."""

    inertia: float | None
    damping: float | None
    friction: float | None
    episodes: Count


class Joint(Printed):
    """What a log tells of one joint."""

    joint: str
    rows: Count
    seconds: float
    torque_from: str
    lag: float | None
    """Of the torque behind the angles [s]."""
    residual_torque: float | None
    """Root mean square of what the fit leaves [N m]."""
    estimates: list[Estimate]
    constant_torque: Rough


class Identified(Printed):
    """What a log tells of a limb."""

    log: str
    """The file."""
    robot: str | None
    limb: str | None
    joints: list[Joint]
    notes: list[str]
