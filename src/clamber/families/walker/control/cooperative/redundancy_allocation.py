"""The tool held by the arm and by what a walk lends of its plate: equation 19 over the feet that stand now, within the room of the step."""

from typing import Final

import numpy as np

from .....types import Floats
from ...robot import WalkerRobot
from .cooperator import Cooperator, Step
from .planted_feet import BALANCE, LEG, N_ROWS, PlantedFeet, Support
from .settings import Cooperation, own_speeds
from .tool_chain import POSE

HEIGHT: Final = 2
"""Place of z among the freedoms."""
MEASURED: Final = 0.1
"""Speed by which the height's motion is measured in the law [m/s]: by its legs' it would hardly take part; `rise` bounds it."""
TOOL_SPEED: Final = 0.2
"""By which the tool's motion is measured [m/s]."""


class RedundancyAllocation:
    """Steps of arm and plate, the plate being where walking has it and moving on as far as walking leaves it free.

    Args:
        robot: With an arm.
        payload: At the tool point [kg].
        gain: Of the manipulability's gradient [-].
        balance: Least distance of the centre of mass from the edges of the standing feet [m].
        rise: Fastest that the plate may rise or sink [m/s].
        period: Of a step [s].
    """

    def __init__(
        self, robot: WalkerRobot, *, payload: float, gain: float, balance: float, rise: float, period: float
    ) -> None:
        assert robot.arm is not None, "only robots with an arm hold something"
        speeds = own_speeds(robot)
        speeds[HEIGHT] = MEASURED
        self._robot, self._payload, self._rise = robot, payload, rise
        settings = Cooperation(
            speeds=speeds, tool_speeds=np.full(3, TOOL_SPEED), gain=gain, lent=True, period=period, balance=balance
        )  # fmt: skip
        middle = np.array([0.0, 0.0, robot.legs.nominal, 0.0, 0.0, 0.0])
        self.law = Cooperator(robot, settings, PlantedFeet(robot=robot, support="both", pose=middle))

    def stand(self, q: Floats, support: Support, place: Floats, heights: Floats, room: tuple[float, float]) -> None:
        """Stand on these feet, with the limits as they are there.

        A limit that is broken already, as a plate may by what the robot senses of it, is not to be broken farther: rest is always allowed.

        Args:
            q: Freedoms, shape (m,).
            support: What stands.
            place: Of the Y-frame in the Delta-frame, shape (3,) [m], [rad].
            heights: Of the ground under each foot, shape (2, 3) [m].
            room: Lowest and highest that the plate may be in this step [m].
        """
        robot, law = self._robot, self.law
        law.stand(
            PlantedFeet(
                robot=robot, support=support, pose=q[:POSE].copy(), offset=(float(place[0]), float(place[1])),
                twist=float(place[2]), heights=heights, payload=self._payload,
            )
        )  # fmt: skip
        chain, values = law.chain, law.limited_values(q)[q.size - POSE :]
        for row in range(LEG, BALANCE):
            if np.isfinite(chain.row_lowest[row]):  # a leg that stands is as long as the plate is high
                chain.row_lowest[row] = max(chain.row_lowest[row], values[row] + room[0] - q[HEIGHT])
                chain.row_highest[row] = min(chain.row_highest[row], values[row] + room[1] - q[HEIGHT])
                chain.row_speed[row] = min(chain.row_speed[row], self._rise)
        np.minimum(chain.row_lowest, values, out=chain.row_lowest)
        np.maximum(chain.row_highest, np.where(np.arange(N_ROWS) < BALANCE, values, np.inf), out=chain.row_highest)

    def step(self, q: Floats, target: Floats, weights: Floats) -> Step:
        """Freedoms a period later, the tool brought to a place of the world.

        Args:
            q: Freedoms now, as sensed, shape (m,); `stand` before.
            target: Of the tool then, world [m], shape (3,).
            weights: 1 for freedoms that serve it, 0 for the others, shape (m,).
        """
        law = self.law
        # the body carries the tool off within the period, and one period's motion takes it back
        return law.step(q, target, np.zeros(3), weights, feedback=1.0 / law.settings.period)
