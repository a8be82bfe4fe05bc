"""What the commands of `body` print."""

from .base import Printed
from .meanings import means_as


@means_as("experiments/climb/body_measures.py:BodyMeasures")
class BodyErrors(Printed):
    """Of the measured part, by the truth."""

    radial_rms: float | None
    behind_rms: float | None
    x_max: float | None
    y_max: float | None
    turn_max: float | None
    rest: float | None
    off_max: float | None
    unhooked_at: float | None


class BodyControl(BodyErrors):
    """One control of the body."""

    control: str
    kp: list[float]
    """Along x, y [N/m] and turning [N m/rad]."""
    kd: list[float]
    limit: str
    """Of the hooks' pulls."""
    alpha: float
    """Least acceleration of a hook along its grab direction, for the limits that know one [m/s^2]."""


class Bodies(Printed):
    """Controls compared on a body that limbs hold; exit code 1 where a hook came off."""

    kind: str
    controls: list[BodyControl]


class PushTrial(BodyErrors):
    """One push."""

    seed: int
    side: int
    """1 towards +x, -1 towards -x."""
