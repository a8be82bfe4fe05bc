"""A climber's picture at one moment: the wall with the climber on it, its pose, holds and torques."""

import cmath
import math

import numpy as np
from matplotlib.axes import Axes

from ....planning.problem.problem import Replay
from ....planning.problem.problems import yardsticks_of
from ....types import Floats, Json
from ....units import DEGREE
from ....viewing.view import Part, Spread, View
from ....viewing.words import DIRECTIONS, describe_pose, length_unit
from ..planning.arrays import CHECKS
from ..planning.task import LimbedTask
from .climb_player import SCRIPT, climb_world, spread_snapshot
from .climber import ClimberArtists, Snapshot, arrow_ends
from .geometry import Posture, postures, stance_posture
from .motion import Phase, Transition
from .torques import draw_force_key, torque_gauges
from .wall import draw_scene, find_bounds


def describe_holds(task: LimbedTask, stance: np.void) -> str:
    """Which limb is on which hold."""
    words = []
    for i, name in enumerate(task.robot.limb_names):
        h = int(stance["hold"][i])
        words.append(f"{name} {task.world.holds[h].number if h >= 0 else 'free'}")
    return ", ".join(words)


def describe_action(task: LimbedTask, before: np.void, after: np.void, reason: int) -> str:
    """The action that led from one stance to the next, in a few words, from what it changed."""
    names, holds = task.robot.limb_names, task.world.holds
    words = []
    if int(after["resolved"]) >= 0:
        words.append(f"{names[int(after['in_use'])]} grabs {holds[int(after['resolved'])].number}")
    else:
        for i, name in enumerate(names):
            if int(before["hold"][i]) >= 0 and int(after["hold"][i]) < 0:
                words.append(f"{name} lets go of {holds[int(before['hold'][i])].number}")
    turned = float(after["turned"])
    if not words:
        words.append(_moved(task, before, after))
    if abs(turned) > 0.5 * DEGREE:
        words.append(f"swings {abs(turned) / DEGREE:.0f}°")
    if reason >= 0:
        words.append(f"violates {CHECKS[reason].replace('_', '-')}")
    return ", ".join(words)


def _moved(task: LimbedTask, before: np.void, after: np.void) -> str:
    start, end = complex(before["x"], before["y"]), complex(after["x"], after["y"])
    angle = float(after["angle"]) - float(before["angle"])
    held = [int(h) for h in after["hold"][: len(task.robot.limbs)] if h >= 0]
    if len(held) == 1:  # take the hang back, so that the move itself can be seen
        pivot = complex(task.world.holds[held[0]].x, task.world.holds[held[0]].y)
        end = pivot + (end - pivot) * cmath.exp(-1j * float(after["turned"]))
        angle -= float(after["turned"])
    way, turn = end - start, math.remainder(angle, math.tau) / DEGREE
    unit, size = length_unit(task)
    if abs(way) > 1e-6:
        name = max(DIRECTIONS, key=lambda d: (way * d[1].conjugate()).real)[0]
        return f"body {name} {abs(way) / size:.3g} {unit}"
    if abs(turn) > 1e-3:
        return f"body turns {turn:+.0f}°"
    return "stays"


class ClimbView(View[Snapshot]):
    """A picture of a climb that can be set to any moment of it.

    Forces and torques pass evenly from one stance to the next; only those of settled stances are computed.
    """

    rows = ("Pose", "Holds")
    script = SCRIPT

    def __init__(self, task: LimbedTask, replay: Replay) -> None:
        self.task = task
        self.postures: list[Posture] = postures(task.robot, task.world, replay.stances)
        self.settles = [
            settle(task, stance, posture) for stance, posture in zip(replay.stances, self.postures, strict=True)
        ]
        arrows = np.vstack([arrow_ends(task, snapshot) for snapshot in self.settles])
        bounds = find_bounds(task, self.postures, arrows)
        super().__init__(task, replay, bounds, torque_gauges(task), yardsticks_of(task))
        draw_scene(self.wall, task, bounds)
        self.robot = ClimberArtists(self.wall, task, bounds)
        draw_force_key(self.panel, task, self.key, self.layout.scale)

    def settled(self, step: int) -> Snapshot:
        """The stance after a step; 0 is the start."""
        return self.settles[step]

    def motion(self, step: int) -> list[Part[Snapshot]]:
        """The parts of a step's motion: the posture's, with the loads beside it."""
        first, last = self.settles[step - 1], self.settles[step]
        before, after = self.replay.stances[step - 1], self.replay.stances[step]

        def part(phase: Phase) -> Part[Snapshot]:
            def at(share: float, way: float) -> Snapshot:
                if way >= 1.0:
                    return last
                return Snapshot(
                    phase.at(share),
                    first.forces + (last.forces - first.forces) * way,
                    first.torques + (last.torques - first.torques) * way,
                )

            return Part(phase.kind, at)

        return [part(phase) for phase in Transition(self.task.robot, self.task.world, before, after).phases()]

    def values(self, at: Snapshot) -> Floats:
        """Torques of shoulders and elbows [N m], shape (2 n_limbs,)."""
        return at.torques.ravel()

    def action(self, step: int) -> str:
        """A step in words."""
        stances = self.replay.stances
        return describe_action(self.task, stances[step - 1], stances[step], self.reason(step))

    def facts(self, step: int, at: Snapshot) -> tuple[str, ...]:
        """Pose and holds."""
        posture = at.posture
        pose = describe_pose(self.task, posture.x, posture.y, posture.angle)
        return pose, describe_holds(self.task, self.replay.stances[step])

    def world(self) -> Json:
        """Holds, keep-outs, goals and the shape of the robot."""
        return climb_world(self.task, self.bounds)

    def spread(self, at: Snapshot) -> Spread:
        """Body, limbs and forces; directions of body and end effectors; holds."""
        return spread_snapshot(at)


def settle(task: LimbedTask, stance: np.void, posture: Posture) -> Snapshot:
    """A settled stance, as it is drawn, with its loads."""
    n = len(task.robot.limbs)
    return Snapshot(posture, np.array(stance["force"][:n]), np.array(stance["torques"][:n]))


def draw_climb(task: LimbedTask, stance: np.void, axes: Axes) -> None:
    """Draw one stance on given axes, which get the wall alone."""
    at = settle(task, stance, stance_posture(task.robot, task.world, stance))
    bounds = find_bounds(task, [at.posture], arrow_ends(task, at))
    draw_scene(axes, task, bounds)
    ClimberArtists(axes, task, bounds).update(at)
