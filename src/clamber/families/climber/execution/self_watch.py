"""Faults of a climber that no single reading shows: motors that bear what weighs nothing, tips that wander, a body that turns unread."""

import math
from collections.abc import Sequence
from itertools import combinations
from typing import Final

import numpy as np

from ....compiled import Handle, ready
from ....execution.reading_monitor import Channel, ReadingMonitor
from ....types import Floats
from ....units import DEGREE
from ..control.felt_force import UNBALANCED, see_pairs
from ..robot.robot import LimbedRobot
from .body_schemes import turned
from .whole_body import WholeBody

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
        force: Sum of what the tips feel at a tick, world frame, shape (2,) [N]; not finite where they cannot tell.
    """

    def __init__(self, body: WholeBody, monitor: ReadingMonitor, force: Floats) -> None:
        self._body, self._monitor, self._force = body, monitor, force
        self._most = UNBALANCED * body.robot.weight
        self._patience, self._every = round(FOR / body.period), max(1, round(LOOKED_AT / body.period))
        longest = max(limb.length for limb in body.robot.limbs)
        self._silent, self._wandered_off = SILENT * longest, WANDERED * longest
        joints = monitor.channels[: 2 * body.n]
        self._limits = np.array([joint.limit for joint in joints])
        self._no_load = np.array([joint.fastest for joint in joints])
        self._pairs = np.array(list(combinations(range(body.n), 2)), np.int64).reshape(-1, 2)
        n = len(self._pairs)
        self._came_to, self._lined = np.zeros((n, 2), np.int64), np.zeros((n, 2), np.int64)
        """Holds of a pair on which its tips, and its line, are known; -1 where they are not."""
        self._came, self._lay, self._between = np.zeros((n, 4)), np.zeros((n, 4, 4)), np.zeros((n, 4))
        """How the tips of a pair lay to each other, by the encoders and with the play counted: when both had come to these holds, when the
        reading of each of its joints changed last since then, and now [m]."""
        self._turned = np.zeros(1)
        """Least that the body has turned by the line of a pair that holds it since its encoder changed last [rad]."""
        pairs = self._pairs, self._came_to, self._lined, np.zeros((n, 2)), self._came, self._lay, self._between
        looks = Handle(body.work, *pairs, self._turned, monitor.unchanged, self._every)
        self._see_pairs = ready(see_pairs, looks, 0.0, True, 0.0)
        self.reset()

    def reset(self) -> None:
        """Begin anew, as if all were well."""
        self._ticks = 0
        self._explained = np.zeros(2 * self._body.n, int)
        """Joint -> ticks on end in which it alone has explained what is felt too much."""
        self._wandered = 0
        self._dragged: set[int] = set()
        """Limbs told to have their hooks beside their holds."""
        self._came_to[:] = self._lined[:] = -1
        self._turning, self._angle, self._fresh, self._explains = 0, math.nan, True, False

    def see(self, angle: float, *, pushed: bool) -> int | None:
        """Take in a tick; index of the limb whose hook is beside its hold, and dragged along.

        Args:
            angle: Of the body by its encoder [rad].
            pushed: Whether the tips are `UNBALANCED`.

        Raises:
            FaultError: If a motor or a sensor has failed.
        """
        if pushed:
            self._look_at_motors()
        elif self._explains:
            self._explained[:], self._explains = 0, False
        if angle != self._angle:
            self._angle, self._fresh = angle, True
        self._ticks += 1
        if self._ticks % self._every:
            return None
        moved, self._fresh = self._see_pairs(angle, self._fresh, self._wandered_off), False
        self._look_at_body()
        if self._monitor.silent.any():
            self._look_at_silent()
        if not moved:
            self._wandered = 0
            return None
        return self._look_at_tips()

    def _look_at_motors(self) -> None:
        """Whether one motor explains that the tips are `UNBALANCED`, for long."""
        weight = self._body.robot.weight
        rest = self._force + np.array((0.0, weight))
        off = math.hypot(*rest.tolist())
        sure = self._monitor.clear > self._patience  # accelerations that were bridged are no forces
        if not (sure and off - self._unsure() > self._most and self._gives_what_is_asked()):
            self._explained[:] = 0
            return
        left = self._without_one(rest)
        self._explained, self._explains = np.where(left < EXPLAINED * weight, self._explained + 1, 0), True
        if self._explained.max() > self._patience:
            self._tell_motor(int(np.where(self._explained > self._patience, left, math.inf).argmin()), off)

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
        turned = float(self._turned[0])
        self._turning = self._turning + 1 if turned > TURNED else 0
        if self._turning * LOOKED_AT > TURNING:
            sensor = 2 * self._body.n
            self._monitor.bad.add(sensor)
            told = f"by its holding limbs the body has turned by {turned / DEGREE:.1f} deg"
            why = f"sensor stuck: its reading has not changed by a count, and {told}"
            self._monitor.fail("no answer", self._monitor.channels[sensor].name, why)

    def _look_at_tips(self) -> int | None:
        """Whether tips have moved against each other that are on their holds; the one that clings beside its hold."""
        wandered = []
        for pair, came_to, between, came in zip(
            self._pairs.tolist(), self._came_to.tolist(), self._between.tolist(), self._came.tolist(), strict=True
        ):
            moved = [now - then for now, then in zip(between, came, strict=True)]
            if came_to[0] >= 0 and _size(moved) > self._wandered_off:
                wandered.append((pair, np.array(moved[:2]), _size(moved)))
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

    def _look_at_silent(self) -> None:
        """Whether the tips of a pair have moved against each other while a joint of theirs answered no torque."""
        for pair, came_to, between, lay in zip(self._pairs, self._came_to, self._between, self._lay, strict=True):
            for row, c in enumerate(2 * i + k for i in pair for k in range(2)):
                if came_to[0] >= 0 and self._monitor.silent[c] and _size(between - lay[row]) > self._silent:
                    self._monitor.tell_silent(int(c))

    def _dragged_limb(self, pairs: Sequence[list[int]]) -> int | None:
        """The limb that carries nothing and has moved against all that hold, which have not moved against each other."""
        tasks = self._body.tasks
        holders = [i for i, task in enumerate(tasks) if task.mode == "stance"]
        for i, task in enumerate(tasks):
            alone = all(i in pair for pair in pairs)
            from_all = all([min(i, k), max(i, k)] in pairs for k in holders)
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


def _size(moved: Sequence[float] | Floats) -> float:
    """How far a tip has moved at least, by the encoders or with the play counted, shape (4,) [m]."""
    return min(math.hypot(*moved[:2]), math.hypot(*moved[2:]))
