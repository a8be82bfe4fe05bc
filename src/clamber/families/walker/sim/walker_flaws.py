"""What is not ideal about a simulated walker: inclinometers, load cells, friction, masses, payload, and what is left to chance."""

import math
from dataclasses import dataclass, field

from ....sim.plant_rules import Flaws, PlantError, check_not_negative, check_part, check_rates, check_seed


@dataclass(frozen=True, slots=True, kw_only=True)
class Inclinometers:
    """Two inclinometers on the plate, along its axes: pendulums, that is, which feel acceleration as well as weight."""

    noise: float = 0.0
    """Standard deviation of a reading; the filter lets no faster noise through [rad]."""
    offsets: tuple[float, float] = (0.0, 0.0)
    """What each tells too much [rad]."""
    time_constant: float = 0.2
    """Of their filter [s]; 0 for none."""

    def __post_init__(self) -> None:
        check_not_negative(self, ("noise", "time_constant"), "inclinometers.")
        if len(self.offsets) != 2 or not all(map(math.isfinite, self.offsets)):
            raise PlantError("inclinometers.offsets", self.offsets, "must be two finite numbers")


@dataclass(frozen=True, slots=True, kw_only=True)
class WalkerFlaws(Flaws):
    """What makes a simulated walker differ from its file, and its sensors from the truth. The defaults are as the file says."""

    inclinometers: Inclinometers = field(default_factory=Inclinometers)
    force_noise: float = 0.0
    """Standard deviation of each leg's load cell at each reading [N]."""
    friction: float = 1.0
    """Of feet on the ground, over what the ground's file says [-]."""
    mass_error: float = 0.0
    """Every part's mass is drawn evenly from 1 less this to 1 plus this, times what the file says [-]."""
    payload: float = 0.0
    """Mass at the arm's tool point that the controller does not know of [kg]."""
    control_rate: float = 50.0
    """Ticks per second [Hz]."""
    physics_rate: float = 500.0
    """Steps of the simulation per second [Hz]; a whole multiple of the control rate."""
    seed: int | None = None
    """Draws noise and masses; None: neither."""

    def __post_init__(self) -> None:
        check_not_negative(self, ("force_noise", "mass_error", "payload"))
        check_part("mass_error", self.mass_error)
        if not 0.0 < self.friction < math.inf:
            raise PlantError("friction", self.friction, "must be more than 0, and finite")
        chancy = {"inclinometers.noise": self.inclinometers.noise, "force_noise": self.force_noise}
        check_seed(self.seed, chancy | {"mass_error": self.mass_error})
        check_rates(self.control_rate, self.physics_rate)
