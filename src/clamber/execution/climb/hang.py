"""Hanging on one limb: letting go into a hang, damping the swing with the limb's own joints, other joint angles, and the load shared again."""

import math
from typing import Final

import numpy as np

from ...types import Floats
from .climber import Climber, FallenError
from .motions import follow, move_body
from .pendulum import Pendulum
from .postures import postures

DAMPING: Final = 0.5
"""kappa of the damping, 0 .. 1 [-]."""
LAG: Final = 0.5
"""T of the damping: the less, the more of what the joints do goes against the swing; the joints must follow twice as fast [-]."""
WIDEST: Final = 0.25
"""Most that the joints go aside for damping: at LIBRA's swings half their no-load speed [rad]."""
TRACKING: Final = 40.0
"""Of the observer of the swing [rad/s]."""
OVER: Final = math.radians(100.0)
"""A centre of gravity that is farther than this from straight below does not hang on anything [rad]."""
SPEED: Final = 0.05
"""With which the body rises and sinks [m/s]."""
TURN: Final = 0.25
"""[rad/s]."""
JOINT_SPEED: Final = 0.8
"""Most of the holding limb's joints, but for the damping [rad/s]."""
CALM: Final = math.radians(1.0), math.radians(4.0)
"""Amplitude [rad] below which a swing no longer matters, and speed [rad/s]."""
PATIENCE: Final = 12.0
"""Most time for a swing to calm down [s]."""
WAY: Final = 0.2
"""Turn of the body on one straight way of it [rad]."""
SETTLING: Final = 0.3
"""Before the load passes to one limb [s]."""
OFFSETS: Final = (0.0, 0.005, 0.01, 0.015)
"""How far the weight may be from below the hold that stays, on the side where it is, tried in turn: from farther the other hook bears, and is
caught on its hold [m]."""
TURNS: Final = np.radians(np.arange(-75.0, 76.0, 7.5))
"""Of the body from where it is that are tried [rad]."""
DEPTHS: Final = np.arange(0.10, 0.33, 0.02)
"""Of the body below the hold [m]."""
ROUNDS: Final = 5
"""In which the body's x is found for an angle and a height."""
NEAR: Final = 0.002
"""Of the weight's place that they come to [m]."""
OFF: Final = 0.022
"""Way off a hold against the grab direction, after which a hook is out of its slot and its flare, and may go anywhere [m]."""
BACK: Final = 0.05
"""Way back towards the limb's own shoulder after it [m]."""
CAUGHT: Final = 0.015
"""A tip that is nearer to its hold after that has not come off [m]."""
STRAIGHT: Final = math.radians(8.0)
"""A limb whose elbow is straighter is at the end of its reach [rad]."""
ON_TOP: Final = 0.5
"""A hook that pulls less downwards might come off [-]."""


