"""A walker's picture at one moment: the ground with the walker on it, poses of its frames, lengths of its actuators."""

import math

import numpy as np
from matplotlib.axes import Axes

from ....planning.problem.problem import Replay
from ....planning.problem.problems import yardsticks_of
from ....types import Floats, Json
from ....units import DEGREE
from ....viewing.view import Part, Spread, View
from ....viewing.words import describe_pose, length_unit
from ..planning.task import WalkerTask
from ..statics.checks import WALKER_CHECKS
from .walker_artists import COLOURS, NAMES, WalkerArtists, draw_ground, draw_key, walker_bounds
from .walker_loads import actuator_gauges
from .walker_motion import WalkerMoment, settled_moment, walker_motion
from .walker_player import SCRIPT, spread_moment, walker_world


class WalkerView(View[WalkerMoment]):
    """A picture of a walk that can be set to any moment of it."""

    rows = NAMES
    script = SCRIPT

    def __init__(self, task: WalkerTask, replay: Replay) -> None:
        self.task = task
        self.moments = [settled_moment(task, stance) for stance in replay.stances]
        bounds = walker_bounds(task, self.moments)
        super().__init__(task, replay, bounds, actuator_gauges(task.robot), yardsticks_of(task))
        draw_ground(self.wall, task, bounds)
        self.robot = WalkerArtists(self.wall, task, bounds)
        for head, colour in zip(self.heads, COLOURS, strict=False):
            head.set(color=colour, weight="bold")
        draw_key(self.panel, self.key.left, self.key.top)

    def settled(self, step: int) -> WalkerMoment:
        """The stance after a step; 0 is the start."""
        return self.moments[step]

    def motion(self, step: int) -> list[Part[WalkerMoment]]:
        """The parts of a step's motion, in order."""
        return walker_motion(self.task, self.replay.stances[step - 1], self.replay.stances[step])

    def values(self, at: WalkerMoment) -> Floats:
        """Lengths of the actuators [m], shape (3,)."""
        return at.lengths

    def action(self, step: int) -> str:
        """A step in words."""
        return describe_walk(self.task, self.moments[step - 1], self.moments[step], self.reason(step))

    def facts(self, step: int, at: WalkerMoment) -> tuple[str, ...]:
        """Poses of the frames, and which of them stands."""
        return tuple(
            describe_pose(self.task, *pose) + f"  ({'lifted' if lift > 0.0 else 'stands'})"
            for pose, lift in zip(at.poses.tolist(), at.lifts, strict=True)
        )

    def world(self) -> Json:
        """Patches, goals and the shape of the robot."""
        return walker_world(self.task, self.bounds)

    def spread(self, at: WalkerMoment) -> Spread:
        """Origins and lifts of the frames; their angles."""
        return spread_moment(at)


def describe_walk(task: WalkerTask, before: WalkerMoment, after: WalkerMoment, reason: int) -> str:
    """The action that led from one settled stance to the next, in a few words."""
    words = "stays"
    stood = before.lifts.index(0.0)
    if before.lifts != after.lifts:
        words = f"{NAMES[1 - stood]} lands, {NAMES[stood]} lifts"
    else:
        dx, dy, turn = (after.poses - before.poses)[1 - stood]
        turn = math.remainder(turn, math.tau)
        unit, size = length_unit(task)
        lifted = NAMES[1 - stood]
        if max(abs(dx), abs(dy)) > 1e-9:
            axis, way = ("x", dx) if abs(dx) > abs(dy) else ("y", dy)
            words = f"{lifted} slides {abs(way) / size:.3g} {unit} along {'+' if way > 0 else '−'}{axis}"
        elif abs(turn) > 1e-9:
            words = f"{lifted} turns {turn / DEGREE:+.3g}°"
    return words if reason < 0 else f"{words}, violates {WALKER_CHECKS[reason].name}"


def draw_walk(task: WalkerTask, stance: np.void, axes: Axes) -> None:
    """Draw one stance on given axes, which get the ground alone."""
    at = settled_moment(task, stance)
    bounds = walker_bounds(task, [at])
    draw_ground(axes, task, bounds)
    WalkerArtists(axes, task, bounds).update(at)
