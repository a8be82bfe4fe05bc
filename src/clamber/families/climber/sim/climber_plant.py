"""The whole climber in MuJoCo as a plant: encoders of every joint and of the body's angle in, torques out, the truth for logs and tests."""

from collections.abc import Mapping
from typing import Any, Final

import numpy as np

from ....compiled import Handle, ready
from ....execution.plant import BodySensed, BodyTruth
from ....sim.force_sensing import WrenchReader
from ....sim.limb_flaws import ForceSensor, LimbFlaws
from ....types import Floats, Ints
from ..control.limb_chain import chain_of_limb
from ..execution.postures import postures
from ..execution.wiring import encoder_resolution
from ..robot.robot import LimbedRobot
from ..world.board import Board
from .climber_model import HookShape, climber_spec
from .climber_wires import command_motors, sense_climber, tell_truth
from .grippers import Grippers
from .hold_limits import HoldLimits

PIN_SOLREF: Final = (0.002, 1.0)
"""As stiff as two physics steps of 1 ms allow: under the robot's weight a tip gives way by some hundredths of a millimetre."""
PIN_SOLIMP: Final = (0.99, 0.999, 0.0005, 0.5, 2.0)


def pin_tips(spec: Any, board: Board, pinned: Mapping[str, int], pegs: Floats | None = None) -> None:
    """Fix tips of a climber's `MjSpec` to their pegs by constraints; those pegs touch nothing any more.

    Args:
        spec: Of `climber_spec`.
        board: Its holds as believed.
        pinned: Limb -> number of the hold.
        pegs: Where the holds truly are, shape (n_holds, 2) [m]; None: as believed.
    """
    import mujoco

    places = board.positions() if pegs is None else pegs
    numbers = [hold.number for hold in board.holds]
    for limb, number in pinned.items():
        x, y = places[numbers.index(number)]
        spec.worldbody.add_site(name=f"pin {number}", pos=(x, y, 0.0))
        pin = spec.add_equality(name=f"{limb} pinned", type=mujoco.mjtEq.mjEQ_CONNECT, objtype=mujoco.mjtObj.mjOBJ_SITE)
        pin.name1, pin.name2 = f"{limb} tip", f"pin {number}"
        pin.solref, pin.solimp = PIN_SOLREF, PIN_SOLIMP
        peg = spec.geom(f"peg {number}")
        peg.contype, peg.conaffinity = 0, 0


ON_HOLD: Final = 1e-4
"""A tip this near to a hold is on it [m]."""


