"""A climber that carries out actions: one tick of sensing and commanding at a time, falls seen, holds corrected as hooks feel them."""

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np

from ....compiled import Handle, ready
from ....execution.plant import BodyPlant, BodySensed
from ....execution.posture_guard import JointHold
from ....execution.reading_monitor import ReadingMonitor
from ....execution.run_report import FallenError as FallenError
from ....execution.run_report import FaultError
from ....types import Floats, Ints
from ..control.felt_force import HANGING, LOST, PINNED, PUSHED, SLACK, STRAINED, UNHELD, see_signs
from ..robot.robot import LimbedRobot
from ..world.board import Board
from .approach import Approaches, rank
from .body_gains import USUAL_AGILITY, USUAL_SPEED, USUAL_WEIGHT, BodyGains
from .fall import FallWatch
from .hold_map import HoldMap, TipDifference
from .limb_task import LimbTask
from .postures import postures
from .self_watch import SelfWatch, channels_of
from .slip import SlipWatch
from .whole_body import WholeBody

PATIENCE: Final = 1.0
"""A body that is `BEHIND` its aim for so long is held there by what it cannot overcome [s]."""
GONE: Final = 0.1
"""Tips are off their holds, and jaws, that seem to be for so long [s]."""
RESTS: Final = (math.radians(1.5), 1.0)
"""A body that turns by no more than this for so long, a whole swing of one that hangs, rests [rad], [s]."""


class SlippedError(FallenError):
    """A limb's hook has come off its hold: a fall, unless others catch it. Not `surely`, what the limb feels is looked at once more."""

    def __init__(self, limb: int, reason: str, *, surely: bool = False) -> None:
        super().__init__(limb, reason)
        self.limb, self.reason, self.surely = limb, reason, surely

    def __str__(self) -> str:
        return self.reason


@dataclass(frozen=True, slots=True)
class Grabbed:
    """How a grab ended."""

    held: bool
    tries: int
    along: float
    """Where the hook stopped beyond the hold as it was believed, along the grab direction [m]."""
    across: float
    """[m]."""


