"""Faults of a climber that no single reading shows: motors that bear what weighs nothing, tips that wander, a body that turns unread."""

import math
from collections.abc import Sequence
from itertools import combinations
from typing import Final

import numpy as np

from ....execution.reading_monitor import Channel, ReadingMonitor
from ....types import Floats
from ....units import DEGREE
from ..robot.robot import LimbedRobot
from .body_schemes import turned
from .whole_body import WholeBody

UNBALANCED: Final = 1.5
"""Sum of the forces of all tips and the weight, over the weight, beyond which something else pushes, or a motor does not give what it is
told [-]. Climbs without a fault come to 0.7 while joints cross their play, and to 3 where a link is caught at a peg."""
UNSURE: Final = 0.1
"""Part of a joint's torque limit by which its torque is not known while its limb moves freely: accelerations come a tick late and smoothed
[-]. Of a limb that is nearly straight that is a force along it of more than the weight."""
EXPLAINED: Final = 0.5
"""What is left of that sum, over the weight, without a part of one joint's torque: less than this, and that joint's motor is the one [-].
A link that is caught leaves more, by its place; over eight climbs in which one was, it left less for 0.04 s at most."""
FOR: Final = 0.1
"""Time for which one and the same joint has to explain it [s]."""
WANDERED: Final = 0.06
"""Two tips on their holds that have moved by this part of the longest limb against each other since they came there are there no more, or a
sensor drifts [-]: the play of the joints and the slots makes less than half of it."""
SILENT: Final = 0.03
"""Two tips have moved by this part of the longest limb against each other on their holds since the reading of a joint of theirs, which
answers no torque, changed last, so that it is at fault [-]: more than the play of joints makes meanwhile, an angle times the limb's length
(half a degree a joint in climbs of LIBRA). What they moved before does not count: a sensor that sticks is right at first."""
LOOKED_AT: Final = 0.05
"""Time between two looks at that [s]."""
WANDERING: Final = 1.0
"""A hook that slides off is told as a slip, and caught, within half of this; what lasts longer is a fault [s]."""
DRAGGED: Final = 0.25
"""After so long a limb that carries nothing and has wandered from all others has its hook beside its hold [s]: once, for a limb that
takes its hold again and wanders again has a sensor that drifts."""

TURNED: Final = 1.0 * DEGREE
"""A body that has turned by more than this by the tips that hold it, while its encoder has not changed by a count, has an encoder that is
stuck [rad]: climbs without a fault come to half of it, for 0.1 s while joints cross their play ..."""
TURNING: Final = 0.5
"""... so for that long [s]."""


def channels_of(robot: LimbedRobot) -> tuple[Channel, ...]:
    """The encoders of a climber, limb by limb, then that of its body."""
    joints = [
        Channel(name=name, fastest=robot.no_load_speed_of(joint), limit=robot.torque_limit_of(joint))
        for name, joint in zip(robot.joint_names, robot.joints, strict=True)
    ]
    # a body that hangs turns as its limb does: by both joints together at the most
    return *joints, Channel(name="body", fastest=2.0 * max(channel.fastest for channel in joints))


