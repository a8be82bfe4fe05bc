"""A point of the world held by the tool while the body moves as walking has it: by the arm alone or with what is lent of the plate.

And the part of a way where it can be held.
"""

from dataclasses import dataclass
from typing import Final

import numpy as np

from .....types import Floats
from ...robot import WalkerRobot
from .closest import REACHED, Reach, ReachSearch
from .cooperator import Cooperator, Step
from .freedoms import HEIGHT, weights_of
from .planted_feet import BALANCE, LEG, N_ROWS, PlantedFeet, Support
from .settings import Cooperation, own_speeds
from .tool_chain import POSE

FINE: Final = 1e-5
"""Ends of the part of a way where a point can be held are found to this share of the way between two poses [-]."""
MEASURED: Final = 0.1
"""Speed by which the height's motion is measured in the law [m/s]: by its legs' it would hardly take part; `rise` bounds it."""
TOOL_SPEED: Final = 0.2
"""By which the tool's motion is measured in the law [m/s]."""


class ToolHolder:
    """Keeps the tool at a point while the body's pose is given, step by step."""

    def __init__(self, law: Cooperator, q: Floats) -> None:
        """Begins at a configuration.

        Args:
            law: Of the motion; `stand` it anew when the feet change.
            q: Freedoms at the start, shape (m,).
        """
        self.law, self.q = law, q.copy()
        self._own = np.zeros(POSE)  # what the tool added to the body's given pose

    def step(self, pose: Floats, point: Floats, weights: Floats) -> Step:
        """Move for one period, with the body at its next pose.

        Args:
            pose: x, y, z, alpha, beta, gamma that walking gives the plate at the end of the period, shape (6,).
            point: Where the tool is to be then, world [m], shape (3,).
            weights: 1 for each freedom that may serve the tool: the arm's, and those of the plate that walking leaves, shape (m,).
        """
        ahead = self.q.copy()
        ahead[:POSE] = pose + self._own
        step = self.law.hold(ahead, point, weights)
        self.q = step.q
        self._own = np.where(weights[:POSE] > 0.0, step.q[:POSE] - pose, 0.0)
        return step


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


@dataclass(frozen=True, slots=True, eq=False)
class Reachable:
    """Where along a way of the body a point can be held."""

    parts: tuple[tuple[float, float], ...]
    """First and last place of each part where it can be, counted in poses: 2.5 is half way from pose 2 to pose 3."""
    distances: Floats
    """Of the nearest reachable place from the point at each pose [m], shape (poses,)."""
    joints: Floats
    """The arm's joints there, shape (poses, joints)."""
    heights: Floats
    """Of the plate there [m], shape (poses,)."""


def reachable_part(robot: WalkerRobot, poses: Floats, point: Floats, rooms: Floats | None = None) -> Reachable:
    """Where along a way of the body the arm alone can hold a point, or have the tool where it is to be at each pose.

    Where it cannot, and the plate has room to rise or sink, its shoulder goes as near to the point's height as that allows: a stretched
    arm reaches farthest on its shoulder's height, so nothing that limits its joints left aside, that is all of the reach.

    Args:
        robot: With an arm.
        poses: Of the plate along the way, near enough to each other that nothing happens between two, shape (poses, 6).
        point: World [m], shape (3,), or one for each pose, shape (poses, 3).
        rooms: Lowest and highest that the plate may be at each pose [m], shape (poses, 2); None: as high as `poses` have it.
    """
    arm = robot.own_arm
    points = np.broadcast_to(point, (len(poses), 3))
    n = arm.n_joints
    footing = PlantedFeet(robot=robot, support="y", pose=poses[0])
    search = ReachSearch(robot, footing, weights_of("arm", n), kept="arm")

    bounds = np.repeat(poses[:, 2, None], 2, axis=1) if rooms is None else rooms

    def at(place: float, joints: Floats) -> Reach:
        k = min(int(place), max(0, len(poses) - 2))
        pose, target, room = (
            (1.0 + k - place) * one[k] + (place - k) * one[min(k + 1, len(poses) - 1)]
            for one in (poses, points, bounds)
        )
        found = search.find(np.concatenate([pose, joints]), target, postures=rooms is None)
        if found.reached or rooms is None:
            return found
        pose[2] = min(room[1], max(room[0], target[2] - arm.up))
        there = search.find(np.concatenate([pose, joints]), target)
        return there if there.distance < found.distance else found

    distances, joints, heights = np.empty(len(poses)), np.empty((len(poses), n)), np.empty(len(poses))
    last = np.array(arm.rest)
    for k in range(len(poses)):
        found = at(float(k), last)
        distances[k], joints[k], heights[k] = found.distance, found.q[POSE:], found.q[2]
        last = joints[k]
    can = distances <= REACHED
    edges = []
    for k in np.flatnonzero(can[1:] != can[:-1]).tolist():
        inside, outside = (k, k + 1) if can[k] else (k + 1, k)
        here, there, known = float(inside), float(outside), joints[inside]
        while abs(here - there) > FINE:
            middle = 0.5 * (here + there)
            found = at(middle, known)
            if found.reached:
                here, known = middle, found.q[POSE:]
            else:
                there = middle
        edges.append(here)
    if can[0]:
        edges.insert(0, 0.0)
    if can[-1]:
        edges.append(float(len(poses) - 1))
    return Reachable(tuple(zip(edges[::2], edges[1::2], strict=True)), distances, joints, heights)
