"""Logs to identify a limb's joints from: constant torques both ways, sines about an offset, slow reversals, a stall.

Each joint is driven by itself, as in 3.4.2 of Bevly 1997, while the others are held. Torques between these phases come from a servo on
the joint's angle, so that each phase starts where it has room, whatever the friction is: the torque that starts the joint is found first.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from ..errors import ClamberError
from ..execution.log import Log
from ..sim.limb_flaws import LimbFlaws
from ..sim.mujoco_limb import MujocoLimb
from ..types import Floats, Json
from .bench_limb import BenchLimb
from .excitation_phases import Drive, Phase, phases_of

SERVO_STIFFNESS: Final = 40.0
"""Of the servo that holds and returns joints, per inertia [1/s^2]; it is critically damped."""
MOST_SECONDS: Final = 900.0


class ExcitationError(ClamberError):
    """An excitation that cannot be: names the key, the value and what is allowed."""

    def __init__(self, key: str, value: object, allowed: str) -> None:
        super().__init__(key, value, allowed)
        self.key, self.value, self.allowed = key, value, allowed

    def __str__(self) -> str:
        return f"excitation: {self.key} = {self.value}: {self.allowed}"


@dataclass(frozen=True, slots=True, kw_only=True)
class SensorNoise:
    """Noise of the log's sensors, standard deviations of normal distributions."""

    angle: float = 0.0
    """Of the encoders, besides their steps [rad]."""
    current: float = 0.01
    """Of the current sensors [A]."""
    output_angle: float = 3e-4
    """Of the sensors behind the gears [rad]."""
    seed: int = 0

    def __post_init__(self) -> None:
        for key in ("angle", "current", "output_angle"):
            if not 0.0 <= getattr(self, key) < np.inf:
                raise ExcitationError(f"noise.{key}", getattr(self, key), "must be 0 or more, and finite")


def record_log(
    limb: BenchLimb, flaws: LimbFlaws, noise: SensorNoise | None = None, *, output_encoder: bool = True
) -> Log:
    """Excite every joint of a simulated limb in turn and log what its sensors say.

    The log's columns are time and, for each joint, its encoder's angle, the command voltage, the motor's current and the angle behind
    the gear. Hard stops stand at the joints' limits, whatever `flaws` says.

    Args:
        limb: On the bench.
        flaws: Of the plant.
        noise: Of the sensors.
        output_encoder: Whether there is an angle behind the gear.

    Raises:
        ExcitationError: If the robot's file states no amplifier gain, or a joint does not move at its torque limit.
    """
    noise = noise or SensorNoise()
    motor = limb.robot.motor
    if motor.amplifier_gain is None:
        raise ExcitationError(
            "motor.amplifier_gain", None, f"must be stated in {limb.robot.name}'s file: commands are volts"
        )
    stopped = flaws.with_changes(joint_limits=True, push=None, wall=None)
    plant = MujocoLimb(limb.chain, stopped, gears=limb.gears)
    plant.reset(limb.q0)
    rows: list[Floats] = []
    for j in range(limb.chain.n):
        drive = Drive(limb.chain.joints[j], flaws.period)
        for phase in phases_of(drive):
            _carry_out(plant, limb, j, drive, phase, rows)
    return _log_of(np.array(rows), limb, flaws, noise, output_encoder)


def _carry_out(plant: MujocoLimb, limb: BenchLimb, j: int, drive: Drive, phase: Phase, rows: list[Floats]) -> None:
    """Run one phase of joint `j` to its end; the other joints are held where they are as it starts."""
    inertia = limb.chain.joints["rotor"]
    held = plant.truth().states[0, 0].copy()
    ticks = 0
    while True:
        states = plant.sense().states[0]
        torques = SERVO_STIFFNESS * inertia * (held - states[0]) - 2 * SERVO_STIFFNESS**0.5 * inertia * states[1]
        torque, done = phase.torque(drive, ticks, float(states[0, j]), float(states[1, j]))
        if done:
            return
        torques[j] = torque
        plant.actuate(torques[None])
        asked = np.clip(torques, -limb.chain.joints["limit"], limb.chain.joints["limit"])
        angles, true = states[0].copy(), plant.truth().states[0, 0].copy()
        plant.step()
        rows.append(np.concatenate((angles, true, asked, plant.truth().torques[0])))
        ticks += 1
        if len(rows) * plant.period > MOST_SECONDS:
            raise ExcitationError(
                "seconds", MOST_SECONDS, f"is not enough: {limb.chain.joint_names[j]} hangs in {phase.name}"
            )


def _log_of(rows: Floats, limb: BenchLimb, flaws: LimbFlaws, noise: SensorNoise, output_encoder: bool) -> Log:
    rng = np.random.default_rng(noise.seed)
    motor, n = limb.robot.motor, limb.chain.n
    assert motor.amplifier_gain is not None  # checked before the run
    per_current = motor.torque_constant * limb.gears
    columns: dict[str, Floats] = {"time": np.arange(len(rows)) * np.float64(flaws.period)}
    units = {"time": "s"}
    for j, name in enumerate(limb.chain.joint_names):
        angle, true, asked, given = rows.reshape(-1, 4, n)[:, :, j].T
        columns[f"{name} angle"] = angle + noise.angle * rng.standard_normal(len(rows))
        columns[f"{name} command"] = asked / (per_current[j] * motor.amplifier_gain)
        columns[f"{name} current"] = given / per_current[j] + noise.current * rng.standard_normal(len(rows))
        units |= {f"{name} angle": "rad", f"{name} command": "V", f"{name} current": "A"}
        if output_encoder:
            columns[f"{name} output angle"] = true + noise.output_angle * rng.standard_normal(len(rows))
            units[f"{name} output angle"] = "rad"
    notes = {"robot": limb.robot.name, "limb": limb.name, "seed": str(noise.seed)}
    if flaws.upright:
        notes["upright"] = "yes"
    return Log(columns, units, notes, "simulated log")


def log_summary(log: Log, path: Path) -> Json:
    """What was recorded, as plain data."""
    return {
        "file": str(path),
        "rows": log.rows,
        "seconds": float(log.columns["time"][-1]),
        "columns": log.titles(),
        "notes": dict(log.notes),
    }