class ClimberPlant:
    """One climber on its board.

    Args:
        robot: The climber.
        board: Its holds as believed.
        flaws: Of joints, motors and sensors.
        pegs: Where the holds truly are, shape (n_holds, 2) [m]; None: as believed.
        shape: Of the hooks.
        pinned: Limb -> hold that its tip is fixed to; others only hook on.
        offsets: What every encoder tells too much: the body's, then the joints', shape (1 + 2 limbs,) [rad]; None: nothing.
        presser: The limb that presses against the wall of `flaws`, if it has one.
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
        offsets: Floats | None = None,
        presser: str | None = None,
    ) -> None:
        import mujoco

        self.robot, self.board, self.flaws, self.period = robot, board, flaws, flaws.period
        spec = climber_spec(robot, board, flaws, pegs=pegs, shape=shape, presser=presser)
        pin_tips(spec, board, pinned or {}, pegs)
        self.model: Any = spec.compile()
        # what pays for itself with hundreds of geoms and many robots costs a tenth of a step here
        self.model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_MIDPHASE | mujoco.mjtDisableBit.mjDSBL_ISLAND
        self._data: Any = mujoco.MjData(self.model)
        self._step, self._steps = mujoco.mj_step, flaws.steps
        chains = [chain_of_limb(robot, limb.name) for limb in robot.limbs]
        names = [name for chain in chains for name in chain.joint_names]
        joints = [self.model.joint(name) for name in names]
        # views of memory that stays where it is: asking for one costs a microsecond
        self._qpos, self._qvel = self._data.qpos, self._data.qvel
        self._site_places = self._data.site_xpos
        self._at = np.array([2, *(joint.qposadr[0] for joint in joints)])
        self._speed_at = np.array([2, *(joint.dofadr[0] for joint in joints)])
        motors = np.array([self.model.actuator(name).id for name in names])
        self._sites = np.array([self.model.site(f"{limb.name} tip").id for limb in robot.limbs])
        records = np.concatenate([chain.joints for chain in chains])
        # the body's first, as in qpos
        counts = np.roll(encoder_resolution(robot, flaws.encoder_counts), 1)
        n = len(names)
        limits, no_load = records["limit"].copy(), records["speed"].copy()
        agility = 2.0 * limits / records["rotor"]  # a load on the motor's side brings no more than the motor itself
        self._ring, self._states = np.zeros((flaws.delay + 1, 1, 2, n + 1)), np.zeros((1, 2, n + 1))
        encoders = Handle(
            self._qpos, self._qvel, self._at, self._speed_at, np.zeros(1 + n) if offsets is None else offsets, np.zeros((1, n + 1)),
            np.zeros((1, n + 1)), counts, self.period, self._ring, np.zeros((1, n + 1)), self._states,
        )  # fmt: skip
        self._sense = ready(sense_climber, encoders, 0)
        self._q, self._qd = (self._states[0, k, 1:].reshape(-1, 2) for k in (0, 1))
        self._wanted, self._given = np.zeros((1, n)), np.zeros((1, n))
        self._wanted_by_limb = self._wanted.reshape(-1, 2)
        wires = Handle(
            self._wanted, self._qvel, self._speed_at, np.zeros((1, n)), limits, no_load, agility, self._given, np.zeros((1, n)), motors,
            self._data.ctrl,
        )  # fmt: skip
        self._drive = ready(command_motors, wires, self.period)
        """Puts what the motors give at the present speeds on the joints; whether that may be held for a time [s]."""
        told = Handle(self._qpos, self._at, int(flaws.backlash > 0.0), self._site_places, self._sites, self._given)
        self._tell = ready(tell_truth, told, np.empty(3), *np.empty((3, len(robot.limbs), 2)))
        self._pushed = self._data.xfrc_applied[self.model.body("body").id]
        self._believed = board.positions()
        self._pegs = self._believed if pegs is None else pegs
        radius = max(hold.radius for hold in board.holds)
        self.grippers = Grippers(robot, self._pegs, radius, self.model, self._data, self.period)
        self._hold_limits = HoldLimits(board, robot.weight, self.grippers, self.model, self._data, self.period)
        self._grips = np.zeros(len(robot.limbs), np.int32)
        self._press: WrenchReader | None = None
        if presser is not None and flaws.wall is not None:
            sensor = ForceSensor() if flaws.wrist is None else flaws.wrist
            self._press = WrenchReader(sensor, period=self.period, delay=flaws.delay, batch=1)
        self.tick = 0

    @property
    def time(self) -> float:
        """Since the reset [s]."""
        return self.tick * self.period

    def reset(self, pose: Floats, q: Floats) -> None:
        """Put the body at a pose (x, y, theta) with joint angles q, shape (limbs, 2), at rest.

        Tips that are then where a hold is believed to be are put on that hold, where it truly is.
        """
        import mujoco

        mujoco.mj_resetData(self.model, self._data)
        self._hold_limits.reset()
        self._qpos[:3] = pose
        self._qpos[self._at[1:]] = np.ravel(q)
        mujoco.mj_forward(self.model, self._data)
        self._qpos[self._at[1:]] = self._seated(pose, q).ravel()
        mujoco.mj_forward(self.model, self._data)
        self._wanted[:] = 0.0
        self._grips[:] = 0
        self.grippers.reset()
        self._ring[:] = 0.0
        self.tick = 0

    def _seated(self, pose: Floats, q: Floats) -> Floats:
        """Joint angles with tips on the true holds, of limbs that reach them, shape (limbs, 2) [rad]."""
        out = q.copy()
        for i, (limb, tip) in enumerate(zip(self.robot.limbs, self._site_places[self._sites, :2], strict=True)):
            off = np.hypot(*(self._believed - tip).T)
            hold = int(np.argmin(off))
            if off[hold] < ON_HOLD:
                fit = [one.angles for one in postures(limb, pose, self._pegs[hold]) if one.inside]
                if fit:
                    out[i] = fit[int(np.argmin([np.abs(angles - q[i]).max() for angles in fit]))]
        return out

    def sense(self) -> BodySensed:
        """Read the sensors, once a tick."""
        self._sense(self.tick)
        return BodySensed(
            self._q, self._qd, self._states.item(0, 0, 0), self._states.item(0, 1, 0), self.grippers.gripped, self.tick
        )

    def actuate(self, torques: Floats, grips: Ints) -> None:
        """Set the motors' torques, shape (limbs, 2) [N m], and the grippers that are shut, 1 or 0, shape (limbs,), until the next call."""
        self._wanted_by_limb[:] = torques
        self._grips[:] = grips

    def sense_press(self) -> Floats:
        """Force of the pressing tip on the wall by its sensor, along the last link and across it, once a tick, shape (2,) [N].

        Forces are those of the last physics step.
        """
        assert self._press is not None
        return self._press.read(self._data.sensordata[None, -6:], self.tick)[0, :2]

    def true_press(self) -> float:
        """True force on the wall along its normal [N]."""
        turn = self._data.site_xmat[self.model.site("hand").id].reshape(3, 3)
        force = turn @ self._data.sensordata[-6:-3]
        angle = self.flaws.wall.angle if self.flaws.wall is not None else 0.0
        return float(np.cos(angle) * force[0] + np.sin(angle) * force[1])

    def push(self, force: tuple[float, float]) -> None:
        """Push the body at its centre until the next call, world frame [N]."""
        self._pushed[:2] = force

    def weaken(self, hold: int, strength: float) -> None:
        """Give a hold another strength [N] than its board states, until the next reset."""
        self._hold_limits.weaken(hold, strength)

    def pause(self) -> None:
        """See `BodyPlant`: nothing to do, as time stands still meanwhile."""

    def step(self) -> None:
        """Let one control period pass."""
        self.grippers.act(self._grips)
        if self._drive(self.period):
            self._step(self.model, self._data, self._steps)
        else:  # near a limit the torque follows the speed at every physics step
            for _ in range(self._steps):
                self._drive(0.0)
                self._step(self.model, self._data, 1)
        self.grippers.feel()
        self.tick += 1
        self._hold_limits.feel(self.time)

    def truth(self) -> BodyTruth:
        """How things really are."""
        pose, (q, tips, torques) = np.empty(3), np.empty((3, len(self._sites), 2))
        self._tell(pose, q, tips, torques)
        return BodyTruth(pose, q, tips, torques, self._hold_limits.broken)
