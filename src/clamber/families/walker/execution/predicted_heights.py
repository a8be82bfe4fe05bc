"""How high the plate may be along a way, step by step, on ground that goes on as the feet feel it: gone through before the first step."""

from dataclasses import dataclass

import numpy as np

from ....types import Floats
from ..control.track import Track
from ..robot import WalkerRobot
from ..robot.plane_poses import placed
from . import motions
from .footstep_plan import ImaginedWalker, TrackCourse
from .walker import Walker

ALIKE = 1e-6
"""Places of the way that are nearer count as one [m]."""


@dataclass(frozen=True, slots=True, eq=False)
class Heights:
    """Heights of the plate while the Delta-frame is between two places of its way, one row for each step."""

    ways: Floats
    """First and last of them, the same while the Y-frame goes [m], shape (steps, 2)."""
    rooms: Floats
    """Lowest, own and highest [m], shape (steps, 3)."""

    def at(self, ways: Floats) -> Floats:
        """Lowest, own and highest that every step allows that the plate is there in, shape (n, 3) [m]."""
        out = np.empty((len(ways), 3))
        for k, way in enumerate(ways):
            there = (self.ways[:, 0] <= way + ALIKE) & (way - ALIKE <= self.ways[:, 1])
            if not there.any():
                there[int(np.argmin(np.abs(self.ways - way).min(axis=1)))] = True
            low, high = float(self.rooms[there, 0].max()), float(self.rooms[there, 2].min())
            own = float(self.rooms[there, 1].mean())
            out[k] = (low, min(high, max(low, own)), high) if low <= high else (own, own, own)
        return out


def predict_heights(walker: Walker, track: Track, arm: Floats) -> Heights:
    """Heights along a track, by the steps that mechanism and balance allow with the arm in a posture.

    Args:
        walker: The robot where the way begins, level.
        track: Where its Delta-frame goes.
        arm: Joint angles [rad].
    """
    robot, slope = walker.robot, walker.ground_slope()
    floor = float(walker.heights[walker.stands > 0].mean()) - float(
        slope @ walker.anchors[walker.stands > 0].mean(axis=0)
    )
    imagined = ImaginedWalker(robot, walker.settings, walker.payload, arm, walker.frames().copy())
    course = TrackCourse(track, neutral=float(walker.place[2]))
    clear = robot.legs.lift if walker.settings.lift is None else walker.settings.lift
    ways, rooms, at = [], [], 0.0
    for step in imagined.steps(course):
        landed = imagined.placed.copy()
        landed[step.swing] = step.end
        before, after = (_ground_under(robot, frames, slope, floor) for frames in (imagined.placed, landed))
        low, high = np.minimum(before, after), np.maximum(before, after)
        lifts = np.zeros((2, 3))
        lifts[step.swing] = clear
        rooms.append(
            motions.room_of_heights(
                robot.legs, longest=-float(low.min()), shortest=-float(high.max()), lifted=-float((high + lifts).max())
            )
        )
        ways.append((at, step.way if step.swing == 0 else at))
        at = ways[-1][1]
    return Heights(np.array(ways).reshape(-1, 2), np.array(rooms).reshape(-1, 3))


def _ground_under(robot: WalkerRobot, frames: Floats, slope: Floats, floor: float) -> Floats:
    """Heights of the ground under all feet, shape (2, 3) [m]."""
    return np.array([floor + placed(feet, pose) @ slope for feet, pose in zip(robot.feet(), frames, strict=True)])
