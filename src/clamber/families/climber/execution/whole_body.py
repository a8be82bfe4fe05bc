"""The climber's controller: what each limb is doing, where the body is to be, and the torques of one tick."""

import math
from collections.abc import Collection, Sequence
from typing import Final

import numpy as np

from ....compiled import Handle, ready
from ....control.controller import Controller, still_aim
from ....control.law_settings import LawSettings
from ....control.records import AXES
from ....types import Floats
from ..control.backlash import weight_moment
from ..control.body_estimate import ENCODER
from ..control.body_tick import BodyWork, command_tick, see_tick
from ..control.hook_forces import MOST_CUTS, NOTHING, pair_forces
from ..control.limb_chain import chain_of_limb, legs_of
from ..control.planar_limb import LIMB_TASK
from ..control.virtual_potential import repel_limbs
from ..robot.robot import LimbedRobot
from .body_gains import USUAL, BodyGains, inertia_over_usual, records_of
from .body_schemes import SCHEMES
from .limb_task import LimbTask
from .postures import postures

PLAY_TIME: Final = 0.2
"""Time in which the believed side of the play follows the load [s]."""
LOAD_TIME: Final = 0.15
"""Time over which the load of a limb that pulls is evened out: a dither's own load moves no joint through its play [s]."""
STRETCHED: Final = math.radians(15.0)
"""An elbow nearer to straight than this is soft and may pass to the other side [rad]."""
HANDING_OVER: Final = 0.4
"""Time in which the load passes from the limbs that carried to those that will [s]."""

