"""The tool held at a point of the world, or led along a line, while the robot walks past it.

Where on the way that can be, and the arm's aims at every tick.

The arm takes back what the plate does, as the robot reckons it: slides, lifts, levelling, feet that sink in. The tool may also have the
plate's height, in the phases that leave it free (`free_base_freedoms.py`); the rest of the body belongs to the walk.
"""

import math
from dataclasses import dataclass
from typing import Final, Literal

import numpy as np

from ....control.quintic import quintic_share
from ....json_form import Jsonable
from ....types import Floats
from ..control.cooperative.closest import ReachSearch
from ..control.cooperative.cooperator import Cooperator
from ..control.cooperative.freedoms import HEIGHT, weights_of
from ..control.cooperative.holding import TOOL_SPEED, RedundancyAllocation, ToolHolder, reachable_part
from ..control.cooperative.planted_feet import PlantedFeet
from ..control.cooperative.settings import Cooperation, own_speeds
from ..control.cooperative.tool_chain import POSE
from ..control.track import Track
from ..robot import WalkerRobot
from . import motions
from .arm_swing import check_swing
from .free_base_freedoms import ARRIVED
from .predicted_heights import Heights, predict_heights
from .walker import GENTLY as GENTLY_UP
from .walker import RefusedError, Walker


@dataclass(frozen=True, slots=True, eq=False)
class ToolLine:
    """Straight pieces, evenly with the plate's way: the tool waits while the plate stands, and slides along with it."""

    points: Floats
    """World, shape (n, 3) [m]."""
    first: float
    """Way of the plate at which the tool is at the first of them [m] ..."""
    last: float
    """... and at the last."""

    def at(self, way: float) -> Floats:
        """Where the tool is to be when the plate has come so far [m], shape (3,) [m]."""
        whole = self.last - self.first
        return along(self.points, min(1.0, max(0.0, (way - self.first) / whole)) if whole > 0.0 else 0.0)


def along(points: Floats, share: float) -> Floats:
    """The place at a share of the length of straight pieces through points, shape (3,) [m]."""
    ends = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    return np.array([np.interp(share * ends[-1], ends, column) for column in points.T])


Served = Literal["arm", "height"]
"""What the tool has: the arm alone, or the height of the plate too, while frames slide."""

GRID: Final = 0.02
"""Poses of the way that are looked at lie so far apart [m]; the ends of the part that can be held are bisected between them."""
FINE: Final = 0.001
"""To which the way's nearest place to the point is found [m]."""
EDGE: Final = 0.03
"""The tool comes so far inside where the arm can just reach, and leaves as early [m]: lifting moves the plate by a centimetre or two."""
STEP: Final = 0.2
"""The plate's longest step [m]."""
CHANGE: Final = 0.008
"""By how much a lift may take the plate higher or lower for the tool [m]: the legs are slow, and it is to rest before feet land."""
SHARES: Final = (0.25, 0.5, 0.75, 1.0)
"""Of the arm's way to where it goes, at which balance is looked at [-]."""
GENTLY: Final = 0.5
"""Share of its joints' speed at which the arm comes and leaves [-]."""
PEAK: Final = 1.875
"""Largest speed of a quintic motion from rest to rest, over its mean [-]."""
GAIN: Final = 0.5
"""Of the manipulability's gradient: the joint that the tool leaves free goes where the arm moves best [-]."""


@dataclass(frozen=True, slots=True)
class HeldPart(Jsonable):
    """Where the tool was to be held, and what became of it as the robot believes."""

    points: tuple[tuple[float, float, float], ...]
    """Where the tool was to be, world, as believed [m]: a point, or what it was to go through."""
    first: float
    """Way of the Delta-frame from which on the tool is held [m]."""
    last: float
    """Until where [m]."""
    reach: tuple[tuple[float, float], ...]
    """Parts of the way, of what was asked for, where the arm can reach the point [m]."""
    began: float | None
    """When it was there [s]; None: the walk did not come so far."""
    ended: float | None
    """When it left [s]; None: it was held to the end of the walk."""
    missed: float
    """Farthest that the commanded tool was from the point by the believed pose [m]."""
    room: float
    """Least distance of a joint from an end of its range [rad]."""
    speed: float
    """Largest share of its speed that a joint had [-]."""
    measures: tuple[float, float]
    """Least and mean manipulability of the arm while it was held, the arm's freedoms alone [-]; 0 if it never was."""
    raised: tuple[float, float]
    """Least and most that the tool had the plate higher than walking would have it [m]."""

    @property
    def way(self) -> float:
        """Over which the tool was to be held [m]."""
        return self.last - self.first


