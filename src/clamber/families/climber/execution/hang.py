"""Hanging on one limb: the swing damped by the limb's own joints, the body's height and angle kept and changed."""

import math
from typing import Final

import numpy as np

from ....types import Floats
from .climber import Climber, FallenError
from .pendulum import Pendulum

DAMPING: Final = 0.5
"""kappa of the damping, 0 .. 1 [-]."""
LAG: Final = 0.5
"""T of the damping: the less, the more of what the joints do goes against the swing; the joints must follow twice as fast [-]."""
WIDEST: Final = 0.25
"""Most that the joints go aside for damping: at LIBRA's swings half their no-load speed [rad]."""
TRACKING: Final = 1.0
"""Of the observer of the swing, in swings' own rate [-]: joints that cross their play look like a swing, and a quick one drives them on."""
OVER: Final = math.radians(100.0)
"""A centre of gravity that is farther than this from straight below does not hang on anything [rad] ..."""
STEEP: Final = math.radians(75.0)
"""From higher up than this nothing is damped: what stays there leans on holds, and joints that move would thrust it off [rad]."""
OVER_FOR: Final = 0.12
"""... for longer than this: one that begins to fall from there may still come to hang [s]."""
SPEED: Final = 0.05
"""With which the body rises and sinks [m/s]."""
TURN: Final = 0.25
"""[rad/s]."""
JOINT_SPEED: Final = 0.8
"""Most of the holding limb's joints, but for the damping [rad/s]."""
FOLD_SPEED: Final = 0.4
"""Of the holding limb's joints where they are led: slower than the swing [rad/s]."""
LEANING: Final = math.radians(12.0)
"""A body that is led slowly and comes this much farther from hanging straight leans on something: holds, with its links [rad]."""
CALM: Final = math.radians(1.0)
"""Amplitude below which a swing no longer matters [rad]."""
PATIENCE: Final = 12.0
"""Most time for a swing to calm down [s]."""


