"""A walker that stands in contact dynamics and is led through configurations of body and arm."""

from typing import Any, Final

import numpy as np

from .....types import Floats
from ...control.cooperative.cooperator import Cooperator
from ...control.cooperative.planted import heading_change, turn_of
from ...control.cooperative.planted_feet import LEG, PlantedFeet, Support
from ...control.cooperative.tool_chain import POSE
from ...control.posture import tilt_of_inclines
from ...robot import WalkerRobot
from ...robot.geometry import TwoFrames
from ...sim.walker_flaws import WalkerFlaws
from ...sim.walker_plant import WalkerSim
from ...world.ground import load_ground


class FeltBody:
    """Tells the freedoms of a standing walker from its sensors; the feet say where in the world it is, as they were planted.

    How the robot gives under its load shows in the inclinometers, and through the legs' length in where the plate is over its feet. What
    gives along all legs alike does not show.
    """

    def __init__(self, footing: PlantedFeet) -> None:
        """Begins with the mechanism as the footing has it."""
        record: Any = footing.record()[0]
        self._frame = footing.standing()[0]
        self._anchor = record["anchor"].copy()
        self._heading = float(record["heading"])
        self._frames = TwoFrames.of(footing.robot.mechanism)
        self._place = np.array([*footing.offset, footing.twist])

    def freedoms(self, actuators: Floats, legs: Floats, inclines: Floats, arm: Floats) -> Floats:
        """Q of plate and arm.

        Args:
            actuators: Lengths [m], shape (3,); read only while the Y-frame stands.
            legs: Lengths from the plate to the soles [m], shape (2, 3).
            inclines: How far the plate's x axis and its y axis rise above the horizontal [rad], shape (2,).
            arm: Joint angles [rad], shape (joints,).

        Returns:
            Shape (6 + joints,).
        """
        beta, gamma = tilt_of_inclines(float(inclines[0]), float(inclines[1]))
        alpha = self._heading + float(heading_change(beta, gamma))
        origin_in_plate = np.zeros(3)
        if self._frame == 1:
            self._place = self._frames.follow(actuators, self._place).pose
            alpha -= float(self._place[2])
            origin_in_plate[:2] = self._place[:2]
        turn = turn_of(np.array([alpha, beta, gamma]))
        over_feet = self._anchor + float(np.mean(legs[self._frame])) * turn[:, 2]
        q = np.empty(POSE + len(arm))
        q[:3] = over_feet - turn @ origin_in_plate
        q[3:POSE] = alpha, beta, gamma
        q[POSE:] = arm
        return q


SMOOTH: Final = 0.5
"""Time over which what is felt is smoothed [s]."""


class SimulatedBody:
    """One walker on level ground, one frame standing, the other lifted."""

    def __init__(self, robot: WalkerRobot, support: Support, height: float, payload: float, period: float) -> None:
        """Put it down with its arm at rest and let it settle."""
        flaws = WalkerFlaws(payload=payload, control_rate=1.0 / period)
        self._sim = WalkerSim(robot, load_ground("level"), flaws)
        self._legs = np.full((2, 3), height)
        self._standing = 0 if support == "delta" else 1
        self._legs[1 - self._standing] -= min(robot.legs.lift, height - robot.legs.shortest)
        pose = np.array([0.0, 0.0, height, 0.0, 0.0, 0.0])
        self._sim.reset(pose, np.zeros(3), self._legs, np.array(robot.own_arm.rest))
        sensed = self._sim.sense()
        self._actuators = sensed.actuators.copy()
        # It has sunk a little into its springy feet. Where it stands now is where its path is measured from.
        bare = PlantedFeet(robot=robot, support=support, pose=self._sim.truth().pose.copy(), payload=payload)
        self.start = np.concatenate([bare.pose, robot.own_arm.rest])
        heights = _heights(bare, self._legs)
        self.footing = PlantedFeet(robot=robot, support=support, pose=bare.pose, heights=heights, payload=payload)
        self._felt = FeltBody(self.footing)
        self.off = np.zeros(3)
        """By how much the tool is felt to be off where it was led to, smoothed [m]."""
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
        self.off += self._share * (law.place(felt) - law.place(q) - self.off)
        out: Floats = self._sim.truth().tool.copy()
        return out

    def pose(self) -> Floats:
        """Where the plate truly is: x, y, z [m], alpha, beta, gamma [rad], shape (6,)."""
        return self._sim.truth().pose.copy()


def _heights(stance: PlantedFeet, legs: Floats) -> Floats:
    """Heights of the ground under each foot at which the legs have these lengths with the plate at the stance's pose [m], shape (2, 3)."""
    turn = turn_of(stance.pose[3:6])
    over = stance.robot.feet() @ turn[:, :2].T + stance.pose[:3]
    out: Floats = over[..., 2] - legs * turn[2, 2]
    return out
