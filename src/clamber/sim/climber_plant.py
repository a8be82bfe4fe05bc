"""The whole climber in MuJoCo as a plant: encoders of every joint and of the body's angle in, torques out, the truth for logs and tests."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from ..control.chain import chain_of_limb
from ..robots.limbed import LimbedRobot
from ..types import Floats
from ..worlds.board import Board
from .climber_model import HookShape, climber_spec
from .electronics import limit_torques, read_encoders
from .limb_flaws import LimbFlaws
from .pinned_tips import pin_tips

BODY_COUNTS: Final = 4000
"""Of the body's own encoder, a turn; nobody prints it, so ours."""


@dataclass(frozen=True, slots=True, eq=False)
class BodySensed:
    """What the sensors of a climber say at a tick; the arrays are the plant's own."""

    q: Floats
    """Joint angles by the motors' encoders, shape (limbs, 2) [rad]."""
    qd: Floats
    """Their speeds, shape (limbs, 2) [rad/s]."""
    angle: float
    """Body angle by the seventh encoder [rad]."""
    angle_speed: float
    """[rad/s]."""


@dataclass(frozen=True, slots=True, eq=False)
class BodyTruth:
    """How the climber really is: for logs and tests."""

    pose: Floats
    """Body x, y [m], theta [rad], world frame."""
    q: Floats
    """Joint angles at the gears' outputs, shape (limbs, 2) [rad]."""
    tips: Floats
    """World frame, shape (limbs, 2) [m]."""
    torques: Floats
    """Of the motors over the last tick, shape (limbs, 2) [N m]."""


class ClimberPlant:
    """One climber on its board.

    Args:
        robot: The climber.
        board: Its holds as believed.
        flaws: Of joints, motors and sensors.
        pegs: Where the holds truly are, shape (n_holds, 2) [m]; None: as believed.
        shape: Of the hooks.
        pinned: Limb -> hold that its tip is fixed to; others only hook on.
    """

    def __init__(
        self,
        robot: LimbedRobot,
        board: Board,
        flaws: LimbFlaws,
        *,
        pegs: Floats | None = None,
        shape: HookShape = HookShape(),  # noqa: B008  # frozen
        pinned: Mapping[str, int] | None = None,
    ) -> None:
        import mujoco

        self.robot, self.board, self.flaws, self.period = robot, board, flaws, flaws.period
        spec = climber_spec(robot, board, flaws, pegs=pegs, shape=shape)
        pin_tips(spec, board, pinned or {}, pegs)
        self.model: Any = spec.compile()
        self._data: Any = mujoco.MjData(self.model)
        self._step = mujoco.mj_step
        chains = [chain_of_limb(robot, limb.name) for limb in robot.limbs]
        names = [name for chain in chains for name in chain.joint_names]
        joints = [self.model.joint(name) for name in names]
        self._at = np.array([2, *(joint.qposadr[0] for joint in joints)])
        self._speed_at = np.array([2, *(joint.dofadr[0] for joint in joints)])
        self._play = np.array([joint.qposadr[0] + 1 for joint in joints]) if flaws.backlash > 0.0 else None
        self._motors = np.array([self.model.actuator(name).id for name in names])
        self._sites = np.array([self.model.site(f"{limb.name} tip").id for limb in robot.limbs])
        records = np.concatenate([chain.joints for chain in chains])
        gears = [joint.gear for limb in robot.limbs for joint in (limb.shoulder, limb.elbow)]
        counts = flaws.encoder_counts * np.array([BODY_COUNTS / max(flaws.encoder_counts, 1), *gears]) / (2 * np.pi)
        self._counts = counts
        n = len(names)
        self._limits, self._no_load = records["limit"].copy(), records["speed"].copy()
        self._agility = (
            2.0 * self._limits / records["rotor"]
        )  # a load on the motor's side brings no more than the motor itself
        self._also = np.zeros((1, n))
        self._angles, self._speeds = np.zeros((1, n + 1)), np.zeros((1, n + 1))
        self._ring, self._before = np.zeros((flaws.delay + 1, 1, 2, n + 1)), np.zeros((1, n + 1))
        self._states = np.zeros((1, 2, n + 1))
        self._wanted, self._given = np.zeros((1, n)), np.zeros((1, n))
        self._pushed = self._data.xfrc_applied[self.model.body("body").id]
        self.tick = 0

    @property
    def time(self) -> float:
        """Since the reset [s]."""
        return self.tick * self.period

    def reset(self, pose: Floats, q: Floats) -> None:
        """Put the body at a pose (x, y, theta) with joint angles q, shape (limbs, 2), at rest."""
        import mujoco

        mujoco.mj_resetData(self.model, self._data)
        self._data.qpos[:3] = pose
        self._data.qpos[self._at[1:]] = np.ravel(q)
        mujoco.mj_forward(self.model, self._data)
        self._wanted[:] = 0.0
        self._ring[:] = 0.0
        self.tick = 0

    def sense(self) -> BodySensed:
        """Read the sensors, once a tick."""
        self._angles[0] = self._data.qpos[self._at]
        self._speeds[0] = self._data.qvel[self._speed_at]
        read_encoders(
            self._angles, self._speeds, self._counts, self.period, self.tick, self._ring, self._before, self._states
        )
        state = self._states[0]
        return BodySensed(
            state[0, 1:].reshape(-1, 2), state[1, 1:].reshape(-1, 2), float(state[0, 0]), float(state[1, 0])
        )

    def actuate(self, torques: Floats) -> None:
        """Set the motors' torques, held until the next call, shape (limbs, 2) [N m]."""
        self._wanted[0] = np.ravel(torques)

    def push(self, force: tuple[float, float]) -> None:
        """Push the body at its centre until the next call, world frame [N]."""
        self._pushed[:2] = force

    def step(self) -> None:
        """Let one control period pass."""
        self._speeds[0] = self._data.qvel[self._speed_at]
        steady = self._limit(self.period)
        if steady:
            self._step(self.model, self._data, self.flaws.steps)
        else:  # near a limit the torque follows the speed at every physics step
            for _ in range(self.flaws.steps):
                self._speeds[0] = self._data.qvel[self._speed_at]
                self._limit(0.0)
                self._step(self.model, self._data, 1)
        self.tick += 1

    def _limit(self, time: float) -> bool:
        """Put what the motors give at the present speeds on the joints; whether that may be held for `time` [s]."""
        steady: bool = limit_torques(
            self._wanted, self._speeds[:, 1:], self._limits, self._no_load, self._agility, time, self._given, self._also
        )
        self._data.ctrl[self._motors] = self._given[0]
        return steady

    def truth(self) -> BodyTruth:
        """How things really are."""
        q = self._data.qpos[self._at[1:]].copy()
        if self._play is not None:
            q += self._data.qpos[self._play]
        return BodyTruth(
            self._data.qpos[:3].copy(),
            q.reshape(-1, 2),
            self._data.site_xpos[self._sites, :2].copy(),
            self._given[0].reshape(-1, 2).copy(),
        )
