"""What a robot in space notices of faults in itself, tick by tick: what is bridged, and what ends a run."""

import math
from collections.abc import Sequence
from typing import (
    Final,
    NamedTuple,
    TypeAlias,
)

import numpy as np
import numpy.typing as npt

from ....compiled import Handle, ready
from ....control.whole_body.law import BodyLaw
from ....control.whole_body.tree import FREE
from ....execution.posture_guard import JointHold
from ....execution.reading_monitor import Channel, ReadingMonitor
from ....execution.run_report import FaultError
from ....types import Floats, Ints
from ..control.watch_kernels import (
    count_repeats,
    count_wandered,
    gather,
    give_back,
    unexplained,
)
from ..robot.parts import Motors
from ..robot.robot import SpatialRobot
from .plant import SpatialSensed
from .sensors import sensor_names, sensor_ranges
from .settings import Pace

STEP: Final = 1.5
"""Part of its range by which a gyro or an accelerometer may change within a tick [-]: knocks of gears make half of it ..."""
KNOCK: Final = 12.0
"""... and the same of a tip's sensor, which feels what lands [-]."""
LOOKED_AT: Final = 0.02
"""Time between two looks at what sensors and motors say together [s]."""
TIPS_EVERY: Final = 2
"""Looks from one at the tips to the next."""
SMOOTHED: Final = 0.1
"""Time constant of the torques and forces that are looked at [s] ..."""
FOR: Final = 0.1
"""... and for how long they have to be off [s]."""
WEAK: Final = 0.35
"""Part of a motor's largest torque that neither weights of links nor the tip's wrench explain, beyond which the motor gives less than it is
told [-]: accelerations and gears make half of it in runs without a fault."""
UNBALANCED: Final = 0.3
"""Forces of all tips less what the base's acceleration takes, over the weight, beyond which a sensor is off [-]: two thirds of
it without a fault."""
REPEATS: Final = 0.1
"""For so long an axis says the same to the last bit, while both others of its unit change, before it is stuck [s]."""
WANDERED: Final = 0.05
"""Two tips on their holds that have moved by this part of the longest limb against each other since they came there are there no more, or
a sensor is off [-]: play of gears makes 0.6 of it."""
WANDERING: Final = 0.2
"""For so long that has to last [s]: what slides off is told as a slip before."""
RIGID: Final = 0.3
"""Part of it that the tips have come nearer or farther, below which it is the body that is believed to have turned [-]."""
DISBELIEVED: Final = 0.5
"""Part of what the accelerometer says to accelerate the robot that the tips' forces do not bear out, above which it is not believed [-]."""
SLIDES: Final = 2
"""Times that a foot which has moved against the others has slid; after that a sensor drifts."""
STILL: Final = 0.3
"""An encoder that has not changed by a count for so long is the one at fault where it can be [s]."""


Wandered: TypeAlias = tuple[tuple[int, int], Floats, Floats]
"""Two limbs, how their tips lay to each other, and how they lie now, as believed [m]."""


class Room(NamedTuple):
    """Readings side by side, as `sensors.sensor_names` has them; a NamedTuple, as kernels take it."""

    values: Floats
    speeds: Floats
    commands: Floats
    free: npt.NDArray[np.bool_]
    driven: Floats
    """As those of a `ReadingMonitor`."""
    before: Floats
    """Readings at the look before, shape (sensors,)."""
    repeats: Ints
    """Looks on end at which they had repeated themselves, shape (sensors,)."""
    closed: Ints
    """Switches of the newest reading, shape (limbs,)."""
    shutting: Ints
    """Likewise."""
    came: Ints
    """Holds of each pair of limbs that are on theirs; -1: they are not, shape (limbs, limbs, 2)."""
    lay: Floats
    """How its tips lay to each other when both had come there, as believed [m], shape (limbs, limbs, 3)."""


class Rests(NamedTuple):
    """What nothing explains, smoothed; a NamedTuple, as kernels take it."""

    torques: Floats
    """Of the motors' [N m] or [N], shape (n,)."""
    tips: Floats
    """Of the tips' forces and the weight, world frame [N], shape (3,)."""
    push: Floats
    """What accelerates the robot, by its accelerometer, world frame [N], shape (3,)."""


