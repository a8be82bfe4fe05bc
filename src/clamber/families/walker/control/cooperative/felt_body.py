"""Where body and arm are by the robot's own sensors: lengths of actuators and legs, two inclinometers, joint angles, and planted feet."""

import math
from typing import Any

import numpy as np

from .....types import Floats
from ...robot.geometry import TwoFrames
from .planted import heading_change, turn_of
from .planted_feet import PlantedFeet
from .tool_chain import POSE


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
        beta = -float(inclines[0])
        gamma = math.asin(max(-1.0, min(1.0, math.sin(inclines[1]) / math.cos(beta))))
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
