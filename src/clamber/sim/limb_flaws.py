"""What is not ideal about a simulated limb: backlash, friction, encoders, delay, payload, and what pushes it; for every plant."""

import math
from dataclasses import dataclass, fields, replace
from typing import Any

from ..errors import ClamberError, describe_choices


class PlantError(ClamberError):
    """A property of a plant that cannot be: names the key, the value and what is allowed."""

    def __init__(self, key: str, value: object, allowed: str) -> None:
        super().__init__(key, value, allowed)
        self.key, self.value, self.allowed = key, value, allowed

    def __str__(self) -> str:
        return f"plant: {self.key} = {self.value}: {self.allowed}"


@dataclass(frozen=True, slots=True, kw_only=True)
class Wall:
    """A flat elastic wall that the tip can press against, in the base frame."""

    x: float
    """A point of the untouched surface [m]."""
    y: float
    angle: float
    """Direction into the wall, from the x axis [rad]."""
    stiffness: float = 10_000.0
    """Along that direction [N/m]."""
    damping: float = 20.0
    """Along that direction [N s/m]."""
    friction: float = 0.0
    """Friction coefficient along the surface [-]."""

    def __post_init__(self) -> None:
        for key in ("x", "y", "angle"):
            if not math.isfinite(getattr(self, key)):
                raise PlantError(f"wall.{key}", getattr(self, key), "must be a finite number")
        if not 0.0 < self.stiffness < math.inf:
            raise PlantError("wall.stiffness", self.stiffness, "must be more than 0 N/m, and finite")
        for key in ("damping", "friction"):
            if not 0.0 <= getattr(self, key) < math.inf:
                raise PlantError(f"wall.{key}", getattr(self, key), "must be 0 or more, and finite")


@dataclass(frozen=True, slots=True, kw_only=True)
class Push:
    """A force on the tip that grows, holds and goes: none before `start`, (x, y) from `start + rise`, none again after `end` [N], [s]."""

    x: float
    y: float
    start: float
    end: float
    rise: float = 0.05

    def __post_init__(self) -> None:
        if not self.start >= 0.0 or not self.end >= self.start:
            raise PlantError("push", (self.start, self.end), "must start at 0 s or later and end after its start")
        if not self.rise >= 0.0:
            raise PlantError("push.rise", self.rise, "must be 0 s or more")

    def at(self, time: float) -> tuple[float, float]:
        """The force at a time [N]."""
        if not self.start < time < self.end + self.rise:
            return 0.0, 0.0
        part = 1.0
        if self.rise > 0.0:
            part = min(1.0, (time - self.start) / self.rise, (self.end + self.rise - time) / self.rise)
        return part * self.x, part * self.y


@dataclass(frozen=True, slots=True, kw_only=True)
class LimbFlaws:
    """What makes a plant differ from the robot's file, and its sensors from the truth. The defaults are an ideal limb with friction."""

    backlash: float = 0.0
    """Whole play at each joint's output [rad]; the encoder is on the motor's side."""
    friction: float = 1.0
    """Coulomb friction over that of the robot's file [-]."""
    damping: float = 1.0
    """Viscous friction over that of the robot's file [-]."""
    payload: float = 0.0
    """Mass at the tip that the controller does not know of [kg]."""
    encoder_counts: int = 0
    """Counts per motor turn; 0: a perfect encoder that also tells the speed."""
    delay: int = 0
    """Control periods between a measurement and its use."""
    control_rate: float = 200.0
    """Control cycles per second [Hz]; torques are held between them."""
    physics_rate: float = 2000.0
    """Steps of the simulation per second [Hz]; a whole multiple of the control rate."""
    upright: bool = False
    """Whether weight acts."""
    motor_limits: bool = True
    """Whether the motors have their torque limits and torque-speed lines."""
    seed: int | None = None
    """Draws each joint's side of its play at the start, its encoder's phase, noise and model error; None: mid-play, no noise."""
    speed_noise: float = 0.0
    """Standard deviation of the noise on sensed joint speeds [rad/s]."""
    wrench_noise: float = 0.0
    """Standard deviation of the noise on sensed forces [N]."""
    model_error: float = 0.0
    """Largest relative error of what the controller believes of each joint's inertia, damping, friction and mass [-]."""
    push: Push | None = None
    wall: Wall | None = None

    def __post_init__(self) -> None:
        for key in ("backlash", "friction", "damping", "payload", "speed_noise", "wrench_noise", "model_error"):
            if not 0.0 <= getattr(self, key) < math.inf:
                raise PlantError(key, getattr(self, key), "must be 0 or more, and finite")
        if not self.model_error < 1.0:
            raise PlantError("model_error", self.model_error, "must be less than 1, that is 100 %")
        if self.seed is not None and self.seed < 0:
            raise PlantError("seed", self.seed, "must be a whole number, 0 or more")
        for key in ("speed_noise", "wrench_noise", "model_error"):
            if self.seed is None and getattr(self, key) > 0.0:
                raise PlantError(key, getattr(self, key), "needs a seed")
        if self.encoder_counts < 0 or self.delay < 0:
            key = "delay" if self.delay < 0 else "encoder_counts"
            raise PlantError(key, getattr(self, key), "must be a whole number, 0 or more")
        for key in ("control_rate", "physics_rate"):
            if not 0.0 < getattr(self, key) < math.inf:
                raise PlantError(key, getattr(self, key), "must be more than 0 Hz, and finite")
        steps = self.physics_rate / self.control_rate
        if abs(steps - round(steps)) > 1e-9 * steps or round(steps) < 1:
            raise PlantError(
                "control_rate",
                f"{self.control_rate:g} Hz",
                f"must divide the physics rate of {self.physics_rate:g} Hz into whole steps; state plant.physics_rate too",
            )

    @property
    def period(self) -> float:
        """Of the control [s]."""
        return 1.0 / self.control_rate

    @property
    def steps(self) -> int:
        """Physics steps in a control period."""
        return round(self.physics_rate / self.control_rate)

    def with_changes(self, **changes: Any) -> "LimbFlaws":
        """A copy with some properties changed.

        Raises:
            PlantError: If there is no such property, or its value is not allowed.
        """
        known = tuple(field.name for field in fields(self))
        for key in changes:
            if key not in known:
                raise PlantError(key, changes[key], f"no such property; there are {describe_choices(key, known)}")
        return replace(self, **changes)
