"""What is not ideal about a simulated limb: backlash, friction, encoders, delay, payload, and what pushes it; for every plant."""

import math
from dataclasses import dataclass
from typing import Final

from .plant_rules import (
    MOST_DELAY,
    Flaws,
    PlantError,
    check_finite,
    check_not_negative,
    check_part,
    check_rates,
    check_seed,
)

MOST_COUNTS: Final = 10**9
"""Encoder counts per motor turn; no encoder has as many."""


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
    """Friction coefficient along the surface [-]. While the tip slips with friction, MuJoCo's contact chatters: single ticks without
    contact, some newtons about a right mean."""

    def __post_init__(self) -> None:
        check_finite(self, ("x", "y", "angle"), "wall.")
        if not 0.0 < self.stiffness < math.inf:
            raise PlantError("wall.stiffness", self.stiffness, "must be more than 0 N/m, and finite")
        check_not_negative(self, ("damping", "friction"), "wall.")


@dataclass(frozen=True, slots=True, kw_only=True)
class Push:
    """A force on the tip that grows, holds and goes: none before `start`, (x, y) from `start + rise`, none again after `end` [N], [s]."""

    x: float
    y: float
    start: float
    end: float
    rise: float = 0.05

    def __post_init__(self) -> None:
        check_finite(self, ("x", "y", "start", "end", "rise"), "push.")
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
class ForceSensor:
    """A sensor of force and moment, at the wrist or at the mount, with what is wrong about it."""

    noise: float = 0.0
    """Standard deviation of each force at each reading [N]."""
    moment_noise: float = 0.0
    """That of each moment [N m]."""
    bias: float = 0.0
    """Added to each force [N]."""
    time_constant: float = 0.0
    """Of the low-pass filter that its readings go through [s]."""
    seed: int = 0
    """Of the noise."""

    def __post_init__(self) -> None:
        check_not_negative(self, ("noise", "moment_noise", "time_constant"), "sensor.")
        check_finite(self, ("bias",), "sensor.")
        if self.seed < 0:
            raise PlantError("sensor.seed", self.seed, "must be a whole number, 0 or more")


@dataclass(frozen=True, slots=True, kw_only=True)
class LimbFlaws(Flaws):
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
    joint_limits: bool = False
    """Whether hard stops at the robot's joint limits hold the motors' side. Off by default: the published circle of 5 cm about (0.22, 0)
    asks for an elbow of 115.6 deg, or -111.9 deg on the other branch, beyond the printed 110 deg."""
    seed: int | None = None
    """Draws each joint's side of its play at the start, its encoder's phase, noise and model error; None: mid-play, no noise."""
    speed_noise: float = 0.0
    """Standard deviation of the noise on sensed joint speeds [rad/s]."""
    wrench_noise: float = 0.0
    """Standard deviation of the noise on sensed forces, where the limb has a force sensor of no other noise [N]."""
    model_error: float = 0.0
    """Largest relative error of what the controller believes of each joint's inertia, damping, friction and mass [-]."""
    push: Push | None = None
    wall: Wall | None = None
    wrist: ForceSensor | None = None
    """Senses what the tip does to its surroundings; its frame turns with the tip, by the encoders."""
    base: ForceSensor | None = None
    """Senses what the limb does to its mount (Bevly 1997, 3.3.3; Morel and Dubowsky 1996)."""

    def __post_init__(self) -> None:
        sizes = ("backlash", "friction", "damping", "payload", "speed_noise", "wrench_noise", "model_error")
        check_not_negative(self, sizes)
        check_part("model_error", self.model_error)
        chancy = ("speed_noise", "wrench_noise", "model_error")
        check_seed(self.seed, {key: getattr(self, key) for key in chancy})
        for key, most in (("encoder_counts", MOST_COUNTS), ("delay", MOST_DELAY)):
            if not isinstance(getattr(self, key), int) or not 0 <= getattr(self, key) <= most:
                raise PlantError(key, getattr(self, key), f"must be a whole number, 0 to {most}")
        check_rates(self.control_rate, self.physics_rate)
