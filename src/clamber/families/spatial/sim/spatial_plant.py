"""A robot in space in MuJoCo as a plant: encoders, IMU, tip forces and switches in; torques and commands to end effectors out."""

from collections.abc import Sequence
from functools import partial
from typing import Any, Final

import numpy as np

from ....compiled import Handle, ready
from ....sim.electronics import take_torques
from ....sim.plant_rules import PlantError
from ....types import Floats, Ints
from ..execution.plant import (
    Pose,
    SpatialSensed,
    SpatialTruth,
)
from ..robot.parts import Motors
from ..robot.robot import SpatialRobot
from ..world.world import World
from .end_kernels import drive_motors, true_motion
from .ends import Ends
from .sensing import Sensing
from .spatial_flaws import Deviations, SpatialFlaws
from .spatial_model import (
    TrueWorld,
    play_name,
    quaternion,
    spatial_spec,
    tip_name,
)

SEATING: Final = 30
"""Steps of the search that puts tips on the true holds."""
SEATED: Final = 1e-6
"""Where it ends [m]."""


class SpatialSim:
    """One robot in its world; a `SpatialPlant`.

    Args:
        robot: The robot.
        world: Its world as believed.
        flaws: Of gears, motors and sensors.
        deviations: How robot and world truly are; None: as believed.
    """

    def __init__(
        self,
        robot: SpatialRobot,
        world: World,
        flaws: SpatialFlaws = SpatialFlaws(),  # noqa: B008  # frozen
        deviations: Deviations | None = None,
    ) -> None:
        import mujoco

        self.robot, self.world, self.flaws, self.period = robot, world, flaws, flaws.period
        true = TrueWorld(world, Deviations.none(robot, world) if deviations is None else deviations)
        self.model: Any = spatial_spec(robot, true, flaws).compile()
        self.model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_ISLAND | mujoco.mjtDisableBit.mjDSBL_MIDPHASE
        self._data: Any = mujoco.MjData(self.model)
        self._step, self._mujoco = mujoco.mj_step, mujoco
        model, data, chains = self.model, self._data, robot.chains
        names = [name for limb in chains.joint_names for name in limb]
        n = len(names)
        joints = [model.joint(name) for name in names]
        # views of memory that stays where it is: asking for one costs a microsecond
        self._qpos, self._qvel = data.qpos, data.qvel
        self._seen = mujoco.MjData(model)
        self._at = np.array([joint.qposadr[0] for joint in joints])
        self._speed_at = np.array([joint.dofadr[0] for joint in joints])
        self.motors: Final = Motors.of(robot)
        """As the robot's files have them."""
        motors = self.motors
        sliding = motors.sliding
        played = np.flatnonzero(~sliding) if flaws.backlash > 0.0 else np.zeros(0, np.intp)
        plays = [model.joint(play_name(names[k])) for k in played]
        self._play_at = np.array([play.qposadr[0] for play in plays], np.intp)
        play_at, play_speed_at = np.full(n, -1), np.full(n, -1)
        play_at[played], play_speed_at[played] = self._play_at, [play.dofadr[0] for play in plays]
        motion = Handle(data.qpos, data.qvel, self._at, self._speed_at, play_at, play_speed_at)
        self._true_motion = ready(true_motion, motion, np.empty((3, 3)), np.empty(6), np.empty((2, n)))
        with np.errstate(divide="ignore"):
            agility = (
                2.0 * motors.torque / motors.rotor
            )  # a load on the motor's side brings no more than the motor itself
        counts = np.where(sliding | (flaws.encoder_step == 0.0), 0.0, 1.0 / max(flaws.encoder_step, 1e-12))
        self._names = names
        self._wanted, self._given = np.zeros((1, n)), np.zeros((1, n))
        motors_of = Handle(
            data.qvel, self._speed_at, np.zeros((1, n)), self._wanted, motors.torque, motors.speed, agility, self._given,
            np.zeros((1, n)), data.ctrl,
        )  # fmt: skip
        self._drive = ready(drive_motors, motors_of, self.period)
        """Puts what the motors give at the present speeds on the joints; whether that may be held for a time [s]."""
        self.ends: Final = Ends(robot, world, true.deviations, flaws, model, data)
        self._sensing = Sensing(
            chains,
            flaws,
            (self._at, self._speed_at, counts),
            data,
            np.array(world.gravity, np.float64),
            float(model.stat.extent) / 2.0,
            self._given[0],
            (self.ends.local, self.ends.closed, self.ends.shutting),
        )
        self.sensed: Final = self._sensing.sensed
        """What the sensors said last."""
        self._frictions: Floats = model.dof_frictionloss.copy()
        self._braked: list[int] = []
        self._pushes, self._next_push = true.deviations.pushes, 0
        self._pushed = data.xfrc_applied[model.body("base").id]
        self._sites = np.array([model.site(tip_name(name)).id for name in chains.limb_names])
        self.tick = 0

    @property
    def time(self) -> float:
        """Since the reset [s]."""
        return self.tick * self.period

    def reset(self, pose: Pose, joints: Floats, held: Sequence[int] | Ints) -> None:
        """See `SpatialPlant`. Tips of limbs that are held are put on their holds where those truly are."""
        mujoco, model, data = self._mujoco, self.model, self._data
        mujoco.mj_resetData(model, data)
        self._pushed[:] = 0.0
        self._braked, model.dof_frictionloss[:] = [], self._frictions
        self._qpos[:3], self._qpos[3:7] = pose.position, quaternion(mujoco, pose.rotation)
        self._qpos[self._at] = joints
        if self.flaws.seed is not None:
            sides = np.random.default_rng([self.flaws.seed, 1]).choice((-0.5, 0.5), len(self._play_at))
            self._qpos[self._play_at] = self.flaws.backlash * sides
        mujoco.mj_forward(model, data)
        for limb, hold in enumerate(held):
            if hold >= 0:
                self._seat(limb, self.ends.places([hold])[0])
        mujoco.mj_forward(model, data)
        self.ends.reset(held)
        mujoco.mj_forward(model, data)
        self.ends.feel(0.0)
        self._wanted[:] = self._given[:] = 0.0
        self._next_push = 0
        self._sensing.reset()
        self.tick = 0

    def _seat(self, limb: int, place: Floats) -> None:
        """Put a limb's tip on a place by its joints (damped least squares)."""
        mujoco, model, data = self._mujoco, self.model, self._data
        first = int(self.robot.chains.n_joints[:limb].sum())
        mine = slice(first, first + int(self.robot.chains.n_joints[limb]))
        jacobian = np.zeros((3, model.nv))
        for _ in range(SEATING):
            off = place - data.site_xpos[self._sites[limb]]
            if np.abs(off).max() < SEATED:
                return
            mujoco.mj_jacSite(model, data, jacobian, None, self._sites[limb])
            j = jacobian[:, self._speed_at[mine]]
            square = j @ j.T
            self._qpos[self._at[mine]] += j.T @ np.linalg.solve(square + 1e-6 * np.trace(square) * np.eye(3), off)
            mujoco.mj_kinematics(model, data)
            mujoco.mj_comPos(model, data)

    def sense(self) -> SpatialSensed:
        """Read the sensors, once a tick."""
        return self._sensing.read(self.tick)

    def actuate(self, torques: Floats) -> None:
        """See `SpatialPlant`.

        Raises:
            PlantError: If one is not a finite number.
        """
        if take_torques(torques[None], self._wanted) >= 0:
            k = int(np.argmin(np.isfinite(torques)))
            raise PlantError(f"torque of {self._names[k]}", float(torques[k]), "must be a finite number")
        for joint in self._braked:
            self._wanted[0, joint] = 0.0

    def brake(self, joint: int) -> None:
        """See `SpatialPlant`: dry friction on the motor's side."""
        at, holds = self._speed_at[joint], self.robot.spec.brake * self.motors.torque[joint]
        self.model.dof_frictionloss[at] = self._frictions[at] + holds
        self._braked.append(joint)

    def grip(self, limb: int, close: bool) -> None:
        """See `SpatialPlant`."""
        self.ends.grip(limb, close)

    def weaken(self, hold: int, strength: float) -> None:
        """Have a hold, by its number, give way to a pull above `strength` [N], until the next reset."""
        self.ends.weaken(hold - 1, strength)

    def push(self, wrench: Floats) -> None:
        """Push the base until the next call or reset: force on its centre of mass [N], and moment [N m], world frame, shape (6,)."""
        self._pushed[:] = wrench

    def pause(self) -> None:
        """See `SpatialPlant`: nothing to do, as time stands still meanwhile."""

    def step(self) -> None:
        """Let one control period pass.

        Raises:
            PlantStoppedError: If the simulation has lost its numbers.
        """
        self.ends.look()
        if self._next_push < len(self._pushes):
            self._push_on()
        if self._drive(self.period):
            self._step(self.model, self._data, self.flaws.steps)
        else:  # near a limit the torque follows the speed at every physics step
            for _ in range(self.flaws.steps):
                self._drive(0.0)
                self._step(self.model, self._data, 1)
        self.tick += 1
        self.ends.feel(self.time)

    def _push_on(self) -> None:
        """Begin and end the pushes that are to come."""
        push = self._pushes[self._next_push]
        if self.time >= push.end:
            self._pushed[:] = 0.0
            self._next_push += 1
        elif self.time >= push.start:
            self._pushed[:3] = push.force

    def _tips_at(self, qpos: Floats) -> Floats:
        """Where tips are [m], shape (limbs, 3)."""
        seen = self._seen
        seen.qpos[:] = qpos
        self._mujoco.mj_kinematics(self.model, seen)
        tips: Floats = seen.site_xpos[self._sites]
        return tips

    def truth(self) -> SpatialTruth:
        """How things really are; a look leaves the simulation as it is."""
        turn, velocity, joints = np.empty((3, 3)), np.empty(6), np.empty((2, len(self._at)))
        self._true_motion(turn, velocity, joints)
        return SpatialTruth(
            pose=Pose(turn, self._qpos[:3].copy()),
            velocity=velocity,
            joints=joints,
            find_tips=partial(self._tips_at, self._qpos.copy()),
            wrenches=self.ends.wrenches.copy(),
            attached=self.ends.attached,
            torques=self._given[0].copy(),
            broken=self.ends.broken,
        )
