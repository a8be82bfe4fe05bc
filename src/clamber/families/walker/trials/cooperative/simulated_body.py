"""A walker that stands in contact dynamics and is led through configurations of body and arm."""

from typing import Final

import numpy as np

from .....types import Floats
from ...control.cooperative.cooperator import Cooperator
from ...control.cooperative.felt_body import FeltBody
from ...control.cooperative.planted import turn_of
from ...control.cooperative.planted_feet import LEG, PlantedFeet, Support
from ...control.cooperative.tool_chain import POSE
from ...robot import WalkerRobot
from ...sim.walker_flaws import WalkerFlaws
from ...sim.walker_plant import WalkerSim
from ...world.library import load_ground

SMOOTH: Final = 0.5
"""Time over which what is felt is smoothed [s]."""


class SimulatedBody:
    """One walker on level ground, one frame standing, the other lifted."""

    def __init__(self, robot: WalkerRobot, support: Support, height: float, payload: float, period: float) -> None:
        """Put it down with its arm at rest and let it settle."""
        arm = robot.arm
        assert arm is not None, "only robots with an arm follow paths"
        flaws = WalkerFlaws(payload=payload, control_rate=1.0 / period)
        self._sim = WalkerSim(robot, load_ground("level"), flaws)
        self._legs = np.full((2, 3), height)
        self._standing = 0 if support == "delta" else 1
        self._legs[1 - self._standing] -= min(robot.legs.lift, height - robot.legs.shortest)
        pose = np.array([0.0, 0.0, height, 0.0, 0.0, 0.0])
        self._sim.reset(pose, np.zeros(3), self._legs, np.array(arm.rest))
        sensed = self._sim.sense()
        self._actuators = sensed.actuators.copy()
        # It has sunk a little into its springy feet. Where it stands now is where its path is measured from.
        bare = PlantedFeet(robot=robot, support=support, pose=self._sim.truth().pose.copy(), payload=payload)
        self.start = np.concatenate([bare.pose, arm.rest])
        heights = _heights(bare, self._legs)
        self.footing = PlantedFeet(robot=robot, support=support, pose=bare.pose, heights=heights, payload=payload)
        self._felt = FeltBody(self.footing)
        self._off = np.zeros(3)
        self._share = period / SMOOTH

    def move(self, law: Cooperator, q: Floats) -> Floats:
        """Lead it to a configuration within one period; where the tool truly is then [m], shape (3,)."""
        values = law.limited_values(q)[len(q) - POSE :]
        legs = self._legs.copy()
        first = LEG + 3 * self._standing
        legs[self._standing] = values[first : first + 3]
        actuators = values[:3] if self._standing == 1 else self._actuators
        self._sim.actuate(actuators, legs, q[POSE:])
        self._sim.step()
        sensed = self._sim.sense()
        felt = self._felt.freedoms(sensed.actuators, sensed.legs, sensed.inclines, sensed.arm)
        self._off += self._share * (law.place(felt) - law.place(q) - self._off)
        out: Floats = self._sim.truth().tool.copy()
        return out

    def pose(self) -> Floats:
        """Where the plate truly is: x, y, z [m], alpha, beta, gamma [rad], shape (6,)."""
        return self._sim.truth().pose.copy()

    @property
    def off(self) -> Floats:
        """By how much the tool is felt to be off where it was led to, smoothed [m], shape (3,)."""
        return self._off


def _heights(stance: PlantedFeet, legs: Floats) -> Floats:
    """Heights of the ground under each foot at which the legs have these lengths with the plate at the stance's pose [m], shape (2, 3)."""
    turn = turn_of(stance.pose[3:6])
    over = stance.robot.feet() @ turn[:, :2].T + stance.pose[:3]
    out: Floats = over[..., 2] - legs * turn[2, 2]
    return out
