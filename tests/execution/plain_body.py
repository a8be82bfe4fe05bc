"""A climber's control of one tick in plain NumPy, limb by limb through the controllers' own faces: what the compiled tick has to be."""

import math

import numpy as np

from clamber.control.controller import still_aim
from clamber.families.climber.control import body_tick as at
from clamber.families.climber.control.backlash import follow_play, pull_torques, weight_loads, weight_moment
from clamber.families.climber.control.body import command_contact_forces, drag_tips
from clamber.families.climber.control.body_estimate import ENCODER, estimate_body
from clamber.families.climber.control.hook_forces import MOST_CUTS
from clamber.families.climber.execution.body_gains import LIMITS, MAPPINGS, inertia_over_usual
from clamber.families.climber.execution.limb_task import LimbTask
from clamber.families.climber.execution.whole_body import HANDING_OVER, LOAD_TIME, WholeBody
from clamber.types import Floats


class PlainBody(WholeBody):
    """As `WholeBody`, by formulas."""

    def see(self, q: Floats, qd: Floats, angle: float, angle_speed: float, *, angle_from: int = ENCODER) -> None:
        self.q[:], self.qd[:] = q, qd
        weights = self._pass_load()
        for i, task in enumerate(self.tasks):
            self.held[i] = task.holds
            if task.holds:
                self._holds[i] = task.place
        for angles, tips, speeds, pose, twist in (
            (self.q, self.tips, self.tip_speeds, self.pose, self.twist),
            (self.q - self.play, self.settled_tips, np.zeros((self.n, 2)), self.settled, np.zeros(3)),
        ):
            estimate_body(
                self.legs, (angles, self.qd), (weights, self._holds), (angle, angle_speed, angle_from),
                tips, speeds, pose, twist,
            )  # fmt: skip

    def _pass_load(self) -> Floats:
        """One tick of a hand-over; how much each limb that holds says about where the body is, shape (n,)."""
        before, after = self._carriers.astype(float)
        if self.handing_over:
            self._handed[0] += self.period / HANDING_OVER
            if self._handed[0] > 1.0 - 0.5 * self.period / HANDING_OVER:
                self._handed[0] = 1.0
                for task, carries in zip(self.tasks, after, strict=True):
                    if task.holds and not carries:
                        task.mode = "unloaded_contact"
        if not self.handing_over:
            return np.array([float(task.holds) for task in self.tasks])
        return (1.0 - self._part()) / before.sum() * before + self._part() / after.sum() * after

    def _part(self) -> float:
        """Of the load that has passed [-]: to the last bit as compiled, for the search by halves of `pair_forces` makes more of a bit."""
        u = float(self._handed[0])
        return u * u * (3.0 - 2.0 * u)

    def tip(self, i: int) -> Floats:
        return self.settled[:2] + self._turned(float(self.settled[2]), self.settled_tips[i])

    def felt_tip(self, i: int) -> Floats:
        return self.pose[:2] + self._turned(float(self.pose[2]), self.tips[i])

    def tip_speed(self, i: int) -> Floats:
        x, y = self.tips[i]
        relative = self.tip_speeds[i] + self.twist[2] * np.array((-y, x))
        return self.twist[:2] + self._turned(float(self.pose[2]), relative)

    def grab_direction(self, i: int) -> Floats:
        limb = self.robot.limbs[i]
        angle = self.pose[2] + limb.port_angle + self.q[i].sum() + limb.end.angle
        return np.array((math.cos(angle), math.sin(angle)))

    def command(self) -> Floats:
        gains, n, heavy = self.gains, self.n, inertia_over_usual(self.robot)
        arms, drags = self._holds - self.pose[:2], np.zeros((n, 2))
        if gains.mapping == "wrench":
            wanted = np.array(gains.stiffness) * (self.aim - self.pose)
            drag_tips(self.tip_speeds, self.pose[2], arms, self.aim_speed, heavy * gains.damping, drags)
        else:
            wanted = np.array(gains.kp) * (self.aim - self.pose) + np.array(gains.kd) * (self.aim_speed - self.twist)
            wanted *= heavy
        fed = gains.weight_fed * np.array((0.0, self.robot.weight, weight_moment(self.legs, self.q, self.pose[2])))
        for i, task in enumerate(self.tasks):
            if task.mode == "contact_push":
                arm = self.tip(i) - self.settled[:2]
                fed += (*task.tug, arm[0] * task.tug[1] - arm[1] * task.tug[0])

        def share(held: Floats) -> tuple[Floats, Floats]:
            pulls, forces = np.zeros((n, 2)), np.zeros((n, 2))
            command_contact_forces(
                (self.legs, self.q, self.pose, arms), held, (wanted, fed, MAPPINGS[gains.mapping], LIMITS[gains.limit]),
                np.full(n, heavy * gains.alpha), drags, np.zeros((MOST_CUTS, 2)), pulls, forces,
            )  # fmt: skip
            return pulls, forces

        if self.handing_over:
            part = self._part()
            both = zip(share(self._carriers[0]), share(self._carriers[1]), strict=True)
            pulls, forces = (part * after + (1.0 - part) * before for before, after in both)
        else:
            pulls, forces = share(self.held)
        pressed, loads = np.zeros(n, np.int64), self.work.loads
        for i, task in enumerate(self.tasks):
            torques, now = self.torques[i], np.zeros(2)
            if task.mode == "stance":
                self._pull(i, pulls[i], forces[i])
            elif task.mode == "unloaded_contact":
                force = gains.cling * self.grab_direction(i) + self._towards(task.place - self.tip(i))
                pull_torques(
                    self.legs[i],
                    (self.q[i], self.qd[i]),
                    (self.pose, self.twist),
                    force,
                    at.CLING_DAMPING,
                    torques,
                    now,
                )
                loads[i] += self.period / LOAD_TIME * (now - loads[i])
            elif task.mode == "contact_push":
                pull_torques(
                    self.legs[i],
                    (self.q[i], self.qd[i]),
                    (self.pose, self.twist),
                    task.force,
                    task.damping,
                    torques,
                    now,
                )
                loads[i] += self.period / LOAD_TIME * (now - loads[i])
            elif task.mode == "swing_cartesian":
                self._reach(i, task)
            else:
                torques[:] = (
                    self.chains[i].joints["share"]
                    * heavy
                    * (gains.joint_kp * (task.angles - self.q[i]) + gains.joint_kd * (task.rates - self.qd[i]))
                )
                if task.mode == "hang":
                    torques += task.loads
                else:
                    leg = self.legs[i]
                    rotors, dry, wet = (
                        np.array((leg[key + "1"], leg[key + "2"])) for key in ("rotor", "friction", "damping")
                    )
                    torques += weight_loads(leg, self.q[i], self.pose[2]) + rotors * task.accelerations
                    torques += wet * task.rates + dry * np.tanh(task.rates / at.MOVING)
            pressed[i] = task.mode == "unloaded_contact" or (task.mode == "contact_push" and task.pressed)
            if task.mode in ("contact_push", "unloaded_contact"):
                most = gains.firm if task.pressed else gains.gentle
                np.clip(torques, -most, most, out=torques)
        follow_play(
            self.legs,
            (self.q, self.qd),
            self.pose[2],
            (self.held, forces),
            (pressed, loads),
            self._lag,
            self.play,
            self.sure,
        )
        return self.torques

    def _own_weight(self, i: int) -> Floats:
        """What a pull of nothing takes, by the weight alone."""
        return np.array(weight_loads(self.legs[i], self.q[i], self.pose[2]))

    def _towards(self, off: Floats) -> Floats:
        far = float(np.linalg.norm(off))
        return off * min(at.CLING_STIFFNESS * max(far - at.CLING_SLACK, 0.0), at.CLING_MOST) / max(far, 1e-9)

    def _turned(self, angle: float, vector: Floats) -> Floats:
        c, s = math.cos(angle), math.sin(angle)
        return np.array(((c, -s), (s, c))) @ vector

    def _into_port(self, i: int, vector: Floats) -> Floats:
        return self._turned(-(self.pose[2] + self.robot.limbs[i].port_angle), vector)

    def _own_tip(self, i: int) -> Floats:
        limb = self.robot.limbs[i]
        return self._turned(-limb.port_angle, self.tips[i] - (limb.port_x, limb.port_y))

    def _pull(self, i: int, pull: Floats, force: Floats) -> None:
        aim = still_aim(self._own_tip(i) + pull)
        aim["wrench"][0, :2] = force
        self.torques[i] = self._pullers[i].command(aim, np.stack([self.q[i], self.qd[i]])[None])[0] + self._own_weight(
            i
        )

    def _reach(self, i: int, task: LimbTask) -> None:
        aim = still_aim(self._own_tip(i) + self._into_port(i, task.place - self.tip(i)))
        by_joints = self._turned(float(self.pose[2]), self.tip_speeds[i])
        aim["twist"][0, :2] = self._into_port(i, task.speed - (self.tip_speed(i) - by_joints))
        torques = self._reachers[i].command(aim, np.stack([self.q[i], self.qd[i]])[None])[0]
        most = float(np.abs(torques).max())
        self.torques[i] = torques * min(1.0, self.gains.gentle / most if most else 1.0) + self._own_weight(i)
