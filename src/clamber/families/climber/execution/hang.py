"""Hanging on one limb: letting go into it, the swing damped by the limb's own joints, the body's height and angle kept and changed."""

import math
from typing import Final

import numpy as np

from ....types import Floats
from .approach import free_distance
from .climber import Climber, FallenError
from .hook_release import AWAY
from .motions import follow, move_body
from .pendulum import Pendulum
from .postures import bent_postures

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


WAY: Final = 0.2
"""Turn of the body on one straight way of it [rad]."""
SETTLING: Final = 0.3
"""Before the load passes to one limb [s]."""
OFFSETS: Final = (0.0, 0.005, 0.01, 0.015, 0.02, 0.025, 0.03)
"""How far the weight may be from below the hold that stays, on the side where it is, tried in turn [m]: from farther the other hook bears
more than a tenth of the weight, and is caught on its hold. That counts for more than how far the hook can be lifted straight off."""
TURNS: Final = np.radians(np.arange(-75.0, 76.0, 7.5))
"""Of the body from where it is that are tried [rad]."""
DEPTHS: Final = np.arange(0.10, 0.33, 0.02)
"""Of the body below the hold [m]."""
ROUNDS: Final = 5
"""In which the body's x is found for an angle and a height."""
NEAR: Final = 0.002
"""Of the weight's place that they come to [m]."""
OFF: Final = 0.022
"""Way off a hold against the grab direction, after which a hook is out of its slot and its flare [m]."""
BACK: Final = 0.05
"""Way back towards the limb's own shoulder after it, always where the limb does not reach to where its hook is clear of its hold all round
[m]."""
ASIDE: Final = 0.25
"""It goes that way as well where its hook is clear, if this part of it leads away from the hold [-]: a body that swings would strike the
hold with it, and be driven on by every blow."""
CAUGHT: Final = 0.015
"""A tip that is nearer to its hold after that has not come off [m]."""
BRISK: Final = (0.055, 0.06)
"""Lag of its joints from which a hook that comes off is waited for: slowed down sooner, it drags the body aside by its friction [rad]."""
STRAIGHT: Final = math.radians(8.0)
"""A limb whose elbow is straighter is at the end of its reach [rad]."""
ON_TOP: Final = 0.5
"""A hook that pulls less downwards might come off where it bears the weight [-]."""
NOT_UNDER: Final = -0.1
"""Likewise that which leaves, and bears next to nothing [-]."""


def release_to_hang(climber: Climber, i: int, stay: int) -> Hang | None:
    """Take limb `i` off, so that the body hangs on limb `stay` alone.

    While both hold, the body goes to where its centre of gravity is below the hold that stays; the other one then bears next to nothing,
    and taking it off sets off no swing. What is left of one is damped.

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
    pose, clear = body.settled, _clear_off(climber, i)
    far = bool(bent_postures(limb, pose, place - clear * g, float(body.q[i, 1]), STRAIGHT))
    off = clear if far else OFF
    points = [place - part * off * g for part in (0.25, 0.5, 0.75, 1.0)]
    c, s = math.cos(pose[2]), math.sin(pose[2])
    port = pose[:2] + np.array((c * limb.port_x - s * limb.port_y, s * limb.port_x + c * limb.port_y))
    back = (port - points[-1]) / float(np.hypot(*(port - points[-1])))
    withdrawn = [points[-1] + part * BACK * back for part in (0.5, 1.0)]
    if not far or math.dist(withdrawn[-1], place) > off + ASIDE * BACK:
        points += withdrawn
    way = [body.q[i] - body.play[i]]
    for point in points:
        way += [one.angles for one in bent_postures(limb, pose, point, float(way[0][1]))]
    task.hold = 0
    follow(climber, i, np.array(way), BRISK)
    return float(np.hypot(*(body.felt_tip(i) - hold))) > CAUGHT


def pose_to_let_go(climber: Climber, i: int, stay: int) -> Floats | None:
    """The pose nearest to the present one in which both limbs are well on their holds and the weight is below that of `stay`.

    Limb `i` can be lifted off there, until its hook is clear of its hold all round if that can be. None where there is none.
    """
    for offset in OFFSETS:
        for off in (_clear_off(climber, i), OFF):
            pose = _pose_to_lift(climber, i, stay, off, offset)
            if pose is not None:
                return pose
    return None


def _clear_off(climber: Climber, i: int) -> float:
    """How far limb `i` has to be lifted off its hold until its hook may go anywhere [m]."""
    return free_distance(climber.peg_radius, climber.map.error(climber.body.tasks[i].hold)) + AWAY


def _pose_to_lift(climber: Climber, i: int, stay: int, off: float, offset: float) -> Floats | None:
    """The pose nearest to the present one where the weight is at most `offset` from below the hold of `stay`, with room to lift `i` off."""
    body, robot = climber.body, climber.robot
    pendulum, here, hold = Pendulum(robot, stay), body.settled.copy(), body.tasks[stay].place
    q = body.q - body.play
    now = (pendulum.arm(q) * complex(math.cos(here[2]), math.sin(here[2]))).real
    wished = math.copysign(min(offset, abs(now)), now)
    found = []
    for turn in TURNS:
        for depth in DEPTHS:
            pose = np.array((here[0] - now + wished, hold[1] - depth, here[2] + turn))
            moved = q.copy()
            for _ in range(ROUNDS):  # the weight moves with the limbs that reach for the holds
                holding, leaving = _well_on(climber, stay, pose, 0.0), _well_on(climber, i, pose, off)
                if holding is None or leaving is None:
                    break
                moved[stay], moved[i] = holding, leaving
                aside = (pendulum.arm(moved) * complex(math.cos(pose[2]), math.sin(pose[2]))).real - wished
                if abs(aside) < NEAR:
                    found.append(pose)
                    break
                pose[0] -= aside
    return min(
        found, key=lambda pose: float(np.hypot(*(pose[:2] - here[:2])) + 0.2 * abs(pose[2] - here[2])), default=None
    )


def _well_on(climber: Climber, i: int, pose: Floats, off: float) -> Floats | None:
    """Angles of a limb on its hold at a pose, its elbow on the side where it is, its hook well on top, and room to lift it off by `off`."""
    limb, task, side = climber.robot.limbs[i], climber.body.tasks[i], float(climber.body.q[i, 1])
    on = bent_postures(limb, pose, task.place, side)
    if not on or on[0].on_top < (NOT_UNDER if off > 0.0 else ON_TOP) or abs(on[0].angles[1]) < STRAIGHT:
        return None
    if off > 0.0 and not bent_postures(limb, pose, task.place - off * on[0].grab, side, STRAIGHT):
        return None
    return on[0].angles