class Hang:
    r"""A body that hangs on one limb: keeps the limb's joints at angles, and its swing damped.

    The pivot at the hold is passive, so damping has to come from the joints' inertia c (`Pendulum`): along n = c / |c| they go aside by u,

        tau u' = -(k phi' + u),    tau = T / omega,    k = kappa I tau / |c|

    With z = s / omega the swing then obeys (1 - kappa) T z^3 + z^2 + T z + 1 = 0: damped for 0 < kappa < 1 (Routh), with the ratio
    kappa T / (2 + 2 T^2) for small ones. phi' is an observer's, as differences of an encoder's counts are rough.

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
        self.speed = 0.0
        """[rad/s]."""
        self.aside = 0.0
        """u [rad]."""
        limb = climber.robot.limbs[i]
        self._lower = np.array((limb.shoulder.lower, limb.elbow.lower))
        self._upper = np.array((limb.shoulder.upper, limb.elbow.upper))
        self.tune()
        task = body.tasks[i]
        task.doing = "hang"
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
        self.omega = self.pendulum.frequency(q)
        """Of the swing [rad/s]."""
        self._along = c / size
        self._gain = self.damping * self.pendulum.inertia(q) * LAG / (size * self.omega)

    def balance(self) -> None:
        """After sensing, before commanding: what the holding limb is to do at this tick.

        Raises:
            FallenError: If the body is where nothing that hangs can be.
        """
        body, period = self.climber.body, self.climber.plant.period
        seen = self.pendulum.swing(body.q, float(body.pose[2]))
        if abs(seen) > OVER:
            raise FallenError(f"the body hangs {np.degrees(seen):.0f} deg from straight below its hold")
        off = seen - self.phi
        self.phi += period * (self.speed + 2.0 * TRACKING * off)
        self.speed += period * TRACKING**2 * off
        pushing = any(task.doing == "pull" for task in body.tasks)  # against a hold the body is no pendulum
        wished = 0.0 if pushing else float(np.clip(self._gain * self.speed, -WIDEST, WIDEST))
        rate = -self.omega / LAG * (wished + self.aside)
        self.aside += period * rate
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

    def calm(self, seconds: float = PATIENCE) -> bool:
        """Wait until the body hardly swings, for a whole period of it; whether it does."""
        period = self.climber.plant.period
        quiet = 0.0
        for _ in range(round(seconds / period)):
            self.climber.tick()
            amplitude = math.hypot(self.speed / self.omega, 0.0)
            quiet = quiet + period if amplitude < CALM[0] else 0.0
            if quiet > math.tau / self.omega:
                return True
        return False

    def end(self) -> None:
        """Let every limb on a hold carry the body where it is."""
        body = self.climber.body
        self.climber.balance = None
        body.tasks[self.i].doing = "hold"
        body.aim[:] = body.pose
        body.aim_speed[:] = 0.0
        self.climber.carry_with_all(but=-1)


def let_go(climber: Climber, i: int, stay: int) -> Hang | None:
    """Take limb `i` off, so that the body hangs on limb `stay` alone.

    While both hold, the body goes to where its centre of gravity is below the hold that stays; the other one then bears next to nothing, and
    taking it off sets off no swing. What is left of one is damped.

    Returns:
        The hang; None where the limbs do not reach so far, and nothing has moved.

    Raises:
        FallenError: If the hook does not come off.
    """
    body = climber.body
    start = body.settled.copy()
    end = pose_to_let_go(climber, i, stay)
    if end is None:
        return None
    ways = max(1, math.ceil(abs(end[2] - start[2]) / WAY))
    for k in range(1, ways + 1):
        move_body(climber, start + k / ways * (end - start))
    climber.wait(SETTLING)
    climber.carry_with_all(but=i)
    hang = Hang(climber, stay, damping=0.0)
    if not lift_off(climber, i):
        raise FallenError("the hook that was to let go is caught on its hold")
    hang.damping = DAMPING
    hang.tune()
    hang.calm()
    return hang


def lift_off(climber: Climber, i: int) -> bool:
    """Take limb `i` off its hold by its joints, against its grab direction and then back towards its shoulder; whether it came off.

    Stretched as the limb may be, its joints do it more surely than its tip's law.
    """
    body = climber.body
    task, limb = body.tasks[i], climber.robot.limbs[i]
    g, place, hold = body.grab_direction(i), body.tip(i), task.place.copy()
    pose = body.settled
    c, s = math.cos(pose[2]), math.sin(pose[2])
    port = pose[:2] + (c * limb.port_x - s * limb.port_y, s * limb.port_x + c * limb.port_y)
    out = place - OFF * g
    back = (port - out) / float(np.hypot(*(port - out)))
    points = [place - part * OFF * g for part in (0.25, 0.5, 0.75, 1.0)] + [
        out + part * BACK * back for part in (0.5, 1.0)
    ]
    way = [body.q[i].copy()]
    for point in points:
        fit = [one for one in postures(limb, pose, point) if one.inside and one.angles[1] * way[0][1] > 0.0]
        way += [one.angles + body.play[i] for one in fit]
    task.hold = 0
    follow(climber, i, np.array(way))
    return float(np.hypot(*(body.felt_tip(i) - hold))) > CAUGHT


def pose_to_let_go(climber: Climber, i: int, stay: int) -> Floats | None:
    """The pose nearest to the present one in which both limbs are well on their holds and the weight is below that of `stay`.

    Limb `i` can be lifted off there. None where there is none.
    """
    body, robot = climber.body, climber.robot
    pendulum, here, hold = Pendulum(robot, stay), body.settled.copy(), body.tasks[stay].place
    q = body.q - body.play
    now = (pendulum.arm(q) * complex(math.cos(here[2]), math.sin(here[2]))).real
    for offset in OFFSETS:
        wished = math.copysign(min(offset, abs(now)), now)
        found = []
        for turn in TURNS:
            for depth in DEPTHS:
                pose = np.array((here[0] - now + wished, hold[1] - depth, here[2] + turn))
                moved = q.copy()
                for _ in range(ROUNDS):  # the weight moves with the limbs that reach for the holds
                    angles = [_well_on(climber, stay, pose, 0.0), _well_on(climber, i, pose, OFF)]
                    if angles[0] is None or angles[1] is None:
                        break
                    moved[stay], moved[i] = angles
                    aside = (pendulum.arm(moved) * complex(math.cos(pose[2]), math.sin(pose[2]))).real - wished
                    if abs(aside) < NEAR:
                        found.append(pose)
                        break
                    pose[0] -= aside
        if found:
            return min(found, key=lambda pose: float(np.hypot(*(pose[:2] - here[:2])) + 0.2 * abs(pose[2] - here[2])))
    return None


def _well_on(climber: Climber, i: int, pose: Floats, off: float) -> Floats | None:
    """Angles of a limb on its hold at a pose, its elbow on the side where it is, its hook well on top, and room to lift it off by `off`."""
    limb, task, side = climber.robot.limbs[i], climber.body.tasks[i], climber.body.q[i, 1]
    on = [one for one in postures(limb, pose, task.place) if one.inside and one.angles[1] * side > 0.0]
    if not on or on[0].on_top < ON_TOP or abs(on[0].angles[1]) < STRAIGHT:
        return None
    if off > 0.0:
        clear = postures(limb, pose, task.place - off * on[0].grab)
        if not any(one.inside and one.angles[1] * side > 0.0 and abs(one.angles[1]) > STRAIGHT for one in clear):
            return None
    return on[0].angles
