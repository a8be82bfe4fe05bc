"""What is not ideal about a simulated robot in space: gears, motors, sensors, delay, and what of robot and world is not as believed."""

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Final, Self

import numpy as np

from ....errors import UnitError, describe_choices
from ....execution.fault import Fault
from ....sim.plant_rules import Flaws, PlantError, check_not_negative, check_rates, check_seed
from ....types import Floats
from ....units import parse_quantity
from ..robot.robot import SpatialRobot
from ..world.world import World

MOST_DELAY: Final = 1.0
"""Of a reading [s]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SpatialFlaws(Flaws):
    """What makes a plant differ from the robot's file, and its sensors from the truth. The defaults are as its files say."""

    backlash: float = 0.0
    """Whole play at each turning joint's output [rad]; the encoder is on the motor's side."""
    friction: float = 1.0
    """Coulomb friction of each gear over that of the robot's model [-]."""
    encoder_step: float = 0.0
    """Of a turning joint [rad]; 0: a perfect encoder that also tells the speed."""
    delay: float = 0.0
    """Between a measurement and its use [s]; rounded to whole control periods."""
    gyro_noise: float = 0.0
    """Standard deviation of each reading [rad/s]."""
    gyro_bias: float = 0.0
    """Standard deviation of what each axis tells too much during a whole run [rad/s]."""
    accelerometer_noise: float = 0.0
    """Standard deviation of each reading [m/s^2]."""
    accelerometer_bias: float = 0.0
    """Standard deviation of what each axis tells too much during a whole run [m/s^2]."""
    force_noise: float = 0.0
    """Standard deviation of each force of a tip's sensor, as a part of the robot's weight on Earth [-]."""
    miss: float = 0.0
    """Share of attempts to attach that fail, until the end effector is told to let go and tries again [-]."""
    control_rate: float = 400.0
    """Ticks per second [Hz]."""
    physics_rate: float = 1200.0
    """Steps of the simulation per second [Hz]; a whole multiple of the control rate."""
    seed: int | None = None
    """Draws noise, biases, misses and where joints are in their play at the start; None: nothing is left to chance."""

    def __post_init__(self) -> None:
        noise = ("gyro_noise", "gyro_bias", "accelerometer_noise", "accelerometer_bias", "force_noise", "miss")
        check_not_negative(self, ("backlash", "friction", "encoder_step", "delay", *noise))
        for key, most, unit in (("miss", 1.0, ""), ("delay", MOST_DELAY, " s")):
            if not getattr(self, key) <= most:
                raise PlantError(key, getattr(self, key), f"must be at most {most:g}{unit}")
        check_seed(self.seed, {key: getattr(self, key) for key in noise})
        check_rates(self.control_rate, self.physics_rate)

    @property
    def late(self) -> int:
        """Control periods between a measurement and its use."""
        return round(self.delay * self.control_rate)


DIMENSIONS: Final[dict[str, str]] = {
    "backlash": "angle",
    "friction": "ratio",
    "encoder_step": "angle",
    "delay": "time",
    "gyro_noise": "angular speed",
    "gyro_bias": "angular speed",
    "accelerometer_noise": "acceleration",
    "accelerometer_bias": "acceleration",
    "force_noise": "ratio",
    "miss": "ratio",
    "control_rate": "frequency",
    "physics_rate": "frequency",
}
"""Property that a user may state -> its dimension."""


def read_spatial_flaws(texts: Iterable[str], seed: int = 0) -> SpatialFlaws:
    """A plant with the properties of texts such as "backlash=1deg".

    Args:
        texts: All at once, so that rates may depend on each other.
        seed: Of what is left to chance.

    Raises:
        PlantError: If one of them cannot be.
    """
    changes: dict[str, float] = {}
    for text in texts:
        key, equals, said = (part.strip() for part in text.partition("="))
        if key not in DIMENSIONS:
            raise PlantError(key, said, f"no such property; there are {describe_choices(key, tuple(DIMENSIONS))}")
        if not equals or not said:
            raise PlantError(key, said, "needs a value, as in backlash=1deg")
        try:
            changes[key] = parse_quantity(said, DIMENSIONS[key])
        except UnitError as error:
            raise PlantError(key, said, f"{error.problem}; {error.allowed}") from None
    return SpatialFlaws(**changes, seed=seed if changes else None)


@dataclass(frozen=True, slots=True)
class Push:
    """A force on the base, at its centre of mass, for a while."""

    start: float
    """[s]."""
    end: float
    """[s]."""
    force: tuple[float, float, float]
    """World frame [N]."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Deviations:
    """How robot and world truly are, where that is not as believed."""

    places: Floats
    """Of the holds, world frame [m], shape (holds, 3)."""
    normals: Floats
    """Of the holds, shape (holds, 3)."""
    strengths: Floats
    """True strength of each hold's grip over what hold and end effector state [-], shape (holds,)."""
    frictions: Floats
    """The same of friction [-], shape (holds,)."""
    masses: Floats
    """True mass and inertia of each part over what the model states [-], the base first, then limb by limb, shape (1 + n,)."""
    pushes: tuple[Push, ...] = ()
    """One after another."""
    payload: float = 0.0
    """Mass at the base's centre of mass that the controller does not know of [kg]."""
    fault: Fault | None = None
    """What fails in the robot."""

    @classmethod
    def none(cls, robot: SpatialRobot, world: World) -> Self:
        """Everything as believed."""
        holds = len(world.holds)
        return cls(
            places=world.places.copy(),
            normals=world.normals.copy(),
            strengths=np.ones(holds),
            frictions=np.ones(holds),
            masses=np.ones(1 + int(robot.chains.n_joints.sum())),
        )

    def __post_init__(self) -> None:
        if not (math.isfinite(self.payload) and np.isfinite(self.places).all() and (self.masses > 0.0).all()):
            raise PlantError("deviations", self.payload, "must be finite, with masses above 0")
