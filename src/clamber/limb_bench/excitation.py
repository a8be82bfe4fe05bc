"""Logs to identify a limb's joints from: constant torques both ways, sines about an offset, slow reversals, a stall.

Each joint is driven by itself, as in 3.4.2 of Bevly 1997, while the others are held. Torques between these phases come from a servo on
the joint's angle, so that each phase starts where it has room, whatever the friction is: the torque that starts the joint is found first.
"""

import math
from collections.abc import Generator, Iterator, Mapping
from dataclasses import dataclass
from itertools import count
from pathlib import Path
from typing import Any, Final, TypeAlias

import numpy as np

from ..execution.log import Log
from ..json_form import Count, Jsonable
from ..sim.bench_limb import BenchLimb
from ..sim.limb_flaws import LimbFlaws
from ..sim.mujoco_limb import MujocoLimb
from ..types import Floats
from .scenario import ScenarioError

SERVO_STIFFNESS: Final = 40.0
"""Of the servo that holds and returns joints, per inertia [1/s^2]; it is critically damped."""
MOST_SECONDS: Final = 900.0


RAMP_TIME: Final = 30.0
"""In which the starting torque grows from 0 to the joint's limit [s]."""
STARTED: Final = 0.002
"""A joint that moved so far from rest has started [rad]."""
MARGIN: Final = 0.25
"""Kept from the joint's limits in motion [rad]."""
RETURN_SPEED: Final = 0.8
"""Of the servo's reference [rad/s]."""
CREEP_SPEED: Final = 0.1
"""[rad/s]."""
CREEP_SECONDS: Final = 4.0
SPEEDS: Final = (0.15, 0.3, 0.8)
"""That constant torques may end at [rad/s]: two slow ones get there within the joint's range, the last leaves it in motion."""
SINES: Final = (0.7, 1.3, 2.3, 3.7)
"""Frequencies [Hz], with equal amplitudes of speed as far as inertia rules."""
REVERSALS: Final = 0.5
"""Frequency of a slow sine about no torque [Hz]."""
REVERSAL_CYCLES: Final = 4
REVERSAL_SPEED: Final = 0.5
"""About the largest that it brings [rad/s]."""
STALL_STEPS: Final = 12
STALL_PART: Final = 0.6
"""Of the torque limit, at the last step of a stall."""
Torques: TypeAlias = Generator[float, tuple[float, float], None]
"""A phase of an excitation: torques [N m], each for the angle and the speed sent to it at a tick; it ends with the phase."""


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
                raise ScenarioError("excitation", f"noise.{key}", getattr(self, key), "must be 0 or more, and finite")