class ToolHold:
    """Moves the arm so that the tool comes to a point, stays there, and leaves it; a walker's `arm_task`.

    Args:
        walker: The robot, standing as it will walk.
        track: Where its Delta-frame goes.
        points: World, as the robot believes [m], shape (n, 3): one to stay at, or those that the tool goes through; (3,) is one.
        within: It is held from so far before the way's nearest place to it, or to the middle of the tool's line, until so far behind [m].
        served: By what.

    Raises:
        RefusedError: If the arm reaches it nowhere there; the margin is what is missing.
    """

    def __init__(self, walker: Walker, track: Track, points: Floats, within: float, served: Served = "arm") -> None:
        robot = walker.robot
        self._arm = robot.own_arm
        self._rest = walker.arm.copy()
        self._ways = _spread(0.0, track.length, GRID)
        self._heights = predict_heights(walker, track, self._rest) if served == "height" else None
        self._poses, _ = _plate_poses(walker, track, self._ways, self._heights)
        self._at = 0
        points = np.atleast_2d(np.asarray(points, float))
        asked = self._asked(track, along(points, 0.5), within)
        self.line = ToolLine(points, float(asked[0]), float(asked[-1]))
        self.reach, raises = self._find_reach(robot, asked, *_plate_poses(walker, track, asked, self._heights))
        self.first, self.last = self._choose_part(asked)
        self._wish = float(np.interp(self.first, asked, raises))
        speeds = own_speeds(robot)
        settings = Cooperation(speeds=speeds, tool_speeds=np.full(3, TOOL_SPEED), gain=GAIN, period=walker.period)
        footing = PlantedFeet(robot=robot, support="y", pose=self._poses[0])
        self._law = Cooperator(robot, settings, footing, "arm")
        self._weights = weights_of("arm", self._arm.n_joints)
        self._holder: ToolHolder | None = None
        self._way = 0.0
        self._joints = self._joints_at(walker)
        self._lead = self._seconds(self._rest, self._joints) * float(np.hypot(*speeds[:2]))
        self._state: Literal["away", "coming", "there", "holding", "leaving"] = "away"
        self._set_out_at, self._from = 0.0, self._rest
        self._times: list[float] = []
        self._targets: list[tuple[float, Floats]] = []
        self._missed, self._room, self._speed = 0.0, math.inf, 0.0
        self._measures: list[float] = []
        self._raised: list[float] = []
        self._lent = None
        if self._heights is not None:
            self._lent = RedundancyAllocation(
                robot, payload=walker.payload, gain=GAIN, balance=walker.settings.limits.balance,
                rise=GENTLY_UP * robot.legs.speed, period=walker.period,
            )  # fmt: skip

    def start(self, walker: Walker) -> None:
        """Take the arm over; where the way begins so near, the tool comes to the point before the robot goes on.

        Raises:
            RefusedError: If the arm would tip the robot there, with what it carries; the margin is what is missing.
            FallenError: If the robot falls.
        """
        if self.way_of(walker.pose) >= self.first - self._lead:
            check_swing(walker, walker.arm, self._joints, "swung to the point to hold")
        walker.arm_task = self
        if self._nears(walker):
            motions.raise_plate(walker, self._wish)
            while abs(walker.height - walker.wanted[0]) > ARRIVED:
                walker.tick()
        while self.way_of(walker.pose) >= self.first - self._lead and self._state in ("away", "coming"):
            walker.tick()

    def aims(self, walker: Walker) -> Floats:
        """Where the arm's joints go by the end of the coming period, shape (joints,) [rad]."""
        way, now = self.way_of(walker.pose), walker.time
        self._way = way
        if self._state == "away" and way >= self.first - self._lead:
            self._joints = self._joints_at(walker)
            self._set_out("coming", walker)
        if self._state == "coming":
            aims, there = self._between(self._joints, now)
            if there:
                self._state = "there"
                self._holder = ToolHolder(self._law, np.concatenate([self._at_first(walker), aims]))
            return aims
        if self._state == "there":
            if way < self.first:
                return self._step(self._at_first(walker), self.line.at(self.first))
            self._state = "holding"
            self._times.append(now)
        if self._state == "holding":
            if way <= self.last:
                return self._hold(walker, way)
            self._times.append(now)
            self._set_out("leaving", walker)
        if self._state == "leaving":
            return self._between(self._rest, now)[0]
        return self._rest

    def ahead(self, walker: Walker) -> list[Floats]:
        """See `ArmTask`; while the tool is held the plate goes on under it, which shifts less mass than the step reckons with."""
        way, goal = self.way_of(walker.pose), None
        if self._state == "away" and way >= self.first - self._lead - STEP:
            goal = self._joints_at(walker)
        elif self._state in ("coming", "there"):
            goal = self._joints
        elif self._state == "leaving" or (self._state == "holding" and way >= self.last - STEP):
            goal = self._rest
        return [] if goal is None else [walker.arm + share * (goal - walker.arm) for share in SHARES]

    def raise_wished(self, walker: Walker) -> float:
        """See `ArmTask`: as it is while the tool is held; on the way there up to where that begins, and down again, step by step."""
        now = walker.room.raised
        if self._state == "holding":
            return now
        goal = self._wish if self._state != "leaving" and self._nears(walker) else 0.0
        return now + min(CHANGE, max(-CHANGE, goal - now))

    def _nears(self, walker: Walker) -> bool:
        """Whether the plate has no more way left than it takes to come up step by step."""
        steps = abs(self._wish) / (2.0 * CHANGE) + 1.0  # each frame is lifted once while the plate goes on by one step
        return self.way_of(walker.pose) >= self.first - self._lead - steps * STEP

    def way_of(self, pose: Floats) -> float:
        """How far on the way the plate is [m]; it never goes back."""
        k = self._at
        while k + 1 < len(self._ways) and self._off(k + 1, pose) <= self._off(k, pose):
            k += 1
        self._at = k
        a, b = self._poses[max(0, k - 1)], self._poses[min(len(self._poses) - 1, k + 1)]
        forward = (b - a)[:2]
        length = float(np.hypot(*forward))
        along = float(forward @ (pose - self._poses[k])[:2]) / length if length > 1e-9 else 0.0
        return float(self._ways[k]) + min(GRID, max(-GRID, along))

    def told(self) -> HeldPart:
        """What became of it so far."""
        began, ended = (*self._times, None, None)[:2]
        points = tuple((float(x), float(y), float(z)) for x, y, z in self.line.points)
        measures = (min(self._measures), float(np.mean(self._measures))) if self._measures else (0.0, 0.0)
        raised = (min(self._raised), max(self._raised)) if self._raised else (0.0, 0.0)
        return HeldPart(
            points, self.first, self.last, self.reach, began, ended, self._missed, self._room, self._speed, measures,
            raised,
        )  # fmt: skip

    def wanted(self) -> tuple[Floats, Floats]:
        """Times while it was held [s], shape (ticks,), and where the tool was to be a period later, as believed, shape (ticks, 3) [m]."""
        times = np.array([time for time, _ in self._targets])
        return times, np.array([place for _, place in self._targets]).reshape(-1, 3)

    def _hold(self, walker: Walker, way: float) -> Floats:
        target = self.line.at(way)
        self._targets.append((walker.time, target))
        aims = self._step_with_plate(walker, target) if walker.room.weights.any() else self._step(walker.pose, target)
        self._measures.append(self._law.measure(np.concatenate([walker.pose, aims]), self._weights))
        self._raised.append(walker.room.raised)
        off = float(np.linalg.norm(self._law.place(np.concatenate([walker.pose, aims])) - target))
        low, high = np.array(self._arm.lowest), np.array(self._arm.highest)
        share = np.abs(aims - walker.arm) / (walker.period * np.array(self._arm.fastest))
        self._missed = max(self._missed, off)
        self._room = min(self._room, float(np.minimum(aims - low, high - aims).min()))
        self._speed = max(self._speed, float(share.max()))
        return aims

    def _step(self, pose: Floats, target: Floats) -> Floats:
        assert self._holder is not None, "the arm is there before it holds"
        joints: Floats = self._holder.step(pose, target, self._weights).q[POSE:]
        return joints

    def _step_with_plate(self, walker: Walker, target: Floats) -> Floats:
        if self._lent is None:
            return self._step(walker.pose, target)
        assert self._holder is not None, "the arm is there before it holds"
        q, weights, room = np.concatenate([walker.pose, self._holder.q[POSE:]]), self._weights.copy(), walker.room
        weights[:POSE] = room.weights
        delta, y = (bool(walker.stands[legs].all()) for legs in (slice(0, 3), slice(3, 6)))
        self._lent.stand(
            q, "both" if delta and y else "delta" if delta else "y", walker.place, walker.heights.reshape(2, 3),
            (room.lowest, room.highest),
        )  # fmt: skip
        self._holder.q = self._lent.law.hold(q, target, weights).q
        motions.raise_plate(walker, float(self._holder.q[HEIGHT] - q[HEIGHT]))
        joints: Floats = self._holder.q[POSE:]
        return joints

    def _at_first(self, walker: Walker) -> Floats:
        """The plate as it is now, but where the tool is first held: what lifting and levelling do to it counts before it is there."""
        pose = walker.pose.copy()
        there = np.array([np.interp(self.first, self._ways, column) for column in self._poses.T])
        here = np.array([np.interp(self._way, self._ways, column) for column in self._poses.T])
        pose[:4] += (there - here)[:4]
        return pose

    def _set_out(self, state: Literal["coming", "leaving"], walker: Walker) -> None:
        self._state, self._set_out_at, self._from = state, walker.time, walker.arm.copy()

    def _between(self, goal: Floats, now: float) -> tuple[Floats, bool]:
        """A quintic motion in the joints, and whether it is over."""
        u = min(1.0, (now - self._set_out_at) / max(1e-9, self._seconds(self._from, goal)))
        return self._from + quintic_share(u) * (goal - self._from), u >= 1.0

    def _seconds(self, a: Floats, b: Floats) -> float:
        return PEAK * float((np.abs(b - a) / np.array(self._arm.fastest)).max()) / GENTLY

    def _off(self, k: int, pose: Floats) -> float:
        return float(np.hypot(*(pose - self._poses[k])[:2])) + abs(float(pose[3] - self._poses[k, 3])) * GRID

    def _asked(self, track: Track, point: Floats, within: float) -> Floats:
        """Ways between which the tool is to be held, as far as the track goes [m]."""
        ways = _spread(0.0, track.length, FINE)
        away = [float(np.hypot(*(track.pose(float(way))[:2] - point[:2]))) for way in ways]
        nearest = float(ways[int(np.argmin(away))])
        return _spread(max(0.0, nearest - within), min(track.length, nearest + within), GRID)

    def _find_reach(
        self, robot: WalkerRobot, ways: Floats, poses: Floats, rooms: Floats | None
    ) -> tuple[tuple[tuple[float, float], ...], Floats]:
        """Parts of the way [m], and by how much the plate is to be raised for it at each of `ways` [m]."""
        found = reachable_part(robot, poses, np.array([self.line.at(float(way)) for way in ways]), rooms)
        if not found.parts:
            short = float(found.distances.min())
            raise RefusedError(
                f"the arm reaches the point to hold nowhere from way {ways[0]:.2f} m to {ways[-1]:.2f} m: "
                f"{1e3 * short:.0f} mm are missing where it comes nearest",
                -short,
            )
        at = np.arange(len(ways), dtype=np.float64)
        parts = tuple((float(np.interp(a, at, ways)), float(np.interp(b, at, ways))) for a, b in found.parts)
        return parts, found.heights - poses[:, HEIGHT]

    def _choose_part(self, asked: Floats) -> tuple[float, float]:
        """The longest one; where it ends with the arm's reach, from `EDGE` inside."""
        first, last = max(self.reach, key=lambda part: part[1] - part[0])
        inside = min(EDGE, 0.5 * (last - first))
        return first + inside * (first > asked[0]), last - inside * (last < asked[-1])

    def _joints_at(self, walker: Walker) -> Floats:
        """Joints that bring the tool to the point from where it is first held, near those at rest."""
        pose, rest = self._at_first(walker), self._rest.copy()
        pose[HEIGHT] += self._wish - walker.room.raised
        point = self.line.at(self.first)
        x, y = point[:2] - pose[:2]
        low, high = self._arm.lowest[0], self._arm.highest[0]
        rest[0] = min(high, max(low, math.remainder(math.atan2(y, x) - pose[3], math.tau)))
        footing = PlantedFeet(robot=walker.robot, support="y", pose=pose)
        search = ReachSearch(walker.robot, footing, self._weights, kept="arm")
        return search.find(np.concatenate([pose, rest]), point).q[POSE:]


def _spread(first: float, last: float, gap: float) -> Floats:
    """Evenly from first to last, both included, at most `gap` apart [m]."""
    return np.linspace(first, last, max(2, math.ceil((last - first) / gap - 1e-9) + 1))


def _plate_poses(walker: Walker, track: Track, ways: Floats, heights: Heights | None) -> tuple[Floats, Floats | None]:
    """The plate along a track, shape (ways, 6), and the room of its height, shape (ways, 2) [m].

    Without heights it is as high over the ground as now, and that goes on as under its feet.
    """
    flat = np.array([track.pose(float(way)) for way in ways])
    poses = np.tile(walker.pose, (len(ways), 1))
    poses[:, :2], poses[:, 3] = flat[:, :2], flat[:, 2]
    if heights is None:
        poses[:, 2] += (flat[:, :2] - walker.pose[:2]) @ walker.ground_slope()
        return poses, None
    rooms = heights.at(ways)
    poses[:, 2] = rooms[:, 1]
    return poses, rooms[:, [0, 2]]