def channels_of(robot: SpatialRobot, period: float) -> tuple[Channel, ...]:
    """Sensors with how quickly what they read may change, encoders with the largest torques of their motors."""
    motors, ranges, names = Motors.of(robot), sensor_ranges(robot), sensor_names(robot)
    n = len(motors.torque)
    with np.errstate(divide="ignore"):  # what a joint that nothing slows gains over its whole range
        fastest = np.minimum(motors.speed, np.sqrt(2.0 * motors.torque / motors.rotor * ranges[:n]))
    steps = np.concatenate((np.full(n, math.inf), np.full(6, STEP), np.full(len(names) - 2 * n - 6, KNOCK)))
    rates = np.concatenate((fastest, steps * ranges[n:] / period)).tolist()
    limits = [*motors.torque.tolist(), *[math.inf] * (len(names) - n)]
    return tuple(Channel(name=c[0], fastest=c[1], limit=c[2]) for c in zip(names, rates, limits, strict=True))


class SensorWatch:
    """Believes, bridges or gives up readings, and notices what sensors and motors do not say together.

    Without a fault what is believed is what is read, to the last bit.

    Args:
        robot: Whose sensors they are.
        law: Whose torques and dynamics are looked at.
        period: Of the control [s].
    """

    def __init__(self, robot: SpatialRobot, law: BodyLaw, period: float) -> None:
        self._law, self._pace = law, Pace.of(robot)
        limbs, self._n = law.tree.limbs, law.tree.joints
        self.monitor: Final = ReadingMonitor(channels_of(robot, period), period)
        monitor, sensors = self.monitor, len(self.monitor.channels)
        self._room = Room(
            monitor.values,
            monitor.speeds,
            monitor.commands,
            monitor.free,
            monitor.driven,
            np.zeros(sensors),
            np.zeros(sensors, np.int64),
            np.zeros(limbs, np.int32),
            np.zeros(limbs, np.int32),
            np.full((limbs, limbs, 2), -1),
            np.zeros((limbs, limbs, 3)),
        )
        self._owner = np.repeat(np.arange(limbs), robot.chains.n_joints)
        """Limb of each joint, shape (n,)."""
        self._units = 2 * self._n + 3 * np.arange(2 + 2 * limbs)
        self._limits, self._mass = Motors.of(robot).torque, robot.chains.total_mass
        self._every = max(1, round(LOOKED_AT / period))
        looked = self._every * period
        self._share, self._patience = min(1.0, looked / SMOOTHED), math.ceil(FOR / looked)
        self._repeats, self._wandering = math.ceil(REPEATS / looked), math.ceil(WANDERING / looked / TIPS_EVERY)
        self._names = robot.limb_names
        self._slides = np.array([end.bears().capture == 0.0 for end in robot.ends])
        """Limbs that stand by friction alone, shape (limbs,)."""
        self.slid = np.zeros(limbs, np.int64)
        """How often each has slid from its hold so far, shape (limbs,)."""
        self.sliding: int | None = None
        """The one that has slid at this tick; None: none."""
        self._rests = Rests(np.zeros(self._n), np.zeros(3), np.zeros(3))
        self._weak = self._off = self._wandered = 0
        self._ticks, self._newest, self._debt = 0, -1, 0
        self._clock = -1
        self._sensed: SpatialSensed | None = None

    def see(self, sensed: SpatialSensed, holds: Ints) -> None:
        """Take in a tick's readings; those that are not to be believed are bridged, in place.

        Args:
            sensed: What the sensors say. Its number becomes one of the robot's own clock, which goes on where no reading comes.
            holds: Index of the hold that each limb is on, as believed; shape (limbs,).

        Raises:
            FaultError: If a sensor, a motor or the link has failed for good, unless the robot has stopped for that already.
        """
        monitor, law, number = self.monitor, self._law, sensed.number.item(0)
        fresh = number < 0 or number > self._newest
        if self._sensed is not sensed:
            self._sensed = sensed
            rest = law.tree, law.state, law.dynamics, self._limits, self._rests
            handle = Handle(sensed, law.torques, law.aims.does, self._owner, self._room, rest)
            self._gather = ready(gather, handle, self._pace.touch, True)
            self._count_repeats = ready(count_repeats, handle, self._units)
            self._unexplained = ready(unexplained, handle, self._mass, self._share)
            self._count_wandered = ready(count_wandered, handle, holds, 0.0)
        self._gather(self._pace.touch, fresh)
        try:
            monitor.see(number)
            self._ticks += 1
            if self._ticks % self._every == 0 and fresh and not monitor.closed:
                self._look(holds)
        except FaultError:
            if not monitor.closed:
                raise
        finally:
            if monitor.clear < 2:  # something was bridged in this tick or in the one before
                give_back(sensed, self._room)
            if number == self._newest + 1 and self._clock == self._newest:
                self._newest = self._clock = number
            elif number >= 0:
                self._count(number, fresh)
                sensed.number[0] = self._clock

    def _count(self, number: int, fresh: bool) -> None:
        """Let the robot's own clock go on: by a period where no newer reading has come, which is then no news with the next one."""
        if fresh:
            self._clock += max(1, number - self._newest - self._debt) if self._clock >= 0 else number + 1
            self._newest, self._debt = number, 0
        else:
            self._clock += 1
            self._debt += 1

    def _look(self, holds: Ints) -> None:
        """See what sensors and motors say together.

        Raises:
            FaultError: If one of them is off.
        """
        c = self._count_repeats(self._units)
        if self._room.repeats[c] >= self._repeats:
            self._fail("no answer", c, "sensor stuck: it says the same while the others of its unit change")
        off, worst = self._unexplained(self._mass, self._share)
        if self.monitor.clear > self._patience * self._every:
            self._look_at_torques(off / self._pace.weight, worst)
        if self._ticks % (TIPS_EVERY * self._every) == 0:
            self._look_at_tips(holds)

    def _look_at_torques(self, off: float, c: int) -> None:
        """Whether motors, force sensors and accelerometer agree, by how many weights forces are off, and a joint's torque."""
        self._off = self._off + 1 if off > UNBALANCED else 0
        if self._off > self._patience:
            self._fail(
                "unbalanced",
                self._off_sensor(),
                f"sensor off: the tips bear {off:.1f} weights more or less than there are",
            )
        part = abs(float(self._rests.torques[c])) / float(self._limits[c])
        self._weak = self._weak + 1 if part > WEAK else 0
        if self._weak > self._patience and not self._off:
            told = f"{100.0 * part:.0f} % of its largest torque are told it, and nothing bears them"
            self._fail("unbalanced", c, f"motor dead or weak: {told}")

    def _off_sensor(self) -> int:
        """The accelerometer's or the force sensor's axis that explains forces which are off."""
        dynamics, off = self._law.dynamics, self._rests.tips - self._rests.push
        if np.linalg.norm(self._rests.push) > np.linalg.norm(self._rests.tips):
            return 2 * self._n + 3 + int(np.abs(off @ self._law.state.rotation).argmax())
        rests = np.bincount(self._owner, np.abs(self._rests.torques) / self._limits)
        limb = int(rests.argmax())
        return 2 * self._n + 6 + 6 * limb + int(np.abs(off @ dynamics.tip_turn[limb]).argmax())

    def _look_at_tips(self, holds: Ints) -> None:
        """Whether tips have moved against each other that are on their holds."""
        far = WANDERED * self._pace.size
        self._wandered = self._wandered + 1 if self._count_wandered(holds, far) else 0
        if self._wandered <= self._wandering:
            return
        tips, room = self._law.dynamics.tip, self._room
        pairs = [(int(i), int(k)) for i, k in np.argwhere(room.came[..., 0] >= 0)]
        moved = [((i, k), room.lay[i, k], tips[i] - tips[k]) for i, k in pairs]
        ways = np.zeros(self._law.tree.limbs)
        for pair, then, now in moved:
            ways[list(pair)] += np.linalg.norm(now - then)
        limb = int(ways.argmax())
        if self._slides[limb] and self.slid[limb] < SLIDES:
            self.sliding, self._wandered = limb, 0
            far = max(float(np.linalg.norm(now - then)) for pair, then, now in moved if limb in pair)
            self.monitor.note("slide", self._names[limb], f"its tip has moved by {1e3 * far:.0f} mm against others")
            return
        self._tell_wandered([one for one in moved if np.linalg.norm(one[2] - one[1]) > far])

    def forget_place(self, limb: int) -> None:
        """From now on a limb's tip is on its hold where it is now."""
        self._room.came[limb], self._room.came[:, limb] = -1, -1

    def _tell_wandered(self, wandered: Sequence[Wandered]) -> None:
        """Which sensor explains best that tips have moved: the gyro if they have kept their distances, or an encoder."""
        law = self._law
        far = [float(np.linalg.norm(now - then)) for _, then, now in wandered]
        nearer = [abs(float(np.linalg.norm(now) - np.linalg.norm(then))) for _, then, now in wandered]
        told = f"tips have moved by up to {1e3 * max(far):.0f} mm against each other on their holds"
        if len(wandered) > 1 and max(nearer) < RIGID * max(far):
            self._fail("drift", self._turned_sensor(wandered), f"gyro or accelerometer off: {told}, all alike")
        limbs = np.bincount([limb for pair, _, _ in wandered for limb in pair], minlength=law.tree.limbs)
        _, then, now = max(
            wandered, key=lambda one: (limbs[list(one[0])].sum(), float(np.linalg.norm(one[2] - one[1])))
        )
        mine = np.flatnonzero(limbs[self._owner] == limbs.max())
        ways = np.stack([law.dynamics.jacobian[self._owner[c], :3, FREE + c] for c in mine])
        fits = np.abs(ways @ (now - then)) / np.maximum(np.linalg.norm(ways, axis=1), 1e-9)
        still = self.monitor.unchanged[mine] * self.monitor.period > STILL
        c = int(mine[np.where(still if still.any() else True, fits, -1.0).argmax()])
        if still.any():
            self._fail("no answer", c, f"encoder stuck: {told}")
        self._fail("drift", c, f"encoder drifts, or a hold slides: {told}")

    def _turned_sensor(self, wandered: Sequence[Wandered]) -> int:
        """The axis of the IMU by which the body is believed to have turned: the accelerometer's if the tips' forces contradict it."""
        rests, law = self._rests, self._law
        if np.linalg.norm(rests.tips - rests.push) > DISBELIEVED * np.linalg.norm(rests.push):
            return self._off_sensor()
        moments, spread = np.zeros(3), np.zeros((3, 3))
        for _, then, now in wandered:
            moments += np.cross(then, now)
            spread += float(then @ then) * np.eye(3) - np.outer(then, then)
        turn = np.linalg.lstsq(spread, moments)[0] @ law.state.rotation
        return 2 * self._n + int(np.abs(turn).argmax())

    def _fail(self, kind: str, channel: int, why: str) -> None:
        """End the run.

        Raises:
            FaultError: Always.
        """
        self.monitor.bad.add(channel)
        self.monitor.fail(kind, self.monitor.channels[channel].name, why)

    def failed_joint(self) -> int | None:
        """The joint whose motor or encoder is not to be relied upon any more; None: what fails is no joint's."""
        return next((c % self._n for c in sorted(self.monitor.bad) if c < 2 * self._n), None)

    def leave_out(self, joint: int) -> None:
        """From now on nothing is looked for in a joint, which is locked."""
        for c in (joint, self._n + joint):
            self.monitor.leave_out(c)
            self.monitor.bad.discard(c)
        self._limits[joint], self._weak = math.inf, 0

    def guard(self, sensed: SpatialSensed) -> "Guard":
        """What holds the posture of now, once the robot has stopped for a fault; from now on nothing more is told."""
        self.monitor.closed = True
        return Guard(self._law, self.monitor, sensed)


class Guard:
    """Joint springs about a posture, with the torques before fed forward; joints whose sensors have failed keep their torque.

    Args:
        law: Whose limits and dynamics are those of the robot.
        monitor: Which knows the sensors that have failed, and the usual torques.
        sensed: The posture.
    """

    def __init__(self, law: BodyLaw, monitor: ReadingMonitor, sensed: SpatialSensed) -> None:
        n = law.tree.joints
        self._spring = JointHold(np.diag(law.dynamics.mass)[FREE:].copy())
        self._limits, self._fed, self._at = (
            law.limits.torque,
            monitor.usual_commands[:n].copy(),
            sensed.joints[0].copy(),
        )
        self._bad = [c for c in monitor.bad if c < n]

    def hold(self, sensed: SpatialSensed, torques: Floats) -> None:
        """Write the torques of a tick, shape (n,)."""
        wanted = self._spring.torques(self._at, self._fed, *sensed.joints)
        wanted[self._bad] = self._fed[self._bad]
        np.clip(wanted, -self._limits, self._limits, out=torques)
