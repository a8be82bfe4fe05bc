"""What lies between a controller and a limb's mechanics, the same for every plant: encoders with their delay, and the motors' limits."""

from typing import Final

import numpy as np

from ..control.chain import Chain
from ..control.records import AXES
from ..execution.plant import Sensed, Truth
from ..types import Floats
from .electronics import limit_torques, read_encoders, take_torques
from .force_sensing import ForceSensing
from .limb_flaws import LimbFlaws
from .plant_rules import PlantError


class Chances:
    """What a seed makes of a batch of limbs; the same for any plant.

    Args:
        flaws: Their seed, play and noise.
        batch, n: Limbs, and joints of each.
        counts: Encoder counts per radian of each joint, shape (n,); 0 for a perfect one.
    """

    def __init__(self, flaws: LimbFlaws, batch: int, n: int, counts: Floats) -> None:
        self._flaws, self._shape = flaws, (batch, n)
        self._counts = counts
        self.play: Floats = np.zeros(self._shape)
        """Where each joint starts in its play, output over motor side [rad], shape (batch, n)."""
        self.phase: Floats = np.zeros(self._shape)
        """What each encoder has turned since its last count when its angle is told as 0 [rad], shape (batch, n)."""
        self._noise = np.random.default_rng(flaws.seed)
        self.restart()

    def restart(self) -> None:
        """Draw again what the seed says, as at the start of a run."""
        if self._flaws.seed is None:
            return
        sides, phases, noise = np.random.SeedSequence(self._flaws.seed).spawn(3)
        self.play[:] = self._flaws.backlash / 2 * np.random.default_rng(sides).choice((-1.0, 1.0), self._shape)
        parts = np.random.default_rng(phases).uniform(-0.5, 0.5, self._shape)
        np.divide(parts, self._counts, out=self.phase, where=np.broadcast_to(self._counts > 0.0, self._shape))
        self._noise = np.random.default_rng(noise)

    def disturb(self, states: Floats) -> None:
        """Add the noise of one tick to what the encoders tell, shape (batch, 2, n)."""
        if self._flaws.speed_noise > 0.0:
            states[:, 1] += self._flaws.speed_noise * self._noise.standard_normal(self._shape)


class LimbElectronics:
    """Encoders and motors of a batch of limbs.

    Args:
        chain: Whose motors they are.
        flaws: Counts, delay, whether the motors have limits.
        gears: Motor turns per joint turn, shape (n,): counts are of the motor; None: 1.
        batch: Number of limbs.
    """

    def __init__(self, chain: Chain, flaws: LimbFlaws, gears: Floats | None, batch: int) -> None:
        n = chain.n
        turns = np.ones(n) if gears is None else np.asarray(gears, dtype=np.float64)
        unlimited = np.full(n, np.inf)
        self.limits: Final[Floats] = chain.joints["limit"].copy() if flaws.motor_limits else unlimited
        """Largest torque of each joint, shape (n,) [N m]."""
        self.no_load: Final[Floats] = chain.joints["speed"].copy() if flaws.motor_limits else unlimited
        """Speed of each joint without load, shape (n,) [rad/s]."""
        self.states: Final = np.zeros((batch, 2, n))
        """What the encoders say, shape (batch, 2, n)."""
        self.wanted: Final = np.zeros((batch, n))
        """What the motors are asked for, shape (batch, n) [N m]."""
        self._names = chain.joint_names
        # The motor's own acceleration, and as much again from outside
        with np.errstate(divide="ignore", invalid="ignore"):
            self._agility = 2.0 * self.limits / chain.joints["rotor"]
        self.counts: Final[Floats] = flaws.encoder_counts * turns / (2.0 * np.pi)
        """Of each encoder per radian of its joint, shape (n,); 0 for a perfect one."""
        self._period = flaws.period
        self._ring = np.zeros((flaws.delay + 1, batch, 2, n))
        self._before = np.zeros((batch, n))
        self._readings = 0

    def reset(self) -> None:
        """Forget all readings and torques."""
        self.wanted[:] = 0.0
        self._ring[:] = 0.0
        self._readings = 0

    def read(self, angles: Floats, speeds: Floats) -> None:
        """Read the encoders into `states`, once a tick; true motor-side angles and speeds, shape (batch, n)."""
        read_encoders(angles, speeds, self.counts, self._period, self._readings, self._ring, self._before, self.states)
        self._readings += 1

    def ask(self, torques: Floats) -> None:
        """Ask the motors for torques, held until the next call, shape (batch, n) [N m].

        Raises:
            PlantError: If one is not a finite number.
        """
        bad = take_torques(torques, self.wanted)
        if bad >= 0:
            joint = int(np.argmin(np.isfinite(torques[bad])))
            key = f"torque of the {self._names[joint]}, limb {bad} of the batch"
            raise PlantError(key, float(torques[bad, joint]), "must be a finite number")

    def limit(self, speeds: Floats, time: float, out: Floats, also: Floats) -> bool:
        """What the motors give at these speeds into `out` and `also`; whether it may be held for `time` [s]. See `limit_torques`."""
        steady: bool = limit_torques(self.wanted, speeds, self.limits, self.no_load, self._agility, time, out, also)
        return steady


class SimulatedLimb:
    """Base of simulated limbs: all of a `LimbPlant` but what moves them.

    Args:
        chain: The limb as it is.
        flaws: What is not ideal about it.
        gears: Motor turns per joint turn, shape (n,): encoder counts are of the motor.
        batch: Number of limbs.
    """

    def __init__(self, chain: Chain, flaws: LimbFlaws, gears: Floats | None, batch: int) -> None:
        self.chain, self.flaws, self.batch, self.period = chain, flaws, batch, flaws.period
        n = chain.n
        self._electronics = LimbElectronics(chain, flaws, gears, batch)
        self._initial_conditions = None if flaws.seed is None else Chances(flaws, batch, n, self._electronics.counts)
        self._sensed = Sensed(self._electronics.states, np.zeros((batch, AXES)), np.zeros((batch, AXES)))
        self._truth = Truth(np.zeros((batch, 2, n)), np.zeros((batch, n)), np.zeros((batch, AXES)))
        self._angles, self._speeds = self._truth.states[:, 0], self._truth.states[:, 1]
        """On the motors' side, as they move, shape (batch, n) each."""
        self._forces: ForceSensing | None = None
        self.tick = 0

    def _restart(self) -> None:
        """What every reset does, before the limb is looked at."""
        if self._initial_conditions is not None:
            self._initial_conditions.restart()
        self._truth.torques[:] = 0.0
        self._truth.wrenches[:] = 0.0
        self._electronics.reset()
        self.tick = 0

    def sense(self) -> Sensed:
        """See `Plant`."""
        initial_conditions = self._initial_conditions
        self._electronics.read(
            self._angles if initial_conditions is None else self._angles + initial_conditions.phase, self._speeds
        )
        if initial_conditions is not None:
            initial_conditions.disturb(self._sensed.states)
        self._sensed.number[0] = self.tick
        if self._forces is not None:
            self._forces.sense(self.tick)
        return self._sensed

    def actuate(self, torques: Floats) -> None:
        """See `LimbPlant`."""
        self._electronics.ask(torques)

    def truth(self) -> Truth:
        """See `Plant`."""
        return self._truth