class SelfWatch:
    """Looks at what all sensors and motors of a climber say together, tick by tick.

    Args:
        body: What knows the limbs and their tasks.
        monitor: Whose channels they are; it ends the run.
    """

    def __init__(self, body: WholeBody, monitor: ReadingMonitor) -> None:
        self._body, self._monitor = body, monitor
        self._most = UNBALANCED * body.robot.weight
        self._patience, self._every = round(FOR / body.period), max(1, round(LOOKED_AT / body.period))
        longest = max(limb.length for limb in body.robot.limbs)
        self._silent, self._wandered_off = SILENT * longest, WANDERED * longest
        joints = monitor.channels[: 2 * body.n]
        self._limits = np.array([joint.limit for joint in joints])
        self._no_load = np.array([joint.fastest for joint in joints])
        self._pairs = list(combinations(range(body.n), 2))
        self.reset()

    def reset(self) -> None:
        """Begin anew, as if all were well."""
        self._ticks = 0
        self._explained = np.zeros(2 * self._body.n, int)
        """Joint -> ticks on end in which it alone has explained what is felt too much."""
        self._wandered = 0
        self._dragged: set[int] = set()
        """Limbs told to have their hooks beside their holds."""
        self._came: dict[tuple[int, int], tuple[tuple[int, int], Floats]] = {}
        """Pair -> its holds, and how its tips lay to each other when both had come there, by the encoders and with the play counted [m]."""
        self._lay: dict[tuple[int, int], Floats] = {}
        """Pair -> how its tips lay, likewise, when the reading of each of its joints changed last since then, shape (4, 4) [m]."""
        self._turning, self._angle = 0, math.nan
        self._lines: dict[tuple[int, int], tuple[tuple[int, int], tuple[float, float]]] = {}
        """Pair -> its holds, and how its line lay, likewise, when the body's encoder changed last or the pair began to hold [rad]."""

    def see(self, forces: Floats, angle: float) -> int | None:
        """Take in a tick; index of the limb whose hook is beside its hold, and dragged along.

        Args:
            forces: What the tips feel, world frame, shape (limbs, 2) [N]; infinite where they cannot tell.
            angle: Of the body by its encoder [rad].

        Raises:
            FaultError: If a motor or a sensor has failed.
        """
        x = y = 0.0
        for fx, fy in forces.tolist():
            x += fx
            y += fy
        off = math.hypot(x, y + self._body.robot.weight)
        sure = self._monitor.clear > self._patience  # accelerations that were bridged are no forces
        if sure and self._most < off < math.inf and self._most < off - self._unsure() and self._gives_what_is_asked():
            left = self._without_one(np.array((x, y + self._body.robot.weight)))
            self._explained = np.where(left < EXPLAINED * self._body.robot.weight, self._explained + 1, 0)
            if self._explained.max() > self._patience:
                self._tell_motor(int(np.where(self._explained > self._patience, left, math.inf).argmin()), off)
        else:
            self._explained[:] = 0
        if angle != self._angle:
            self._angle = angle
            self._lines.clear()
        self._ticks += 1
        if self._ticks % self._every == 0:
            self._look_at_body()
            return self._look_at_tips(angle)
        return None

    def _unsure(self) -> float:
        """How far the forces of all tips together may be off by torques of limbs that move freely [N]; infinite where one is straight."""
        force = 0.0
        for i, task in enumerate(self._body.tasks):
            if task.free:
                matrix = self._body.turned_by_joints(i)
                if abs(np.linalg.det(matrix)) < 1e-6:
                    return math.inf
                pushes = np.linalg.inv(matrix).T * self._limits[2 * i : 2 * i + 2]
                force += UNSURE * float(np.hypot(pushes[0], pushes[1]).max())
        return force

    def _gives_what_is_asked(self) -> bool:
        """Whether no motor is so fast that it gives less than it is told, by its torque-speed line."""
        torques, speeds = self._body.torques.ravel(), self._body.qd.ravel()
        most = self._limits * (1.0 - np.sign(torques) * speeds / self._no_load)
        return bool((np.abs(torques) <= np.maximum(most, 0.0)).all())

    def _without_one(self, rest: Floats) -> Floats:
        """What is left of a force without a part, or all, of one joint's torque, for each joint [N]; infinite where a limb is straight.

        Args:
            rest: Forces of all tips and the weight together [N].
        """
        left = np.full(2 * self._body.n, math.inf)
        for i in range(self._body.n):
            matrix = self._body.turned_by_joints(i)
            if abs(np.linalg.det(matrix)) < 1e-6:
                continue
            pushes = np.linalg.inv(matrix).T * self._body.torques[i]  # one column a joint: its part in the tip's force
            for k in range(2):
                push = pushes[:, k]
                part = min(1.0, max(0.0, float(push @ rest) / max(float(push @ push), 1e-9)))
                left[2 * i + k] = np.hypot(*(rest - part * push))
        return left

    def _tell_motor(self, joint: int, off: float) -> None:
        self._monitor.bad.add(joint)
        weight = self._body.robot.weight
        why = f"motor dead or weak: the tips would bear {off / weight:.1f} weights more than there are"
        self._monitor.fail("unbalanced", self._monitor.channels[joint].name, why)

    def _look_at_body(self) -> None:
        """Whether every two limbs that hold the body say that it turns; a hook that slides moves against all others alone."""
        body, turned = self._body, []
        for pair in self._pairs:
            one, other = (body.tasks[i] for i in pair)
            if one.mode != "stance" or other.mode != "stance":
                self._lines.pop(pair, None)
                continue
            lines = _direction(body.tips, pair), _direction(body.settled_tips, pair)
            known = self._lines.get(pair)
            if known is None or known[0] != (one.hold, other.hold):
                known = self._lines[pair] = (one.hold, other.hold), lines
            turned.append(
                min(abs(math.remainder(now - was, math.tau)) for now, was in zip(lines, known[1], strict=True))
            )
        self._turning = self._turning + 1 if min(turned, default=0.0) > TURNED else 0
        if self._turning * LOOKED_AT > TURNING:
            sensor = 2 * body.n
            self._monitor.bad.add(sensor)
            told = f"by its holding limbs the body has turned by {min(turned) / DEGREE:.1f} deg"
            why = f"sensor stuck: its reading has not changed by a count, and {told}"
            self._monitor.fail("no answer", self._monitor.channels[sensor].name, why)

    def _look_at_tips(self, angle: float) -> int | None:
        """Whether tips have moved against each other that are on their holds; the one that clings beside its hold."""
        body, wandered = self._body, []
        for pair in self._pairs:
            a, b = pair
            one, other = body.tasks[a], body.tasks[b]
            if one.mode not in ("stance", "unloaded_contact") or other.mode not in ("stance", "unloaded_contact"):
                self._came.pop(pair, None)
                continue
            shift = angle - float(body.pose[2])
            between = np.concatenate(
                (
                    turned(body.tips[a] - body.tips[b], angle),
                    turned(body.settled_tips[a] - body.settled_tips[b], float(body.settled[2]) + shift),
                )
            )
            known = self._came.get(pair)
            if known is None or known[0] != (one.hold, other.hold):
                self._came[pair], self._lay[pair] = ((one.hold, other.hold), between), np.tile(between, (4, 1))
                continue
            self._look_at_silent(pair, between)
            moved = between - known[1]
            size = _size(moved)
            if size > self._wandered_off:
                wandered.append((pair, moved[:2], size))
        self._wandered = self._wandered + 1 if wandered else 0
        if self._wandered * LOOKED_AT > DRAGGED:
            beside = self._dragged_limb([pair for pair, _, _ in wandered])
            if beside is not None:
                self._dragged.add(beside)
                self._wandered = 0
                return beside
        if self._wandered * LOOKED_AT > WANDERING:
            self._tell_sensor(*wandered[0])
        return None

    def _look_at_silent(self, pair: tuple[int, int], between: Floats) -> None:
        """Whether the tips of a pair have moved against each other while a joint of theirs answered no torque."""
        lay = self._lay[pair]
        for row, c in enumerate(2 * i + k for i in pair for k in range(2)):
            if self._monitor.unchanged[c] < self._every:
                lay[row] = between
            elif self._monitor.silent[c] and _size(between - lay[row]) > self._silent:
                self._monitor.tell_silent(c)

    def _dragged_limb(self, pairs: Sequence[tuple[int, int]]) -> int | None:
        """The limb that carries nothing and has moved against all that hold, which have not moved against each other."""
        tasks = self._body.tasks
        holders = [i for i, task in enumerate(tasks) if task.mode == "stance"]
        for i, task in enumerate(tasks):
            alone = all(i in pair for pair in pairs)
            from_all = all((min(i, k), max(i, k)) in pairs for k in holders)
            if task.mode == "unloaded_contact" and len(holders) > 1 and alone and from_all and i not in self._dragged:
                return i
        return None

    def _tell_sensor(self, pair: Sequence[int], moved: Floats, size: float) -> None:
        """Which sensor alone would explain the most of it: of the joints of both limbs, and of the body."""
        body, (a, b) = self._body, pair
        arm = turned(body.tips[a] - body.tips[b], float(body.pose[2]))
        ways = [(2 * i + k, body.turned_by_joints(i)[:, k]) for i in pair for k in range(2)]
        ways.append((2 * body.n, np.array((-arm[1], arm[0]))))
        sensor = max(ways, key=lambda way: abs(float(way[1] @ moved)) / max(float(np.hypot(*way[1])), 1e-9))[0]
        self._monitor.bad.add(sensor)
        names = " and ".join(f"'{body.robot.limbs[i].name}'" for i in pair)
        why = f"sensor drifts, or a hook slides: the tips of {names} have moved {1e3 * size:.0f} mm against each other on their holds"
        self._monitor.fail("drift", self._monitor.channels[sensor].name, why)


def _size(moved: Floats) -> float:
    """How far a tip has moved at least, by the encoders or with the play counted, shape (4,) [m]."""
    return min(math.hypot(*moved[:2]), math.hypot(*moved[2:]))


def _direction(tips: Floats, pair: tuple[int, int]) -> float:
    """Of the line between two tips, body frame [rad]."""
    x, y = (tips[pair[0]] - tips[pair[1]]).tolist()
    return math.atan2(y, x)