REPELLED: Final = ("swing_cartesian", "swing_joint")
"""What free limbs do that a virtual potential keeps off the body; one that pushes at a hold is steered by what it feels there."""
MOST_REPELLED: Final = 3.0
"""Largest force of the potential over the robot's weight [-] (chosen): it stops a limb that comes at full speed, whose rotors are most
of its inertia; with the weight itself one got through."""


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
        gains: BodyGains = USUAL,
        backlash: float | None = None,
    ) -> None:
        self.robot, self.gains, self.period = robot, gains, period
        self.backlash = robot.motor.backlash if backlash is None else backlash
        n = len(robot.limbs)
        self.n = n
        self.chains = [chain_of_limb(robot, limb.name) for limb in robot.limbs]
        self.legs = legs_of(robot, self.chains)
        unit = LawSettings(law=gains.law, kp=1.0, kd=0.0, joint_kd=1.0, feed_gravity=False)
        heavy = inertia_over_usual(robot)
        free = LawSettings(law=gains.law, kp=heavy * gains.limb_kp, kd=heavy * gains.limb_kd, feed_gravity=False)
        self._pullers = [Controller(chain, unit, period=period) for chain in self.chains]
        self._reachers = [Controller(chain, free, period=period) for chain in self.chains]
        self._aim = still_aim((0.0, 0.0))
        self._states = np.zeros((1, 2, 2))
        self._jobs = np.zeros(n, LIMB_TASK)
        self.tasks: tuple[LimbTask, ...] = ()
        """What each limb is doing; `assign` gives it something else."""
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
        self.sure = np.zeros((n, 2))
        """How sure that side is, by what loads the joint: 0, it may be anywhere in its play, to 1 [-]."""
        self.settled_tips = np.zeros((n, 2))
        """Tips in the body frame with the play counted."""
        self.settled = np.zeros(3)
        """The pose with the play counted: for maps and aims, never for the fast loop, which it would set swinging."""
        self.held = np.zeros(n, np.int64)
        """1 for limbs that hold, as of the last measurement."""
        self._carriers = np.zeros((2, n), np.int64)
        """1 for those that carry: who did until now, and who will once the load has been handed over."""
        self._weights = np.zeros(n)
        self._handed = np.array((1.0, period / HANDING_OVER))
        self._holds, self._cuts = np.zeros((n, 2)), np.zeros((MOST_CUTS, 2))
        self.in_world = np.zeros((4, n, 2))
        """Of the tips, world frame: where they are with the play counted, and by the encoders alone [m], their speeds by those [m/s], and
        where their hooks pull, unit vectors; all that a tick needs of them in one."""
        self._places, self._felt_places, self._place_speeds, self._grabs = self.in_world
        self._lag = np.array((period / PLAY_TIME, self.backlash / 2, period / LOAD_TIME))
        drives = np.array([[law.buffers for law in laws] for laws in (self._pullers, self._reachers)])
        self.work: Final = BodyWork(
            legs=self.legs, gains=records_of(gains, robot), jobs=self._jobs, drives=drives,
            q=self.q, qd=self.qd, lagged=np.zeros((n, 2)), held=self.held, weights=self._weights,
            holds=self._holds, arms=np.zeros((n, 2)), tips=self.tips, tip_speeds=self.tip_speeds,
            settled_tips=self.settled_tips, spare_speeds=np.zeros((n, 2)),
            pose=self.pose, twist=self.twist, settled=self.settled, spare_twist=np.zeros(3),
            aimed=self.aim, aim_speed=self.aim_speed, places=self._places, felt_places=self._felt_places,
            place_speeds=self._place_speeds, grabs=self._grabs,
            play=self.play, sure=self.sure, carriers=self._carriers, handed=self._handed,
            pulls=np.zeros((n, 2)), forces=np.zeros((n, 2)), old_pulls=np.zeros((n, 2)), old_forces=np.zeros((n, 2)),
            cuts=self._cuts, drags=np.zeros((n, 2)), least=np.full(n, heavy * gains.alpha), pressed=np.zeros(n, np.int64),
            loads=np.zeros((n, 2)), loads_now=np.zeros(2), lag=self._lag, wanted=np.zeros(3), fed=np.zeros(3),
            aim=self._aim, states=self._states, felt=np.zeros((1, AXES)), torques=self.torques,
        )  # fmt: skip
        """What a tick works on, these arrays among it."""
        work = Handle(self.work)
        self._see_tick, self._command_tick = ready(see_tick, work, 0.0, 0.0, ENCODER), ready(command_tick, work)
        longest = max(limb.length for limb in robot.limbs)
        self._field = np.array(
            (gains.potential_range * longest, gains.potential * robot.weight, MOST_REPELLED * robot.weight)
        )
        self._outline, self._skin = robot.outline(), robot.body_margin + robot.link_radius
        self._free = np.zeros(n, np.int64)
        self.gaps = np.full(n, np.inf)
        """Gap of each free limb's second link to the body, with a virtual potential; infinity for others [m]."""
        self._scheme = None if gains.scheme == "body" else SCHEMES[gains.scheme](self)
        for i in range(n):
            self.assign(i, LimbTask("swing_joint"))

    def assign(self, i: int, task: LimbTask) -> None:
        """Give limb `i` something else to do."""
        task.attach(self._jobs, i)
        self.tasks = (*self.tasks[:i], task, *self.tasks[i + 1 :])

    def see(self, q: Floats, qd: Floats, angle: float, angle_speed: float, *, angle_from: int = ENCODER) -> None:
        """Take in a tick's measurements and estimate where the body is.

        Args:
            q, qd: Joint angles and speeds, shape (limbs, 2).
            angle, angle_speed: Of the body by its own encoder [rad], [rad/s].
            angle_from: One of `control.body_estimate`: ENCODER, LINE, SECOND_TIP.
        """
        self.q[:], self.qd[:] = q, qd
        if self._see_tick(angle, angle_speed, angle_from):
            for task, held in zip(self.tasks, self.held, strict=True):
                if task.holds and not held:
                    task.mode = "unloaded_contact"

    def reckon_with(self, backlash: float) -> None:
        """Believe in another backlash of every joint from now on [rad]."""
        self.backlash = backlash
        self._lag[1] = backlash / 2

    def hand_over(self, carriers: Collection[int]) -> None:
        """Let the load pass to these limbs, each of them on a hold; it does while `handing_over`, then the others cling.

        A hand-over that is still going on is over: all its limbs carry when this one begins.
        """
        self._handed[0] = 1.0
        now = [i for i in range(self.n) if self.tasks[i].mode == "stance"]
        for i in carriers:
            self.tasks[i].mode = "stance"
        if not now or set(now) == set(carriers):
            return
        for row, limbs in zip(self._carriers, (now, carriers), strict=True):
            row[:] = [i in limbs for i in range(self.n)]
        self._handed[0] = 0.0

    def carry_at_once(self, carriers: Collection[int]) -> None:
        """Let the load jump to these limbs: for where another has lost it already."""
        for i in carriers:
            self.tasks[i].mode = "stance"
        self._handed[0] = 1.0

    def stands(self, pose: Floats, carriers: Sequence[int] | None = None) -> float:
        """How well limbs would hold at a pose of the body, in newtons of the worst wish; -inf out of reach.

        Args:
            pose: Shape (3,).
            carriers: Limbs on holds; None: those that carry now.
        """
        if carriers is None:
            carriers = [i for i, task in enumerate(self.tasks) if task.mode == "stance"]
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
        wrenches = (0.0, self.robot.weight, weight_moment(self.legs, q, pose[2])), NOTHING
        margin, _ = pair_forces((self.legs, q, pose, arms), (carriers[0], carriers[1]), wrenches, self._cuts, forces)
        return float(margin)

    @property
    def handing_over(self) -> bool:
        """Whether the load is passing from limbs to others."""
        return bool(self._handed[0] < 1.0)

    def tip(self, i: int) -> Floats:
        """A limb's tip in the world by encoders and estimate, the play counted [m]."""
        out: Floats = self._places[i].copy()
        return out

    def felt_tip(self, i: int) -> Floats:
        """The same by the encoders alone: rougher, but it moves only when a motor does [m]."""
        out: Floats = self._felt_places[i].copy()
        return out

    def tip_speed(self, i: int) -> Floats:
        """Its speed in the world [m/s]."""
        out: Floats = self._place_speeds[i].copy()
        return out

    def turned_by_joints(self, i: int) -> Floats:
        """How a limb's tip moves with its joints, world frame, one column a joint, shape (2, 2) [m/rad]."""
        limb, angle = self.robot.limbs[i], float(self.settled[2])
        first = angle + limb.port_angle + self.q[i, 0] - self.play[i, 0]
        second = first + self.q[i, 1] - self.play[i, 1] + limb.hook_beta
        x, y = -limb.l2_effective * math.sin(second), limb.l2_effective * math.cos(second)
        return np.array(((x - limb.l1 * math.sin(first), x), (y + limb.l1 * math.cos(first), y)))

    def strain(self, i: int, j: int) -> float:
        """How far the distance of two holding tips is from that of their holds [m]."""
        apart = math.dist(self.tips[i].tolist(), self.tips[j].tolist())
        return abs(apart - math.dist(self.tasks[i].place.tolist(), self.tasks[j].place.tolist()))

    def grab_direction(self, i: int) -> Floats:
        """Where a limb's hook pulls, world frame, unit vector."""
        out: Floats = self._grabs[i].copy()
        return out

    def command(self) -> Floats:
        """Torques of this tick, shape (limbs, 2) [N m].

        Raises:
            MeasurementError: If a measurement is not finite.
            AimError: Likewise of an aim.
        """
        bad = self._command_tick()
        if bad >= 0:
            self._complain(bad)
        if self.gains.potential > 0.0:
            self._free[:] = [task.mode in REPELLED for task in self.tasks]
            repel_limbs(self.legs, self.q, self._free, self._outline, self._skin, self._field, self.torques, self.gaps)
        if self._scheme is not None:
            self._scheme.hold(self, [i for i, task in enumerate(self.tasks) if task.mode == "stance"])
        return self.torques

    def _complain(self, bad: int) -> None:
        """Let a limb's controller say what is not finite: a measurement of any limb, else the aim of limb `bad`."""
        own = self._aim.copy()
        for i, aim in [*((i, still_aim((0.0, 0.0))) for i in range(self.n)), (bad, own)]:
            self._states[0] = self.q[i], self.qd[i]
            (self._pullers if self.tasks[i].mode == "stance" else self._reachers)[i].command(aim, self._states)
