"""A two-frame walker in MuJoCo as a plant: aims of length in; lengths, load cells and inclinometers out; the truth for logs and tests."""

import math
from typing import Any, Final

import numpy as np

from ....execution.plant import PlantStoppedError
from ....sim.contact_forces import add_forces
from ....types import Floats
from ....units import GRAVITY
from ..execution.plant import WalkerSensed, WalkerTruth
from ..robot import WalkerRobot
from ..world.ground import Ground, Surface
from .walker_flaws import Inclinometers, WalkerFlaws
from .walker_model import (
    ACTUATORS,
    FEET,
    LEGS,
    PLACE,
    WalkerBuild,
    arm_names,
    foot_radius,
    walker_spec,
)


class InclinometerPair:
    """Reads the incline of a plate's x and y axis.

    An inclinometer gives the angle whose sine is the specific force along its axis over that of gravity. The mean specific force over a
    period follows from how much the speed changed in it, exactly, however it changed.

    Args:
        flaws: Noise, offsets and filter.
        period: Between readings [s].
        seed: Of the noise; None: none.
    """

    def __init__(self, flaws: Inclinometers, period: float, seed: int | None) -> None:
        self._flaws, self._period = flaws, period
        self._offsets = np.array(flaws.offsets)
        self._keep = math.exp(-period / flaws.time_constant) if flaws.time_constant > 0.0 else 0.0
        # so that what comes out of the filter has the noise that is stated
        self._scale = 0.0 if seed is None else flaws.noise * math.sqrt((1.0 + self._keep) / (1.0 - self._keep))
        self._seed = seed
        self._before = (0.0, 0.0, 0.0)
        self.readings = np.zeros(2)
        """How far the plate's x axis and its y axis rise above the horizontal, shape (2,) [rad]."""
        self._filtered = np.zeros(2)
        self._chance = np.random.default_rng(seed)

    def reset(self, axes: Floats, velocity: Floats) -> None:
        """Begin at rest at a posture.

        Args:
            axes: The plate's axes in the world, as columns, shape (3, 3).
            velocity: Of the inclinometers, world frame [m/s], shape (3,).
        """
        self._before = tuple(velocity.tolist())
        self._chance = np.random.default_rng(self._seed)
        self._filtered[:] = np.arcsin(axes[2, :2])
        if self._scale > 0.0:
            self._filtered += self._flaws.noise * self._chance.standard_normal(2)
        np.add(self._filtered, self._offsets, out=self.readings)

    def see(self, axes: Floats, velocity: Floats) -> None:
        """Take in the period that has passed; arguments as in `reset`, at its end."""
        (vx, vy, vz), (bx, by, bz) = velocity.tolist(), self._before
        fx, fy, fz = (vx - bx) / self._period, (vy - by) / self._period, (vz - bz) / self._period + GRAVITY
        self._before = (vx, vy, vz)
        noise = self._chance.standard_normal(2).tolist() if self._scale > 0.0 else (0.0, 0.0)
        for k in range(2):
            along = (axes[0, k] * fx + axes[1, k] * fy + axes[2, k] * fz) / GRAVITY
            felt = math.asin(min(1.0, max(-1.0, along))) + self._scale * noise[k]
            self._filtered[k] += (1.0 - self._keep) * (felt - self._filtered[k])
            self.readings[k] = self._filtered[k] + self._offsets[k]


SETTLE: Final = 1.0
"""For which a robot that is put down stands before its time begins [s]."""


