"""The climber's controller: what each limb is doing, where the body is to be, and the torques of one tick."""

import math
from collections.abc import Collection
from dataclasses import dataclass, field
from typing import Final, Literal, TypeAlias

import numpy as np
import numpy.typing as npt

from ...control.body import (
    KINEMATIC,
    LIMIT_COUNTED,
    LIMIT_FEASIBLE,
    LIMIT_NONE,
    LIMIT_SHARED,
    LIMIT_THESIS,
    THESIS,
    WRENCH,
    command_tips,
    drag_tips,
)
from ...control.body_estimate import estimate_body
from ...control.chain import chain_of_limb
from ...control.controller import Controller, still_aim
from ...control.hook_forces import MOST_CUTS, pair_forces
from ...control.law_settings import LawSettings
from ...control.play import follow_play, pull_torques, weight_loads, weight_moment
from ...robots.limbed import LimbedRobot
from ...types import Floats
from .legs import legs_of
from .postures import postures

Doing: TypeAlias = Literal["hold", "hang", "cling", "tip", "joints", "pull"]
"""A limb holds the body, holds it alone while it swings as it will, clings to its hold without carrying, brings its tip or its joints
somewhere, or pulls along a direction."""
MAPPINGS: Final = {"thesis": THESIS, "kinematic": KINEMATIC, "wrench": WRENCH}
PLAY_TIME: Final = 0.2
"""Time in which the believed side of the play follows the load [s]."""
LOAD_TIME: Final = 0.15
"""Time over which the load of a limb that pulls is evened out: a dither's own load moves no joint through its play [s]."""
CLING_DAMPING: Final = 60.0
"""Of the tip of a limb that clings [N s/m]."""
CLING_STIFFNESS: Final = 1500.0
"""Towards its hold from where it is more than `CLING_SLACK` off, so that friction does not leave it behind a moving body [N/m]."""
CLING_SLACK: Final = 0.003
"""What a map and the play of joints make of a tip that is on its hold [m]."""
CLING_MOST: Final = 15.0
"""Of that pull [N]."""
LIMITS: Final = {
    "none": LIMIT_NONE,
    "thesis": LIMIT_THESIS,
    "counted": LIMIT_COUNTED,
    "shared": LIMIT_SHARED,
    "feasible": LIMIT_FEASIBLE,
}
STRETCHED: Final = math.radians(15.0)
"""An elbow nearer to straight than this is soft and may pass to the other side [rad]."""
HANDING_OVER: Final = 0.5
"""Time in which the load passes from the limbs that carried to those that will [s]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class BodyGains:
    """Gains of body and limbs."""

    kp: tuple[float, float, float] = (100.0, 50.0, 10.0)
    """Of the maps "thesis" and "kinematic"; those of the thesis's Table 4.1."""
    kd: tuple[float, float, float] = (10.0, 5.0, 1.0)
    """Twice the table's: with delay and backlash its own let the body swing (ours). The map "wrench" takes that of x for all."""
    stiffness: tuple[float, float, float] = (3000.0, 3000.0, 200.0)
    """Of the map "wrench" [N/m], [N m/rad]; ours."""
    limb_kp: float = 500.0
    limb_kd: float = 25.0
    joint_kp: float = 400.0
    joint_kd: float = 20.0
    cling: float = 3.0
    """Pull with which a limb that carries nothing keeps to its hold [N]."""
    gentle: float = 3.0
    """Most torque of a limb near a hold, so that what it meets is not thrown off [N m]."""
    firm: float = 8.0
    """Likewise of a limb that tugs at its hold: enough to carry half the weight at arm's length [N m]."""
    least_pull: float = 0.3
    """alpha of the hook limit."""
    weight_fed: float = 0.95
    """Part of the weight that is fed forward."""
    mapping: str = "wrench"
    limit: str = "feasible"
    law: str = "scct"


