"""What the properties of every plant must keep to, and the error that names one that does not."""

import math
from collections.abc import Iterable, Mapping
from dataclasses import fields, replace
from typing import Any, Final, Self

from ..errors import StatedError, describe_choices

MOST_RATE: Final = 1e5
"""Of control and of simulation [Hz]: a second of it takes half a minute then, and no contact here moves faster."""
MOST_DELAY: Final = 10_000
"""Control periods that a measurement may be late: that many are kept."""
MOST_SEED: Final = 2**62
"""Of what is left to chance: kernels draw by 63 bits."""


class PlantError(StatedError):
    """A property of a plant that cannot be: names the key, the value and what is allowed."""

    says = "plant: {key} = {value}: {allowed}"
    key: str
    value: object
    allowed: str


def check_finite(owner: object, names: Iterable[str], prefix: str = "") -> None:
    """Make sure that properties are finite numbers; `prefix` is the owner's own key with a dot, as errors name it."""
    for name in names:
        if not math.isfinite(getattr(owner, name)):
            raise PlantError(f"{prefix}{name}", getattr(owner, name), "must be a finite number")


def check_not_negative(owner: object, names: Iterable[str], prefix: str = "") -> None:
    """Make sure that properties are 0 or more, and finite; `prefix` as for `check_finite`."""
    for name in names:
        if not 0.0 <= getattr(owner, name) < math.inf:
            raise PlantError(f"{prefix}{name}", getattr(owner, name), "must be 0 or more, and finite")


def check_part(name: str, part: float) -> None:
    """Make sure that a relative error leaves something of what it is an error of."""
    if not part < 1.0:
        raise PlantError(name, part, "must be less than 1, that is 100 %")


def check_seed(seed: int | None, chancy: Mapping[str, float]) -> None:
    """Make sure that a seed can be one, and that there is one where anything is left to chance: key -> how much."""
    if seed is not None and not 0 <= seed <= MOST_SEED:
        raise PlantError("seed", seed, "must be a whole number, 0 or more, of 62 bits")
    for key, value in chancy.items():
        if seed is None and value > 0.0:
            raise PlantError(key, value, "needs a seed")


def check_rates(control: float, physics: float) -> None:
    """Make sure that a control period is a whole number of the simulation's steps; both rates in [Hz]."""
    for key, rate in (("control_rate", control), ("physics_rate", physics)):
        if not 0.0 < rate <= MOST_RATE:
            raise PlantError(key, rate, f"must be more than 0 and at most {MOST_RATE:g} Hz")
    steps = physics / control
    if abs(steps - round(steps)) > 1e-9 * steps or round(steps) < 1:
        raise PlantError(
            "control_rate",
            f"{control:g} Hz",
            f"must divide the physics rate of {physics:g} Hz into whole steps; state plant.physics_rate too",
        )


class Flaws:
    """Properties of a plant, a frozen dataclass: what those of every kind of plant have in common."""

    __slots__ = ()
    control_rate: float
    """Ticks per second [Hz]."""
    physics_rate: float
    """Steps of the simulation per second [Hz]; a whole multiple of the control rate."""

    @property
    def period(self) -> float:
        """Of the control [s]."""
        return 1.0 / self.control_rate

    @property
    def steps(self) -> int:
        """Physics steps in a control period."""
        return round(self.physics_rate / self.control_rate)

    def with_changes(self, **changes: Any) -> Self:
        """A copy with some properties changed.

        Raises:
            PlantError: If there is no such property, or its value is not allowed.
        """
        known = tuple(field.name for field in fields(self))  # type: ignore[arg-type]
        for key, value in changes.items():
            if key not in known:
                raise PlantError(key, value, f"no such property; there are {describe_choices(key, known)}")
        return replace(self, **changes)  # type: ignore[type-var]
