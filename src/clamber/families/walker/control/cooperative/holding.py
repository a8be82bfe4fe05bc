"""A point of the world held by the tool while the body moves as walking has it: one step, and the part of a way where it can be held."""

from dataclasses import dataclass
from typing import Final

import numpy as np

from .....types import Floats
from ...robot import WalkerRobot
from .closest import REACHED, Reach, ReachSearch
from .cooperator import Cooperator, Step
from .freedoms import weights_of
from .planted_feet import PlantedFeet
from .tool_chain import POSE

FINE: Final = 1e-5
"""Ends of the part of a way where a point can be held are found to this share of the way between two poses [-]."""


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
        # the body carries the tool off within the period, and one period's motion of the arm takes it back
        step = self.law.step(ahead, point, np.zeros(3), weights, feedback=1.0 / self.law.settings.period)
        self.q = step.q
        self._own = np.where(weights[:POSE] > 0.0, step.q[:POSE] - pose, 0.0)
        return step


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
    assert robot.arm is not None, "only robots with an arm move it"
    points = np.broadcast_to(point, (len(poses), 3))
    n = robot.arm.n_joints
    footing = PlantedFeet(robot=robot, support="y", pose=poses[0])
    search = ReachSearch(robot, footing, weights_of("arm", n), kept="arm")

    bounds = np.repeat(poses[:, 2, None], 2, axis=1) if rooms is None else rooms
    up = robot.arm.up

    def at(place: float, joints: Floats) -> Reach:
        k = min(int(place), max(0, len(poses) - 2))
        pose, target, room = (
            (1.0 + k - place) * one[k] + (place - k) * one[min(k + 1, len(poses) - 1)]
            for one in (poses, points, bounds)
        )
        found = search.find(np.concatenate([pose, joints]), target, postures=rooms is None)
        if found.reached or rooms is None:
            return found
        pose[2] = min(room[1], max(room[0], target[2] - up))
        there = search.find(np.concatenate([pose, joints]), target)
        return there if there.distance < found.distance else found

    distances, joints, heights = np.empty(len(poses)), np.empty((len(poses), n)), np.empty(len(poses))
    last = np.array(robot.arm.rest)
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
