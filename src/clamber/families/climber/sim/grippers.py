"""The grippers of a climber while it moves: jaws that close on command, catch the peg between them or none, and slip off if overloaded."""

import math
from itertools import pairwise
from typing import Any, Final

import numpy as np

from ....types import Floats, Ints
from ..control.limb_chain import chain_of_limb
from ..robot.robot import EndEffector, Limb, LimbedRobot

WIRE: Final = 0.001
"""Radius of the jaws [m]."""
BACK: Final = math.radians(60.0)
"""How far open jaws come round the tip from straight behind it, either way [rad]: a peg may come in from any direction before it."""
CHORDS: Final = 4
"""Straight pieces of that arc."""
PEG_SOLREF: Final = (0.004, 1.0)
PEG_SOLIMP: Final = (0.95, 0.99, 0.0005, 0.5, 2.0)
"""Stiff contacts and pins: under the robot's weight a peg sinks less than a tenth of a millimetre into a hook."""
RADII: Final = 6.0
"""Width between open jaws over a hold's radius, for grippers that state none [-]."""


def jaw_opening(end: EndEffector, peg_radius: float) -> float:
    """Width between a gripper's open jaws [m]."""
    return RADII * peg_radius if end.opening is None else end.opening


def capture_radius(end: EndEffector, peg_radius: float) -> float:
    """Jaws that close catch a peg whose centre is no farther than this from the tip [m]: it lies within the circle of the open jaws."""
    return jaw_opening(end, peg_radius) / 2.0


def grip_name(limb: Limb) -> str:
    """Of the constraint that is a limb's closed gripper."""
    return f"{limb.name} grip"


def add_gripper(mujoco: Any, spec: Any, link: Any, limb: Limb, tip: Floats, peg_radius: float, touch: Any) -> None:
    """Jaws behind the tip, open towards the grab direction, and the pin, which is off.

    Args:
        mujoco: The module.
        spec: An `MjSpec`.
        link: The limb's last link.
        limb: Of the robot.
        tip: In the link's frame, shape (3,) [m].
        peg_radius: Of the pegs [m].
        touch: What may touch the jaws, and how, as `add_geom` takes it.
    """
    # the ring's corners lie outside the circle that its pieces leave free
    radius = (jaw_opening(limb.end, peg_radius) / 2.0 + WIRE) / math.cos(BACK / CHORDS)
    turns = limb.end.angle + math.pi + np.linspace(-BACK, BACK, CHORDS + 1)
    corners = tip + radius * np.stack((np.cos(turns), np.sin(turns), np.zeros_like(turns)), axis=1)
    for start, end in pairwise(corners):
        link.add_geom(
            type=mujoco.mjtGeom.mjGEOM_CAPSULE, fromto=(*start, *end), size=(WIRE, 0.0, 0.0), mass=0.0, **touch
        )
    pin = spec.add_equality(name=grip_name(limb), type=mujoco.mjtEq.mjEQ_CONNECT, objtype=mujoco.mjtObj.mjOBJ_BODY)
    pin.name1, pin.active = link.name, False
    pin.data[:3] = tip
    pin.solref, pin.solimp = PEG_SOLREF, PEG_SOLIMP


GIVING_WAY: Final = 0.02
"""A peg is out of the jaws after that long above their strength; shorter knocks, as at the ends of the joints' play, open no jaws [s]."""
CLOSING: Final = 0.25
"""Time in which closing jaws bring the peg that they caught to their middle [s]."""