class WalkerSim:
    """One walker on its ground; a `WalkerPlant`.

    Args:
        robot: The walker.
        ground: What it stands on, as it truly is.
        flaws: Of sensors, friction and masses.
        build: What the robot's file does not have.
        struts: See `walker_spec`.
    """

    def __init__(
        self,
        robot: WalkerRobot,
        ground: Ground,
        flaws: WalkerFlaws,
        *,
        build: WalkerBuild = WalkerBuild(),  # noqa: B008  # frozen
        struts: bool = False,
    ) -> None:
        import mujoco

        self.robot, self.ground, self.flaws, self.period = robot, ground, flaws, flaws.period
        self.model: Any = walker_spec(robot, ground, flaws, build=build, struts=struts).compile()
        model = self.model
        # what pays for itself with many robots costs here; and numbers that are lost are to be seen, not replaced by those of the start
        model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_ISLAND | mujoco.mjtDisableBit.mjDSBL_AUTORESET
        self._data: Any = mujoco.MjData(model)
        self._step, self._mujoco = mujoco.mj_step, mujoco
        self._surface, self._struts = Surface(ground), struts
        self._radius = foot_radius(robot, build)
        # views of memory that stays where it is: asking for one costs a microsecond
        self._qpos, self._qvel = self._data.qpos, self._data.qvel
        self._ctrl, self._act = self._data.ctrl, self._data.act
        names = (*ACTUATORS, *LEGS, *arm_names(robot))
        self._motors = np.array([model.actuator(name).id for name in names])
        self._activations = model.actuator_actadr[self._motors]
        self._ends = model.actuator_actrange[self._motors].T.copy()
        self._at_place, self._at_legs, self._at_arm = (
            np.array([model.joint(name).qposadr[0] for name in group], dtype=np.intp)
            for group in (PLACE, LEGS, arm_names(robot))
        )
        self._plate, self._bodies = model.body("delta").id, [model.body(name).id for name in FEET]
        balls = [model.geom(name).id for name in FEET]
        self._foot_of = np.full(model.ngeom, -1)
        self._foot_of[balls] = np.arange(6)
        self._tool = None if robot.arm is None else model.site("tool").id
        self._on_delta, self._on_y = robot.attachments()
        self._cells = np.random.default_rng()
        self._inclines = InclinometerPair(flaws.inclinometers, self.period, self._seed(0))
        self._aims = np.zeros(len(names))
        self._sensed = WalkerSensed(
            0.0, np.zeros(3), np.zeros((2, 3)), np.zeros((2, 3)), self._inclines.readings, np.zeros(len(self._at_arm))
        )
        self._axes, self._forces = np.eye(3), np.zeros((6, 3))
        """Of the plate, in the world, as columns; of the ground on each foot, world frame [N]: as the last step left them."""
        self.tick = 0

    def _seed(self, which: int) -> int | None:
        if self.flaws.seed is None:
            return None
        return int(np.random.SeedSequence(self.flaws.seed).spawn(3)[1 + which].generate_state(1)[0])

    @property
    def time(self) -> float:
        """Since the reset [s]."""
        return self.tick * self.period

    def reset(self, pose: Floats, place: Floats, legs: Floats, arm: Floats) -> None:
        """See `WalkerPlant`."""
        mujoco, data = self._mujoco, self._data
        mujoco.mj_resetData(self.model, data)
        self._qpos[:3] = np.asarray(pose)[:3]
        self._qpos[3:7] = plate_quaternion(*np.asarray(pose)[3:])
        self._qpos[self._at_place] = place
        self._qpos[self._at_legs] = np.ravel(legs)
        self._qpos[self._at_arm] = arm
        lengths = self._lengths()
        if self._struts:
            for i, (x, y) in enumerate(self._ways()):
                self._qpos[self.model.joint(f"barrel {i}").qposadr[0]] = math.atan2(y, x)
                self._qpos[self.model.joint(ACTUATORS[i]).qposadr[0]] = lengths[i]
        mujoco.mj_kinematics(self.model, data)
        self._axes = plate_axes(*self._qpos[3:7].tolist())
        feet = self._soles()
        self._qpos[2] -= np.min(feet[:, 2] - self._surface.heights(feet[:, :2]))
        self._aim(np.concatenate((lengths, np.ravel(legs), arm)))
        self._act[self._activations] = self._aims
        mujoco.mj_forward(self.model, data)
        self._step(self.model, data, round(SETTLE / self.model.opt.timestep))
        self._look()
        self._inclines.reset(self._axes, self._qvel[:3])
        self._cells = np.random.default_rng(self._seed(1))
        self.tick = 0

    def sense(self) -> WalkerSensed:
        """Read sensors, once a tick."""
        sensed = self._sensed
        sensed.actuators[:] = self._lengths()
        sensed.legs.ravel()[:] = self._qpos[self._at_legs]
        sensed.arm[:] = self._qpos[self._at_arm]
        sensed.forces.ravel()[:] = self._forces @ self._axes[:, 2]
        if self.flaws.force_noise > 0.0:
            sensed.forces.ravel()[:] += self.flaws.force_noise * self._cells.standard_normal(6)
        return WalkerSensed(
            self.time, sensed.actuators, sensed.legs, sensed.forces, self._inclines.readings, sensed.arm, self.tick
        )

    def actuate(self, actuators: Floats, legs: Floats, arm: Floats) -> None:
        """See `WalkerPlant`. Aims beyond a motor's stroke are cut; a motor follows a faster aim at its own top speed."""
        self._aim(np.concatenate((actuators, np.ravel(legs), arm)))

    def pause(self) -> None:
        """See `WalkerPlant`: nothing to do, as time stands still meanwhile."""

    def step(self) -> None:
        """Let one control period pass.

        Raises:
            PlantStoppedError: If the simulation has lost its numbers.
        """
        self._ctrl[self._motors] = (self._aims - self._act[self._activations]) / self.period
        self._step(self.model, self._data, self.flaws.steps)
        self._look()
        self._inclines.see(self._axes, self._qvel[:3])
        self.tick += 1

    def truth(self) -> WalkerTruth:
        """How things really are."""
        mujoco = self._mujoco
        mujoco.mj_kinematics(self.model, self._data)
        mujoco.mj_comPos(self.model, self._data)
        pose = np.array((*self._qpos[:3], *plate_angles(self._axes)))
        return WalkerTruth(
            pose,
            self._qpos[self._at_place],
            self._soles().reshape(2, 3, 3),
            self._forces.any(axis=1).astype(np.int32).reshape(2, 3),
            self._forces.reshape(2, 3, 3).copy(),
            self._data.subtree_com[self._plate].copy(),
            np.full(3, math.nan) if self._tool is None else self._data.site_xpos[self._tool].copy(),
            self._data.actuator_force[self._motors[:3]].copy(),
        )

    def _aim(self, aims: Floats) -> None:
        """Take aims, legs rounded to their motors' steps, within the strokes."""
        step = self.robot.legs.resolution
        aims[3:9] = step * np.round(aims[3:9] / step)
        np.clip(aims, *self._ends, out=self._aims)

    def _ways(self) -> Floats:
        """Along the actuators, from attachment to attachment, in the plate [m], shape (3, 2)."""
        x, y, turn = self._qpos[self._at_place]
        c, s = math.cos(turn), math.sin(turn)
        ways: Floats = self._on_y @ np.array([[c, s], [-s, c]]) - self._on_delta + (x, y)
        return ways

    def _lengths(self) -> Floats:
        """Of the actuators [m], shape (3,)."""
        lengths: Floats = np.hypot(*self._ways().T)
        return lengths

    def _look(self) -> None:
        """See what a step has done.

        Raises:
            PlantStoppedError: If the simulation has lost its numbers.
        """
        if not math.isfinite(self._qpos.sum()):
            raise PlantStoppedError("the simulation has lost its numbers")
        self._axes, self._forces = plate_axes(*self._qpos[3:7].tolist()), self._foot_forces()

    def _soles(self) -> Floats:
        """Middles of the soles as kinematics last had them [m], shape (6, 3)."""
        soles: Floats = self._data.xpos[self._bodies] - self._radius * self._axes[:, 2]
        return soles

    def _foot_forces(self) -> Floats:
        """Of the ground on each foot in the last physics step, world frame [N], shape (6, 3)."""
        forces, contact = np.zeros((6, 3)), self._data.contact
        add_forces(contact.efc_address, contact.geom, contact.frame, self._data.efc_force, self._foot_of, forces)
        return forces


def plate_quaternion(alpha: float, beta: float, gamma: float) -> Floats:
    """The turn Rz(alpha) Ry(beta) Rx(gamma) as a quaternion, real part first, shape (4,)."""
    (ca, sa), (cb, sb), (cg, sg) = ((math.cos(t / 2), math.sin(t / 2)) for t in (alpha, beta, gamma))
    return np.array(
        (
            ca * cb * cg + sa * sb * sg,
            ca * cb * sg - sa * sb * cg,
            ca * sb * cg + sa * cb * sg,
            sa * cb * cg - ca * sb * sg,
        )
    )


def plate_axes(w: float, x: float, y: float, z: float) -> Floats:
    """The plate's axes in the world, as columns, by its unit quaternion, shape (3, 3)."""
    return np.array(
        (
            (1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)),
            (2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)),
            (2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)),
        )
    )


def plate_angles(axes: Floats) -> tuple[float, float, float]:
    """Alpha, beta, gamma of the plate's axes in the world [rad]; beta within a right angle."""
    return (
        math.atan2(axes[1, 0], axes[0, 0]),
        math.asin(min(1.0, max(-1.0, -axes[2, 0]))),
        math.atan2(axes[2, 1], axes[2, 2]),
    )