@dataclass(slots=True)
class LimbTask:
    """What one limb is doing now."""

    doing: Doing
    hold: int = 0
    """Number of its hold; 0: none."""
    place: Floats = field(default_factory=lambda: np.zeros(2))
    """Of "hold": the hold, of "tip": the aim, world frame [m]."""
    speed: Floats = field(default_factory=lambda: np.zeros(2))
    """Of the aim [m/s]."""
    angles: Floats = field(default_factory=lambda: np.zeros(2))
    """Of "joints" and "hang" [rad]."""
    rates: Floats = field(default_factory=lambda: np.zeros(2))
    loads: Floats = field(default_factory=lambda: np.zeros(2))
    """Of "hang": torques that bear the weight [N m]."""
    force: Floats = field(default_factory=lambda: np.zeros(2))
    """Of "pull": what the tip does to what it meets, world frame [N]."""
    tug: Floats = field(default_factory=lambda: np.zeros(2))
    """Of "pull": the steady part of that force which the body leans on; the limbs that hold carry that much less [N]."""
    damping: float = 150.0
    """Of "pull": of the tip's motion in the world [N s/m]."""
    pressed: bool = False
    """Of "pull": whether the tip has stopped against something, which then loads the joints."""

    @property
    def holds(self) -> bool:
        """Whether the limb carries the body."""
        return self.doing in ("hold", "hang")