class Hang:
    r"""A body that hangs on one limb: keeps the limb's joints at angles, and its swing damped.

    The pivot at the hold is passive, so damping has to come from the joints' inertia c (`Pendulum`): along n = c / |c| they go aside by u,

        tau u' = -(k phi' + u),    tau = T / omega,    k = kappa I tau / |c|

    With z = s / omega the swing then obeys (1 - kappa) T z^3 + z^2 + T z + 1 = 0: damped for 0 < kappa < 1 (Routh), with the ratio
    kappa T / (2 + 2 T^2) for small ones. phi' is an observer's, which knows the pendulum and what its joints are told: with b = c / I,
    m = phi' + b . q', and phi seen from where the body seems to rest, off by e,

        phi' = m - b . q' + l1 r,    m' = -omega^2 sin phi + l2 r,    e' = l3 r,    r = seen - phi - e

    where all three poles lie at -L: l3 = L^3 / omega^2, l1 = 3 L - l3, l2 = 3 L^2 - omega^2. Differences of an encoder's counts would be
    rough, and joints that cross their play are no swing.

    Args:
        climber: The robot; limb `i` is on a hold.
        i: The limb that holds.
        damping: kappa.
    """

    def __init__(self, climber: Climber, i: int, damping: float = DAMPING) -> None:
        self.climber, self.i, self.damping = climber, i, damping
        self.pendulum = Pendulum(climber.robot, i)
        body = climber.body
        self.angles = body.q[i].copy()
        """That the holding limb's joints keep to, but for the damping [rad]."""
        self.rates = np.zeros(2)
        self.phi = self.pendulum.swing(body.q, float(body.pose[2]))
        """Swing as observed [rad]."""
        self.speed = self._momentum = 0.0
        """Its speed, and with it what the joints take from it [rad/s]."""
        self._rests = 0.0
        """Where it seems to rest [rad]."""
        self.aside = 0.0
        """u [rad]."""
        self._over = 0.0
        """How long the centre of gravity has been too far up [s]."""
        self._led = False
        """Whether a motion leads the joints, rather than depth and angle."""
        limb = climber.robot.limbs[i]
        self._lower = np.array((limb.shoulder.lower, limb.elbow.lower))
        self._upper = np.array((limb.shoulder.upper, limb.elbow.upper))
        self.tune()
        task = body.tasks[i]
        task.mode = "hang"
        pose = self.pendulum.pose(body.q, task.place)
        self.wish = np.array((task.place[1] - pose[1], pose[2]))
        """Depth of the body below the hold [m] and its angle [rad], at rest."""
        self._set(0.0)
        climber.balance = self.balance

    def tune(self) -> None:
        """Reckon the damping anew for the joints' angles."""
        q = self.climber.body.q.copy()
        q[self.i] = self.angles
        c = self.pendulum.momentum(q)
        size = float(np.hypot(*c))
        inertia = self.pendulum.inertia(q)
        self.omega = self.pendulum.frequency(q)
        """Of the swing [rad/s]."""
        self._along = c / size
        self._brings = c / inertia
        """Speed that the joints' own speeds take from the swing [-]."""
        self._gain = self.damping * inertia * LAG / (size * self.omega)

    def balance(self) -> None:
        """After sensing, before commanding: what the holding limb is to do at this tick.

        Raises:
            FallenError: If the body is where nothing that hangs can be.
        """
        body, period = self.climber.body, self.climber.plant.period
        seen = self.pendulum.swing(body.q, float(body.pose[2]))
        self._over = self._over + period if abs(seen) > OVER else 0.0
        if self._over > OVER_FOR:
            raise FallenError(f"the body hangs {np.degrees(seen):.0f} deg from straight below its hold")
        off, pole = seen - self.phi - self._rests, TRACKING * self.omega
        third = pole * TRACKING**2
        self.phi += period * (self.speed + (3.0 * pole - third) * off)
        self._momentum += period * ((3.0 * pole**2 - self.omega**2) * off - self.omega**2 * math.sin(self.phi))
        self._rests += period * third * off
        self.speed = self._momentum - float(self._brings @ body.tasks[self.i].rates)
        pushing = any(task.pushes for task in body.tasks)  # against a hold the body is no pendulum
        wished = 0.0 if pushing or abs(seen) > STEEP else float(np.clip(self._gain * self.speed, -WIDEST, WIDEST))
        rate = -self.omega / LAG * (wished + self.aside)
        self.aside += period * rate
        if not self._led:
            self._follow()
        self._set(rate)

    def _follow(self) -> None:
        """One step of the joints towards the wish, whatever the free limbs have done to the centre of gravity."""
        q, most = self.climber.body.q.copy(), JOINT_SPEED * self.climber.plant.period
        q[self.i] = self.angles
        change = np.clip(self.pendulum.angles_for(q, *self.wish) - self.angles, -most, most)
        self.angles = np.clip(self.angles + change, self._lower, self._upper)
        self.rates = change / self.climber.plant.period

    def _set(self, rate: float) -> None:
        body = self.climber.body
        task = body.tasks[self.i]
        task.angles = np.clip(self.angles + self.aside * self._along, self._lower, self._upper)
        task.rates = self.rates + rate * self._along
        task.loads = self.pendulum.loads(body.q, float(body.pose[2]))

    def bring(self, pose: Floats) -> None:
        """Bring the body to a pose's height and angle, shape (3,); its x is what the weight makes of it."""
        start, period = self.wish.copy(), self.climber.plant.period
        depth = float(self.climber.body.tasks[self.i].place[1] - pose[1])
        change = np.array((depth - start[0], math.remainder(pose[2] - start[1], math.tau)))
        seconds = 1.5 * max(abs(change[0]) / SPEED, abs(change[1]) / TURN, 0.2)
        count = round(seconds / period)
        for k in range(1, count + 1):
            u = k / count
            self.wish = start + u * u * (3 - 2 * u) * change
            self.climber.tick()
        self.tune()

    def fold(self, angles: Floats) -> bool:
        """Bring the holding limb's joints straight to angles, shape (2,) [rad]; the body goes where that and its weight take it.

        Returns:
            Whether it came there; a body that comes to lean on something on the way is left as it is.
        """
        leaning = abs(self.phi) + LEANING
        start, period = self.angles.copy(), self.climber.plant.period
        change = angles - start
        count = max(1, round(1.5 * float(np.abs(change).max()) / FOLD_SPEED / period))
        self._led = True
        try:
            for k in range(1, count + 1):
                u = k / count
                self.angles = start + u * u * (3 - 2 * u) * change
                self.rates = 6 * u * (1 - u) * change / (count * period)
                self.climber.tick()
                if abs(self.phi) > leaning:
                    break
        finally:
            self._led = False
            self.rates = np.zeros(2)
        q = self.climber.body.q.copy()
        q[self.i] = self.angles
        pose = self.pendulum.pose(q, self.climber.body.tasks[self.i].place)
        self.wish[:] = float(self.climber.body.tasks[self.i].place[1] - pose[1]), pose[2]
        self.tune()
        return abs(self.phi) <= leaning

    def calm(self, seconds: float = PATIENCE) -> bool:
        """Wait until the body hardly swings, for a whole period of it; whether it does."""
        period = self.climber.plant.period
        quiet = 0.0
        for _ in range(round(seconds / period)):
            self.climber.tick()
            quiet = quiet + period if abs(self.speed) < CALM * self.omega else 0.0
            if quiet > math.tau / self.omega:
                return True
        return False

    def end(self) -> None:
        """Let every limb on a hold carry the body where it is; at once, where it leans on one that pulls: the two are in balance there."""
        body = self.climber.body
        self.climber.balance = None
        body.tasks[self.i].mode = "stance"
        body.aim[:] = body.pose
        body.aim_speed[:] = 0.0
        pulling = [i for i, task in enumerate(body.tasks) if task.hold and task.mode == "contact_push"]
        for i in pulling:
            body.tasks[i].pressed, body.tasks[i].tug = False, np.zeros(2)
        for task in body.tasks:
            task.side = 0
        if pulling:
            body.carry_at_once([self.i, *pulling])
        self.climber.carry_with_all(but=-1)