class Grippers:
    """Opens and closes the grippers of one climber.

    A gripper that closes catches the nearest peg whose centre is within its capture radius of the tip at that moment, or nothing: then it
    stays shut on nothing until it is opened. The pin takes the peg where it is and brings it to the tip while the jaws close. Forces are
    looked at once a control period, those of its last physics step.

    Args:
        robot: The climber; limbs without a gripper are left out.
        pegs: Where they truly are, shape (n, 2) [m].
        peg_radius: Of the widest [m].
        model, data: MuJoCo's, of `climber_spec`.
        period: Of the control [s].
    """

    def __init__(
        self, robot: LimbedRobot, pegs: Floats, peg_radius: float, model: Any, data: Any, period: float
    ) -> None:
        self._model, self._data, self._pegs = model, data, pegs
        n = len(robot.limbs)
        self.limbs = [i for i, limb in enumerate(robot.limbs) if limb.end.kind == "gripper"]
        """Indices of the limbs that have one."""
        self.gripped: Ints = np.zeros(n, np.int32)
        """1 where jaws are closed about a peg: what a gap sensor in the jaws tells, shape (limbs,)."""
        self.forces = np.zeros(n)
        """What closed jaws take, shape (limbs,) [N]."""
        self.pulls = np.zeros((n, 3))
        """Force of closed jaws on their peg, world frame, shape (limbs, 3) [N]."""
        self.caught: Ints = np.full(n, -1, np.int32)
        """Index of the peg that closed jaws are about, or were last, shape (limbs,)."""
        self._gone = np.zeros(len(pegs), bool)
        self.slips = 0
        """How often a peg has been lost to too much force."""
        ends = [limb.end for limb in robot.limbs]
        self._strength = [math.inf if end.strength is None else end.strength for end in ends]
        self._capture = [capture_radius(end, peg_radius) for end in ends]
        self._pins = {i: model.equality(grip_name(robot.limbs[i])).id for i in self.limbs}
        self._tips = {i: chain_of_limb(robot, robot.limbs[i].name).root["tip"][0].copy() for i in self.limbs}
        self._shut: Ints = np.zeros(n, np.int32)
        self._caught_at = np.zeros((n, 3))
        self._part, self._over, self._period = np.ones(n), np.zeros(n), period

    def reset(self) -> None:
        """Open all."""
        self.gripped[:] = 0
        self._shut[:] = 0
        self._over[:] = 0.0
        self.forces[:] = 0.0
        self.slips = 0
        self._gone[:] = False
        for pin in self._pins.values():
            self._data.eq_active[pin] = 0

    def act(self, closed: Ints) -> None:
        """Open or close: before the physics of a control period.

        Args:
            closed: 1 for grippers that are to be shut, shape (limbs,).
        """
        for i in self.limbs:
            if closed[i] and not self._shut[i]:
                self._close(i)
            elif not closed[i] and self._shut[i]:
                self._let_go(i)
                self._shut[i] = 0
            if self.gripped[i] and self._part[i] < 1.0:
                self._part[i] = min(1.0, self._part[i] + self._period / CLOSING)
                u = self._part[i]
                eased = u * u * (3.0 - 2.0 * u)
                tip = self._tips[i]
                self._model.eq_data[self._pins[i], :3] = self._caught_at[i] + eased * (tip - self._caught_at[i])

    def feel(self) -> None:
        """Let go where the force is too much: after the physics of a control period."""
        data = self._data
        for i in self.limbs:
            if self.gripped[i]:
                # rows of equality constraints come first
                rows = data.efc_id[: data.ne] == self._pins[i]
                self.pulls[i] = -data.efc_force[: data.ne][rows]
                self.forces[i] = math.sqrt(float(np.sum(np.square(self.pulls[i]))))
                self._over[i] = self._over[i] + self._period if self.forces[i] > self._strength[i] else 0.0
                if self._over[i] >= GIVING_WAY:
                    self._let_go(i)
                    self.slips += 1

    def lose(self, peg: int) -> None:
        """Let a peg go that is no more: jaws about it stay shut on nothing, and none catches it again."""
        self._gone[peg] = True
        for i in self.limbs:
            if self.gripped[i] and self.caught[i] == peg:
                self._let_go(i)

    def _close(self, i: int) -> None:
        self._shut[i] = 1
        data, pin = self._data, self._pins[i]
        body = self._model.eq_obj1id[pin]
        turn = data.xmat[body].reshape(3, 3)
        tip = data.xpos[body] + turn @ self._tips[i]
        away = np.hypot(*(self._pegs - tip[:2]).T)
        away[self._gone] = math.inf
        nearest = int(np.argmin(away))
        if away[nearest] > self._capture[i]:
            return
        peg = np.array((*self._pegs[nearest], 0.0))
        self._caught_at[i] = turn.T @ (peg - data.xpos[body])
        self._model.eq_data[pin, :3], self._model.eq_data[pin, 3:6] = self._caught_at[i], peg
        self._part[i] = 0.0
        data.eq_active[pin] = 1
        self.gripped[i], self.caught[i] = 1, nearest

    def _let_go(self, i: int) -> None:
        self._data.eq_active[self._pins[i]] = 0
        self.gripped[i] = 0
        self.forces[i] = self._over[i] = 0.0