class WholeBody:
    """Torques of all limbs from the sensors, the body's aim and each limb's task.

    Args:
        robot: The climber.
        period: Of the control [s].
        gains: Of body and limbs.
        backlash: Whole play of a joint that is reckoned with [rad]; None: that of the robot's file.
    """

    def __init__(
        self,
        robot: LimbedRobot,
        *,
        period: float,
        gains: BodyGains = BodyGains(),  # frozen
        backlash: float | None = None,
    ) -> None:
        self.robot, self.gains, self.period = robot, gains, period
        self.backlash = robot.motor.backlash if backlash is None else backlash
        n = len(robot.limbs)
        self.n = n
        self.chains = [chain_of_limb(robot, limb.name) for limb in robot.limbs]
        self.legs = legs_of(robot)
        unit = LawSettings(law=gains.law, kp=1.0, kd=0.0, joint_kd=1.0, feed_gravity=False)
        free = LawSettings(law=gains.law, kp=gains.limb_kp, kd=gains.limb_kd, feed_gravity=False)
        self._pullers = [Controller(chain, unit, period=period) for chain in self.chains]
        self._reachers = [Controller(chain, free, period=period) for chain in self.chains]
        self._aim = still_aim((0.0, 0.0))
        self._states = np.zeros((1, 2, 2))
        self.tasks = [LimbTask("joints") for _ in range(n)]
        self.pose, self.twist = np.zeros(3), np.zeros(3)
        """Estimated body pose and speed, world frame."""
        self.aim, self.aim_speed = np.zeros(3), np.zeros(3)
        """Of the body."""
        self.tips, self.tip_speeds = np.zeros((n, 2)), np.zeros((n, 2))
        """In the body frame, by the encoders."""
        self.q, self.qd = np.zeros((n, 2)), np.zeros((n, 2))
        self.torques = np.zeros((n, 2))
        self.play = np.zeros((n, 2))
        """How far each joint's output is believed to lag its encoder, the side of the play it rests on [rad]."""
        self.settled_tips = np.zeros((n, 2))
        """Tips in the body frame with the play counted."""
        self.settled = np.zeros(3)
        """The pose with the play counted: for maps and aims, never for the fast loop, which it would set swinging."""
        self._held = np.zeros(n, np.int64)
        self._carriers = np.zeros((2, n), np.int64)
        """1 for those that carry: who did until now, and who will once the load has been handed over."""
        self._weights = np.zeros(n)
        self._handed = 1.0
        self._holds, self._arms = np.zeros((n, 2)), np.zeros((n, 2))
        self._unused_speeds, self._unused_twist = np.zeros((n, 2)), np.zeros(3)
        self._pulls, self._forces = np.zeros((n, 2)), np.zeros((n, 2))
        self._old_pulls, self._old_forces = np.zeros((n, 2)), np.zeros((n, 2))
        self._own = np.zeros(2)
        self._cuts, self._drags = np.zeros((MOST_CUTS, 2)), np.zeros((n, 2))
        self._least = np.full(n, gains.least_pull)
        self._ports = [
            (limb.port_x, limb.port_y, math.cos(limb.port_angle), math.sin(limb.port_angle)) for limb in robot.limbs
        ]
        self._kp, self._kd, self._stiffness = np.array(gains.kp), np.array(gains.kd), np.array(gains.stiffness)
        self._pressed, self._loads, self._loads_now = np.zeros(n, np.int64), np.zeros((n, 2)), np.zeros(2)
        self._lag = np.array((period / PLAY_TIME, self.backlash / 2))

    def see(self, q: Floats, qd: Floats, angle: float, angle_speed: float, *, with_encoder: bool = True) -> None:
        """Take in a tick's measurements and estimate where the body is."""
        self.q[:], self.qd[:] = q, qd
        for i, task in enumerate(self.tasks):
            self._held[i] = task.holds
            if task.holds:
                self._holds[i] = task.place
        self._pass_load()
        estimate_body(
            self.legs, self.q, self.qd, self._weights, self._holds, angle, angle_speed, with_encoder,
            self.tips, self.tip_speeds, self.pose, self.twist,
        )  # fmt: skip
        estimate_body(
            self.legs, self.q - self.play, self.qd, self._weights, self._holds, angle, angle_speed, with_encoder,
            self.settled_tips, self._unused_speeds, self.settled, self._unused_twist,
        )  # fmt: skip

    def reckon_with(self, backlash: float) -> None:
        """Believe in another backlash of every joint from now on [rad]."""
        self.backlash = backlash
        self._lag[1] = backlash / 2

    def hand_over(self, carriers: Collection[int]) -> None:
        """Let the load pass to these limbs, each of them on a hold; it does while `handing_over`, then the others cling."""
        now = [i for i in range(self.n) if self.tasks[i].doing == "hold"]
        for i in carriers:
            self.tasks[i].doing = "hold"
        if not now or set(now) == set(carriers):
            return
        for row, limbs in zip(self._carriers, (now, carriers), strict=True):
            row[:] = [i in limbs for i in range(self.n)]
        self._handed = 0.0

    def stands(self, pose: Floats) -> float:
        """How well the limbs that hold now would at another pose of the body, in newtons of the worst wish; -inf out of reach."""
        carriers = [i for i, task in enumerate(self.tasks) if task.doing == "hold"]
        q, arms, forces = self.q.copy(), np.zeros((self.n, 2)), np.zeros((self.n, 2))
        for i in carriers:
            side = self.q[i, 1] - self.play[i, 1]
            found = [
                one
                for one in postures(self.robot.limbs[i], pose, self.tasks[i].place)
                if one.inside and one.angles[1] * side > 0.0 and abs(one.angles[1]) > STRETCHED
            ]
            if not found:
                return -math.inf
            q[i], arms[i] = found[0].angles, self.tasks[i].place - pose[:2]
        if len(carriers) != 2:
            return 0.0
        wrench = np.array((0.0, self.robot.weight, weight_moment(self.legs, q, pose[2])))
        margin, _ = pair_forces(
            self.legs, q, carriers[0], carriers[1], pose, arms, wrench, np.zeros(3), self._cuts, forces
        )
        return float(margin)

    @property
    def handing_over(self) -> bool:
        """Whether the load is passing from limbs to others."""
        return self._handed < 1.0

    def _pass_load(self) -> None:
        """One tick of a hand-over; how much each limb that holds says about where the body is."""
        if self.handing_over:
            self._handed = min(1.0, self._handed + self.period / HANDING_OVER)
            if self._handed == 1.0:
                for i, task in enumerate(self.tasks):
                    if self._held[i] and not self._carriers[1, i]:
                        task.doing, self._held[i] = "cling", 0
        if self.handing_over:
            part = self._part()
            before, after = self._carriers
            np.add((1.0 - part) / before.sum() * before, part / after.sum() * after, out=self._weights)
        else:
            self._weights[:] = self._held

    def _part(self) -> float:
        """Of the load that has passed, smooth at both ends [-]."""
        u = self._handed
        return u * u * (3.0 - 2.0 * u)

    def tip(self, i: int) -> Floats:
        """A limb's tip in the world by encoders and estimate, the play counted [m]."""
        c, s = math.cos(self.settled[2]), math.sin(self.settled[2])
        x, y = self.settled_tips[i]
        return np.array((self.settled[0] + c * x - s * y, self.settled[1] + s * x + c * y))

    def felt_tip(self, i: int) -> Floats:
        """The same by the encoders alone: rougher, but it moves only when a motor does [m]."""
        c, s = math.cos(self.pose[2]), math.sin(self.pose[2])
        x, y = self.tips[i]
        return np.array((self.pose[0] + c * x - s * y, self.pose[1] + s * x + c * y))

    def tip_speed(self, i: int) -> Floats:
        """Its speed in the world [m/s]."""
        c, s = math.cos(self.pose[2]), math.sin(self.pose[2])
        x, y = self.tips[i]
        vx, vy = self.tip_speeds[i]
        w = self.twist[2]
        ax, ay = vx - w * y, vy + w * x
        return np.array((self.twist[0] + c * ax - s * ay, self.twist[1] + s * ax + c * ay))

    def strain(self, i: int, j: int) -> float:
        """How far the distance of two holding tips is from that of their holds [m]."""
        return abs(math.dist(self.tips[i], self.tips[j]) - math.dist(self.tasks[i].place, self.tasks[j].place))

    def grab_direction(self, i: int) -> Floats:
        """Where a limb's hook pulls, world frame, unit vector."""
        limb = self.robot.limbs[i]
        angle = self.pose[2] + limb.port_angle + self.q[i, 0] + self.q[i, 1] + limb.end.angle
        return np.array((math.cos(angle), math.sin(angle)))

    def command(self) -> Floats:
        """Torques of this tick, shape (limbs, 2) [N m]."""
        gains = self.gains
        np.subtract(self._holds, self.pose[:2], out=self._arms)
        if gains.mapping == "wrench":
            wanted = self._stiffness * (self.aim - self.pose)
            drag_tips(self.tip_speeds, self.pose[2], self._arms, self.aim_speed, gains.kd[0], self._drags)
        else:
            wanted = self._kp * (self.aim - self.pose) + self._kd * (self.aim_speed - self.twist)
        fed = self._fed()
        if self.handing_over:
            self._command_tips(self._carriers[0], wanted, fed, self._old_pulls, self._old_forces)
            self._command_tips(self._carriers[1], wanted, fed, self._pulls, self._forces)
            part = self._part()
            # cones are convex: between two loads that keep a hook on, all do
            self._pulls += (1.0 - part) * (self._old_pulls - self._pulls)
            self._forces += (1.0 - part) * (self._old_forces - self._forces)
        else:
            self._command_tips(self._held, wanted, fed, self._pulls, self._forces)
        for i, task in enumerate(self.tasks):
            if task.doing == "hold":
                self._pull(i, self._pulls[i], self._forces[i])
            elif task.doing == "cling":
                self._press(
                    i, gains.cling * self.grab_direction(i) + self._towards(task.place - self.tip(i)), CLING_DAMPING
                )
            elif task.doing == "pull":
                self._press(i, task.force, task.damping)
            elif task.doing == "tip":
                self._reach(i, task)
            else:
                shares = self.chains[i].joints["share"]
                self.torques[i] = shares * (
                    gains.joint_kp * (task.angles - self.q[i]) + gains.joint_kd * (task.rates - self.qd[i])
                )
                if task.doing == "hang":
                    self.torques[i] += task.loads
            self._pressed[i] = task.doing == "cling" or (task.doing == "pull" and task.pressed)
            if task.doing in ("pull", "cling"):
                most = gains.firm if task.pressed else gains.gentle
                np.clip(self.torques[i], -most, most, out=self.torques[i])
        follow_play(
            self.legs, self.q, self._held, self._forces, self.pose[2], self._pressed, self._loads, self._lag, self.play
        )
        return self.torques

    def _command_tips(
        self, held: npt.NDArray[np.int64], wanted: Floats, fed: Floats, pulls: Floats, forces: Floats
    ) -> None:
        gains = self.gains
        pulls[:] = 0.0
        command_tips(
            self.legs, self.q, held, self.pose, self._arms, wanted, fed,
            MAPPINGS[gains.mapping], LIMITS[gains.limit], self._least, self._drags, self._cuts, pulls, forces,
        )  # fmt: skip

    def _fed(self) -> Floats:
        """The wrench on the body that the holding limbs bring in any case: the weight, less what tugging limbs already carry."""
        fed = self.gains.weight_fed * np.array((0.0, self.robot.weight, weight_moment(self.legs, self.q, self.pose[2])))
        for i, task in enumerate(self.tasks):
            if task.doing == "pull" and task.tug.any():
                arm = self.tip(i) - self.settled[:2]
                fed += (*task.tug, arm[0] * task.tug[1] - arm[1] * task.tug[0])
        return fed

    def _into_port(self, i: int, vector: Floats) -> Floats:
        angle = -(self.pose[2] + self.robot.limbs[i].port_angle)
        c, s = math.cos(angle), math.sin(angle)
        return np.array((c * vector[0] - s * vector[1], s * vector[0] + c * vector[1]))

    def _own_tip(self, i: int) -> Floats:
        port_x, port_y, c, s = self._ports[i]
        x, y = self.tips[i, 0] - port_x, self.tips[i, 1] - port_y
        return np.array((c * x + s * y, -s * x + c * y))

    def _pull(self, i: int, pull: Floats, force: Floats) -> None:
        """A law with a gain of one, aimed one pull away, turns exactly that pull into torques."""
        aim = self._aim
        aim["place"][0, :2] = self._own_tip(i) + pull
        aim["twist"][0] = 0.0
        aim["wrench"][0, :2] = force
        self._state(i)
        self.torques[i] = self._pullers[i].command(aim, self._states)[0] + self._own_weight(i)

    def _towards(self, off: Floats) -> Floats:
        """Pull of a limb that clings, towards a hold that far off [N]."""
        far = math.hypot(*off)
        return off * (min(CLING_STIFFNESS * max(far - CLING_SLACK, 0.0), CLING_MOST) / max(far, 1e-9))

    def _press(self, i: int, force: Floats, damping: float) -> None:
        pull_torques(
            self.legs[i], self.q[i], self.qd[i], self.pose, self.twist, force, damping, self.torques[i], self._loads_now
        )
        self._loads[i] += self.period / LOAD_TIME * (self._loads_now - self._loads[i])

    def _reach(self, i: int, task: LimbTask) -> None:
        aim = self._aim
        aim["place"][0, :2] = self._own_tip(i) + self._into_port(i, task.place - self.tip(i))
        still = self.tip_speed(i) - self._turned_back(i)
        aim["twist"][0, :2] = self._into_port(i, task.speed - still)
        aim["wrench"][0] = 0.0
        self._state(i)
        torques = self._reachers[i].command(aim, self._states)[0]
        # all in proportion: a joint clipped alone would turn the force at the tip, and wedge a hook on the hold it leaves
        torques *= min(1.0, self.gains.gentle / max(float(np.abs(torques).max()), 1e-9))
        self.torques[i] = torques + self._own_weight(i)

    def _turned_back(self, i: int) -> Floats:
        """Speed of the tip relative to the body, world axes."""
        c, s = math.cos(self.pose[2]), math.sin(self.pose[2])
        vx, vy = self.tip_speeds[i]
        return np.array((c * vx - s * vy, s * vx + c * vy))

    def _own_weight(self, i: int) -> Floats:
        """Torques that carry a limb's own weight, however the body is turned [N m]."""
        weight_loads(self.legs[i], self.q[i], self.pose[2], self._own)
        return self._own

    def _state(self, i: int) -> None:
        self._states[0, 0], self._states[0, 1] = self.q[i], self.qd[i]