class Climber:
    """A robot on a plant, with the map of holds that it believes in.

    Args:
        robot: The climber.
        board: Its holds, as the map says.
        plant: What moves.
        gains: Of body and limbs.
        map_error: Largest error of a hold's place in the map, each way along each axis [m]; what sensors and play add is reckoned apart.
        backlash: Whole play of a joint that is reckoned with at first [rad]; None: that of the robot's file.
        terrain: Covariance of the holds' places besides that error, see `HoldMap`.
        watched: Whether readings are tested before they are believed, and faults end the run; a bench looks itself.
    """

    def __init__(
        self,
        robot: LimbedRobot,
        board: Board,
        plant: BodyPlant,
        *,
        gains: BodyGains = BodyGains(),  # noqa: B008  # frozen
        map_error: float = 0.0,
        backlash: float | None = None,
        terrain: Floats | None = None,
        watched: bool = False,
    ) -> None:
        self.robot, self.plant, self.map_error = robot.at_weight(USUAL_WEIGHT), plant, map_error
        self.load = robot.weight / self.robot.weight
        """How many times larger the plant's forces and torques are than those that control works with."""
        robot = self.robot
        self.body = WholeBody(robot, period=plant.period, gains=gains, backlash=backlash)
        self.swiftness = min(map(robot.no_load_speed_of, robot.joints)) / USUAL_SPEED
        self.agility = min(robot.torque_limit_of(one) / one.inertia for one in robot.joints) / USUAL_AGILITY
        """Of its joints, over that of the robot on which control's speeds were chosen [-]."""
        self.fall, self.slip = FallWatch(self.body), SlipWatch(self.body)
        self.watched = watched
        self.monitor = ReadingMonitor(channels_of(robot), plant.period)
        self.watch = SelfWatch(self.body, self.monitor, self.fall.force)
        told = self.monitor.values, self.monitor.speeds, self.monitor.commands
        self._joints = [each[: 2 * self.body.n].reshape(-1, 2) for each in told]
        self.holds = {hold.number: np.array((hold.x, hold.y)) for hold in board.holds}
        self.map = HoldMap(self.holds, map_error, backlash=self.body.backlash, terrain=terrain)
        self.peg_radius = max(hold.radius for hold in board.holds)
        self.approaches = Approaches(robot, self.body.legs)
        self.balance: Callable[[], None] | None = None
        """Told at every tick between sensing and commanding, while the body hangs on one limb."""
        n = len(robot.limbs)
        self.grips: Ints = np.zeros(n, np.int32)
        """1 for grippers that are to be shut, shape (limbs,); other ends don't care."""
        self.gripped: Ints = np.zeros(n, np.int32)
        """1 for grippers that are closed about something, as last sensed, shape (limbs,)."""
        jawed = np.array([limb.end.kind == "gripper" for limb in robot.limbs], np.int32)
        free = self.monitor.free[: 2 * n].reshape(-1, 2)
        self._see_signs = ready(see_signs, Handle(self.body.work, self.fall.force, jawed, self.gripped, free))
        self.ticks = 0
        self.latest = -1
        """Index of the limb that took its hold last."""
        self.proven = True
        """Whether it has carried there."""
        self._strained = self._slipped = self._pinned = 0

    @property
    def time(self) -> float:
        """Since the start [s]."""
        return self.ticks * self.plant.period

    def start(
        self, pose: Floats, holds: Mapping[str, int], *, idle: str | None = None, elbows: Mapping[str, int]
    ) -> None:
        """Put the robot on its holds, at rest.

        Args:
            pose: Body x, y [m], theta [rad].
            holds: Limb -> number of its hold; others are left out.
            idle: The limb on a hold that carries nothing.
            elbows: Limb -> side of its elbow, +1 or -1; others take the hook most on top.
        """
        q = np.zeros((self.body.n, 2))
        for i, limb in enumerate(self.robot.limbs):
            number = holds.get(limb.name, 0)
            task = LimbTask("swing_joint")
            if number:
                place = self.holds[number]
                q[i] = rank(postures(limb, pose, place), elbows.get(limb.name, 0))[0].angles
                task = LimbTask("unloaded_contact" if limb.name == idle else "stance", number, place.copy())
            task.angles = q[i].copy()
            self.grips[i] = number > 0
            self.body.assign(i, task)
        self.body.hand_over([i for i, task in enumerate(self.body.tasks) if task.mode == "stance"])
        self.plant.reset(pose, q)
        self.body.pose[:], self.body.settled[:], self.body.aim[:] = pose, pose, pose
        self.body.aim_speed[:] = 0.0
        self.body.see(q, np.zeros_like(q), pose[2], 0.0)  # a motion may begin before the first tick
        self.balance = None
        self.ticks = self._strained = self._slipped = self._pinned = 0
        self.fall.reset()
        self.slip.reset()
        self.monitor.reset()
        self.watch.reset()

    def tick(self) -> None:
        """Sense, command, step.

        Raises:
            SlippedError: If a hook has come off.
            FallenError: If no limb holds, nothing carries the robot, a gripper has slipped, or the body is far or turned from its aim.
            FaultError: If a sensor, a motor or the link to the plant has failed.
        """
        sensed = self.plant.sense()
        self._believe(sensed)
        if self.balance is not None:
            self.balance()
        self.gripped[:] = sensed.gripped
        falls, lost, signs = self.fall.see(), self.slip.see(self.fall.forces), self._see_signs()
        self.body.command()
        self.drive()
        self.plant.step()
        self.ticks += 1
        if signs & UNHELD:
            raise FallenError("no limb holds the body")
        if falls:
            raise FallenError(
                f"nothing carries the robot: all tips together feel {self.load * self.fall.carried:.0f} N"
            )
        if lost is not None:
            name, hold = self.robot.limbs[lost].name, self.body.tasks[lost].hold
            raise SlippedError(
                lost, f"the hook of '{name}' has come off hold {hold}: it moved {1e3 * self.slip.moved:.0f} mm"
            )
        if signs & ~PUSHED:
            self._heed(signs)
        else:
            self._strained = self._slipped = self._pinned = 0
        if self.watched:
            beside = self.watch.see(self.monitor.values.item(-1), pushed=bool(signs & PUSHED))
            if beside is not None:
                name, hold = self.robot.limbs[beside].name, self.body.tasks[beside].hold
                raise SlippedError(
                    beside, f"the hook of '{name}' is beside hold {hold}, and dragged along", surely=True
                )

    def drive(self) -> None:
        """Have the plant give the torques of this tick."""
        self.plant.actuate(self.load * self.body.torques, self.grips)

    def _heed(self, signs: int) -> None:
        """Count for how long there have been signs that end the climb.

        Raises:
            FallenError: If that is too long.
        """
        body, period = self.body, self.plant.period
        # A hook that comes off slowly is not seen to move, but two tips can then not both be on their holds
        self._strained = self._strained + 1 if signs & STRAINED else 0
        if self._strained * period > GONE:
            strain = body.strain(self.holding()[0], self.holding()[-1])
            raise FallenError(
                f"a hook has come off: two holding tips are {1e3 * strain:.0f} mm off their holds' distance"
            )
        if signs & HANGING:
            body.aim[:] = body.pose  # it swings where it will
        self._slipped = self._slipped + 1 if signs & SLACK else 0
        if self._slipped * period > GONE:
            ends = zip(self.robot.limbs, body.tasks, self.gripped, strict=True)
            slack = [
                limb for limb, task, grips in ends if limb.end.kind == "gripper" and task.mode == "stance" and not grips
            ]
            raise FallenError(f"the gripper of '{slack[0].name}' has slipped off its hold")
        off, turned = math.dist(body.aim[:2], body.pose[:2]), abs(float(body.pose[2] - body.aim[2]))
        self._pinned = self._pinned + 1 if signs & PINNED else 0
        if self._pinned * period > PATIENCE:
            raise FallenError(f"the body stays {1e3 * off:.0f} mm off its aim")
        if signs & LOST:
            raise FallenError(f"the body is {1e3 * off:.0f} mm off its aim and turned by {np.degrees(turned):.0f} deg")

    def _believe(self, sensed: BodySensed) -> None:
        """Let the body see what is to be believed of a tick's readings.

        Raises:
            FaultError: If a sensor, a joint or the link has failed.
        """
        if not self.watched:
            self.body.see(sensed.q, sensed.qd, sensed.angle - self.map.offset, sensed.angle_speed)
            return
        values, speeds, (q, qd, commands) = self.monitor.values, self.monitor.speeds, self._joints
        q[:], qd[:], commands[:] = sensed.q, sensed.qd, self.body.torques
        values[-1], speeds[-1] = sensed.angle, sensed.angle_speed
        self.monitor.see(sensed.number)
        self.body.see(q, qd, values.item(-1) - self.map.offset, speeds.item(-1))

    def brace(self, seconds: float) -> None:
        """After a fault: hold every joint where it is, those that have failed by the torque that they had; grippers stay as they are."""
        monitor, body, n = self.monitor, self.body, 2 * self.body.n
        monitor.closed = True
        law = JointHold(np.array([joint.inertia for joint in self.robot.joints]))
        failed = [k for k in monitor.bad if k < n]
        posture, fed = body.q.ravel().copy(), monitor.usual_commands[:n].copy()
        for _ in range(round(seconds / self.plant.period)):
            try:
                self._believe(self.plant.sense())
            except FaultError:  # told already, and bridged
                body.q[:], body.qd[:] = self._joints[:2]
            torques = law.torques(posture, fed, body.q.ravel(), body.qd.ravel())
            torques[failed] = fed[failed]
            body.torques[:] = torques.reshape(-1, 2)
            self.brace_tick()

    def brace_tick(self) -> None:
        """One tick of it: a plant whose link has failed is left to hold by itself."""
        if self.monitor.linked:
            self.drive()
        self.plant.step()
        self.ticks += 1

    @property
    def hangs(self) -> bool:
        """Whether one limb holds the body, which swings as it will."""
        return "hang" in [task.mode for task in self.body.tasks]

    def wait(self, seconds: float) -> None:
        """Let time pass [s]."""
        for _ in range(round(seconds / self.plant.period)):
            self.tick()

    def rest(self, patience: float) -> bool:
        """Let time pass until the body has hardly turned for a while, at most so long [s]; whether it rests."""
        quiet, mark = 0.0, float(self.body.pose[2])  # its speed is that of an encoder's counts, too rough to tell
        for _ in range(round(patience / self.plant.period)):
            self.tick()
            angle = float(self.body.pose[2])
            turned = abs(angle - mark) > RESTS[0]
            quiet, mark = (0.0, angle) if turned else (quiet + self.plant.period, mark)
            if quiet > RESTS[1]:
                return True
        return False

    def carry_with_all(self, but: int) -> None:
        """Let every limb on a hold carry, but one that is about to leave; the load passes while all are still on their holds."""
        if self.hangs:
            return
        self.body.hand_over([i for i, task in enumerate(self.body.tasks) if i != but and task.hold])
        while self.body.handing_over:
            self.tick()

    def discs(self, without: int = 0) -> Floats:
        """Holds but one as discs x, y, radius with what the map is in doubt by, world frame, shape (n, 3) [m]."""
        found = [
            (*place, self.peg_radius + self.map.error(number))
            for number, place in self.holds.items()
            if number != without
        ]
        return np.array(found).reshape(-1, 3)

    def doubt(self, number: int, i: int) -> float:
        """How far off limb `i`'s tip may seem to be along each axis when it is on a hold, by what is known of the map and sensors [m]."""
        return max(self.map.doubt(number, self.body.tasks[j].hold, self.seen(i, j)) for j in self.holding() if j != i)

    def holding(self) -> list[int]:
        """Indices of the limbs that carry the body."""
        return [i for i, task in enumerate(self.body.tasks) if task.holds]

    def learn(self, number: int, i: int, others: Iterable[int]) -> None:
        """Correct the map and what is believed of the sensors: limb `i` is on a hold, and so are others, all of them loaded.

        Args:
            number: Of the hold of limb `i`.
            i: Index of that limb.
            others: Indices of limbs whose tips are on the holds of their tasks.
        """
        body, tasks = self.body, self.body.tasks
        for j in others:
            more = self.map.learn(number, tasks[j].hold, self.seen(i, j))
            half = 0.5 * body.backlash
            for limb, angles in zip((i, j), more.reshape(2, 2), strict=True):
                body.play[limb] = np.clip(body.play[limb] - angles, -half, half)
        body.reckon_with(2.0 * self.map.half_play)
        for task in tasks:
            if task.hold:
                task.place = self.holds[task.hold].copy()

    def learn_again(self) -> None:
        """Correct the map by the limbs that hold: their joints are loaded, and hooks that were not quite home have slid in."""
        holding = sorted(self.holding(), key=lambda i: i != self.latest)
        if len(holding) == 2:
            self.learn(self.body.tasks[holding[0]].hold, holding[0], holding[1:])

    def learn_start(self) -> None:
        """Correct the map by all limbs that are on holds: at the start they are at rest, on holds that may be as far off as any."""
        on = sorted(
            (i for i, task in enumerate(self.body.tasks) if task.hold), key=lambda i: not self.body.tasks[i].holds
        )
        for k, i in enumerate(on[1:], 1):
            self.learn(self.body.tasks[i].hold, i, on[:k])

    def seen(self, i: int, j: int) -> TipDifference:
        """Where the tip of limb `i` is from that of limb `j`."""
        place = self.body.tip(i) - self.body.tip(j)
        by_joints = np.hstack([self.body.turned_by_joints(i), -self.body.turned_by_joints(j)])
        sides = np.concatenate([self._sides(i), self._sides(j)])
        loose = 0.5 * self.body.backlash * (1.0 - self.body.sure[[i, j]].ravel())
        return TipDifference(place, np.array((place[1], -place[0])), -by_joints @ sides, by_joints, loose)

    def _sides(self, i: int) -> Floats:
        """Which side of its play each joint of a limb rests on, -1 to 1, shape (2,)."""
        half = 0.5 * self.body.backlash
        return self.body.play[i] / half if half > 0.0 else np.ones(2)