@dataclass(slots=True, eq=False)
class Drive:
    """One joint as the one who excites it knows it, and what is learnt on the way; its phases are methods."""

    joint: Any
    """Record of `control.records.JOINT`: only to choose torques and times by."""
    period: float
    starting: float = 0.0
    """Torque at which the joint starts and keeps moving [N m], found by the first phases."""

    @property
    def low(self) -> float:
        """Lower end of free motion [rad]."""
        return float(self.joint["lower"]) + MARGIN

    @property
    def high(self) -> float:
        """Upper end of free motion [rad]."""
        return float(self.joint["upper"]) - MARGIN

    @property
    def inertia(self) -> float:
        """Of the motor at the joint [kg m^2]."""
        return float(self.joint["rotor"])

    @property
    def damping(self) -> float:
        """[N m s/rad]."""
        return float(self.joint["damping"])

    def moving(self, speed: float) -> float:
        """Torque that ends near a speed [N m]."""
        return self.starting + self.damping * speed

    def left(self, angle: float, sign: float) -> bool:
        """Whether the joint has left the range of free motion, in the direction of a sign."""
        return angle > self.high if sign > 0.0 else angle < self.low

    def phases(self) -> Iterator[tuple[str, Torques]]:
        """The whole excitation by name, ending at rest in the middle of the joint's range."""
        middle, low, high = (self.low + self.high) / 2, self.low + 0.05, self.high - 0.05
        yield "going", self.go(middle)
        yield "starting", self.start()
        yield "creeping", self.creep()
        for speed in SPEEDS:
            for at, signed in ((low, speed), (high, -speed)):
                yield "going", self.go(at)
                yield "constant torque", self.constant(signed)
        for at, sign in ((low, 1.0), (high, -1.0)):
            yield "going", self.go(at)
            yield "sines", self.sines(sign)
        yield "going", self.go(middle)
        yield "reversals", self.reversals()
        yield "going", self.go(high)
        yield "stall", self.stall()
        yield "going", self.go(middle)

    def go(self, to: float) -> Torques:
        """A servo brings the joint to an angle, slowly, and rests there."""
        angle, speed = yield 0.0
        way, resting = to - angle, 0.0
        start = angle
        for tick in count():
            part = min(1.0, tick * self.period * RETURN_SPEED / max(abs(way), 1e-9))
            aim, rate = start + part * way, math.copysign(RETURN_SPEED, way) if part < 1.0 else 0.0
            pull = SERVO_STIFFNESS * (aim - angle) + 2 * SERVO_STIFFNESS**0.5 * (rate - speed)
            resting = resting + self.period if part == 1.0 and abs(speed) < 0.02 else 0.0
            if resting > 0.3:
                return
            angle, speed = yield self.inertia * pull + math.copysign(self.starting, rate) * (rate != 0.0)

    def start(self) -> Torques:
        """The torque grows until the joint starts; it is kept as the starting torque."""
        angle, _ = yield 0.0
        rest = angle
        for tick in count():
            torque = float(self.joint["limit"]) * tick * self.period / RAMP_TIME
            if abs(angle - rest) > STARTED:
                self.starting = torque
                return
            angle, _ = yield torque

    def creep(self) -> Torques:
        """A servo draws the joint along slowly; the mean torque, less that of damping, replaces the starting torque."""
        angle, speed = yield 0.0
        start, total, many = angle, 0.0, 0
        for tick in count():
            time = tick * self.period
            off = start + CREEP_SPEED * time - angle
            pull = SERVO_STIFFNESS * off + 2 * SERVO_STIFFNESS**0.5 * (CREEP_SPEED - speed)
            torque = self.starting + self.inertia * pull
            if time > CREEP_SECONDS / 2:
                total, many = total + torque, many + 1
            if time >= CREEP_SECONDS:
                self.starting = max(0.0, total / many - self.damping * CREEP_SPEED)
                return
            angle, speed = yield torque

    def constant(self, speed: float) -> Torques:
        """A constant torque from rest, that may end at a signed speed [rad/s], until the range ends (Bevly 1997, 3.4.2).

        It ends after four time constants of the speed, I / d, at most 15 s.
        """
        settling = min(15.0, 4.0 * self.inertia / self.damping) if self.damping > 0.0 else 15.0
        angle, _ = yield 0.0
        for tick in count():
            if self.left(angle, speed) or tick * self.period > settling:
                return
            angle, _ = yield math.copysign(1.0, speed) * self.moving(abs(speed))

    def sines(self, sign: float) -> Torques:
        """Several sines about an offset that keeps the joint moving one way (Bevly 1997, figure 3.9)."""
        angle, _ = yield 0.0
        for tick in count():
            time = tick * self.period
            wave = sum(math.tau * f * math.sin(math.tau * f * time + k) for k, f in enumerate(SINES))
            if self.left(angle, sign) or time > 8.0:
                return
            angle, _ = yield sign * (self.moving(0.55) + 0.09 * self.inertia * wave)

    def reversals(self) -> Torques:
        """A slow sine about no torque, so that the play is crossed both ways."""
        size = 1.4 * self.starting + REVERSAL_SPEED * math.hypot(self.damping, math.tau * REVERSALS * self.inertia)
        yield 0.0
        for tick in count():
            time = tick * self.period
            if time > REVERSAL_CYCLES / REVERSALS:
                return
            yield size * math.cos(math.tau * REVERSALS * time)

    def stall(self) -> Torques:
        """The joint is driven softly into its upper stop and pushed against it harder and harder (Bevly 1997, 4.3.4)."""
        angle, speed = yield 0.0
        while not (angle > float(self.joint["upper"]) - 0.03 and abs(speed) < 0.005):
            angle, speed = yield self._soft(speed)
        yield self._soft(speed)
        for tick in count(1):
            step = int(tick * self.period / 0.3)
            if step >= STALL_STEPS:
                return
            yield STALL_PART * float(self.joint["limit"]) * (1 + min(step, STALL_STEPS - 1)) / STALL_STEPS

    def _soft(self, speed: float) -> float:
        """Torque towards 0.3 rad/s."""
        return self.starting + self.damping * 0.3 + self.inertia * 10.0 * (0.3 - speed)


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
        ScenarioError: If the robot's file states no amplifier gain, or a joint does not move at its torque limit.
    """
    noise = noise or SensorNoise()
    motor = limb.robot.motor
    if motor.amplifier_gain is None:
        raise ScenarioError(
            "excitation",
            "motor.amplifier_gain",
            None,
            f"must be stated in {limb.robot.name}'s file: commands are volts",
        )
    stopped = flaws.with_changes(joint_limits=True, push=None, wall=None)
    plant = MujocoLimb(limb.chain, stopped, gears=limb.gears)
    plant.reset(limb.q0)
    rows: list[Floats] = []
    for j in range(limb.chain.n):
        drive = Drive(limb.chain.joints[j], flaws.period)
        for name, torques in drive.phases():
            _carry_out(plant, limb, j, name, torques, rows)
    return _log_of(np.array(rows), limb, flaws, noise, output_encoder)


def _carry_out(plant: MujocoLimb, limb: BenchLimb, j: int, name: str, phase: Torques, rows: list[Floats]) -> None:
    """Run one phase of joint `j` to its end; the other joints are held where they are as it starts."""
    inertia = limb.chain.joints["rotor"]
    held = plant.truth().states[0, 0].copy()
    next(phase)
    while True:
        states = plant.sense().states[0]
        torques = SERVO_STIFFNESS * inertia * (held - states[0]) - 2 * SERVO_STIFFNESS**0.5 * inertia * states[1]
        try:
            torques[j] = phase.send((float(states[0, j]), float(states[1, j])))
        except StopIteration:
            return
        plant.actuate(torques[None])
        asked = np.clip(torques, -limb.chain.joints["limit"], limb.chain.joints["limit"])
        angles, true = states[0].copy(), plant.truth().states[0, 0].copy()
        plant.step()
        rows.append(np.concatenate((angles, true, asked, plant.truth().torques[0])))
        if len(rows) * plant.period > MOST_SECONDS:
            raise ScenarioError(
                "excitation", "seconds", MOST_SECONDS, f"is not enough: {limb.chain.joint_names[j]} hangs in {name}"
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


@dataclass(frozen=True, slots=True)
class Recorded(Jsonable):
    """A log that was written."""

    file: str
    rows: Count
    seconds: float
    columns: tuple[str, ...]
    notes: Mapping[str, str]

    @classmethod
    def of(cls, log: Log, path: Path) -> "Recorded":
        """Of a log in a file."""
        return cls(str(path), log.rows, float(log.columns["time"][-1]), tuple(log.titles()), log.notes)
