"""A climber's plan at any moment, and what happens between its stances: the body moves, hangs and swings, a limb reaches out."""

import cmath
import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Final

import numpy as np
from matplotlib.axes import Axes

from ....planning.problem.problem import Replay
from ....types import Floats
from ....units import DEGREE
from ....viewing.recording import Part, PlanView
from ....viewing.scene import DIRECTIONS, describe_pose, fit_bounds, length_unit
from ....viewing.view import CloseUp, Picture
from ..planning.arrays import CHECKS
from ..planning.task import LimbedTask
from ..robot.robot import Limb, LimbedRobot
from ..world.board import Board
from .artists import ClimberArtists, Snapshot, arrow_ends, draw_force_key, draw_scene, find_bounds, torque_gauges
from .geometry import Posture, pose, stance_posture, stance_sides, stance_tips

LIFT: Final = 0.12
"""By what share of its length a reaching limb draws its tip in, half-way [-]."""
STILL: Final = 1e-9


@dataclass(frozen=True, slots=True)
class Phase:
    """One part of an action's motion."""

    kind: str
    """"move", "swing", "reach", "release" or "still"."""
    at: Callable[[float], Posture]
    """The posture at a share of the phase in [0, 1], both ends included."""


def hold_place(board: Board, index: int) -> complex:
    """Centre of a hold, world frame [m]."""
    return complex(board.holds[index].x, board.holds[index].y)


class Transition:
    """The motion from one stance record to the next."""

    def __init__(self, robot: LimbedRobot, board: Board, before: np.void, after: np.void) -> None:
        self.robot, self.board, self.before, self.after = robot, board, before, after
        n = len(robot.limbs)
        self.old = tuple(int(h) for h in before["hold"][:n])
        self.new = tuple(int(h) for h in after["hold"][:n])
        self.start = complex(before["x"], before["y"]), float(before["angle"])
        self.end = complex(after["x"], after["y"]), float(after["angle"])
        self.tips = stance_tips(robot, board, before)
        self.end_tips = stance_tips(robot, board, after)
        self.sides = stance_sides(robot, before, self.tips), stance_sides(robot, after, self.end_tips)
        self.reaching = tuple(new >= 0 and new != old for old, new in zip(self.old, self.new, strict=True))
        self.staying = tuple(new >= 0 and new == old for old, new in zip(self.old, self.new, strict=True))
        self.turned = float(after["turned"])
        # The pose before the swing: the end, turned back about the hold that the robot hung on.
        self.pivot = self._pivot()
        self.middle = self.end
        if self.pivot is not None:
            at, angle = self.end
            back = cmath.exp(-1j * self.turned)
            self.middle = self.pivot + (at - self.pivot) * back, angle - self.turned

    def _pivot(self) -> complex | None:
        if abs(self.turned) < STILL:
            return None
        stay = [h for h, stays in zip(self.new, self.staying, strict=True) if stays]
        holding = stay if len(stay) == 1 else [h for h in self.new if h >= 0]
        return hold_place(self.board, holding[0]) if len(holding) == 1 else None

    def phases(self) -> list[Phase]:
        """The parts of the motion, in order; at least one."""
        grabs_alone = self.pivot is not None and any(self.reaching) and not any(self.staying)
        made: list[Phase] = []
        turn = math.remainder(self.middle[1] - self.start[1], math.tau)
        if abs(self.middle[0] - self.start[0]) > 1e-6 or abs(turn) > 1e-6:
            made.append(Phase("move", self._move(turn)))
        swing = [Phase("swing", self._swing(after_reach=grabs_alone))] if self.pivot is not None else []
        reach = [Phase("reach", self._reach(self.middle if grabs_alone else self.end))] if any(self.reaching) else []
        made += reach + swing if grabs_alone else swing + reach
        if not made:
            kind = "release" if self.old != self.new else "still"
            made = [Phase(kind, lambda share: self._ends(share, 0, 1) or self._last())]
        return [self._exact(phase, k, len(made)) for k, phase in enumerate(made)]

    def _exact(self, phase: Phase, k: int, n: int) -> Phase:
        return Phase(phase.kind, lambda share: self._ends(share, k, n) or phase.at(share))

    def _ends(self, share: float, k: int, n: int) -> Posture | None:
        if share >= 1.0 and k == n - 1:
            return self._last()
        if share <= 0.0 and k == 0:
            return stance_posture(self.robot, self.board, self.before)
        return None

    def _last(self) -> Posture:
        return stance_posture(self.robot, self.board, self.after)

    def _side(self, i: int, share: float) -> float:
        """Elbows pass to their new side in the first phase, those of reaching limbs while they reach."""
        first, last = self.sides[0][i], self.sides[1][i]
        return first + (last - first) * share

    def _body_frame(self, i: int, at: tuple[complex, float]) -> complex:
        """Tip of a limb before the action, seen from the body at a later pose where it has not let go before."""
        if self.old[i] >= 0:
            return (self.tips[i] - at[0]) * cmath.exp(-1j * at[1])
        return complex(*self.before["foot"][i])

    def _move(self, turn: float) -> Callable[[float], Posture]:
        def at(share: float) -> Posture:
            origin = self.start[0] + (self.middle[0] - self.start[0]) * share
            angle = self.start[1] + turn * share
            tips = [
                self.tips[i] if held >= 0 else origin + complex(*self.before["foot"][i]) * cmath.exp(1j * angle)
                for i, held in enumerate(self.old)
            ]
            sides = [
                self.sides[0][i] if self.reaching[i] else self._side(i, share) for i in range(len(self.robot.limbs))
            ]
            return pose(self.robot, origin, angle, tips, sides, self.old)

        return at

    def _swing(self, *, after_reach: bool) -> Callable[[float], Posture]:
        assert self.pivot is not None
        pivot = self.pivot
        middle = self.middle
        moved = abs(middle[0] - self.start[0]) > 1e-6
        held = (
            self.new
            if after_reach
            else tuple(h if stays else -1 for h, stays in zip(self.old, self.staying, strict=True))
        )

        def at(share: float) -> Posture:
            arc = cmath.exp(1j * self.turned * share)
            origin, angle = pivot + (middle[0] - pivot) * arc, middle[1] + self.turned * share
            tips = [
                hold_place(self.board, h) if h >= 0 else origin + self._body_frame(i, middle) * cmath.exp(1j * angle)
                for i, h in enumerate(held)
            ]
            sides = []
            for i in range(len(self.robot.limbs)):
                flips = 1.0 if moved or after_reach else share
                sides.append(self.sides[0][i] if self.reaching[i] and not after_reach else self._side(i, flips))
            return pose(self.robot, origin, angle, tips, sides, held)

        return at

    def _reach(self, body: tuple[complex, float]) -> Callable[[float], Posture]:
        origin, angle = body
        turn = cmath.exp(1j * angle)
        first = self.pivot is None or body is not self.end

        def at(share: float) -> Posture:
            tips = []
            for i, limb in enumerate(self.robot.limbs):
                if self.reaching[i]:
                    there = (hold_place(self.board, self.new[i]) - origin) / turn
                    tips.append(origin + turn * swung_foot(limb, self._body_frame(i, self.middle), there, share))
                elif self.staying[i]:
                    tips.append(hold_place(self.board, self.new[i]))
                else:
                    tips.append(origin + turn * self._body_frame(i, self.middle))
            sides = [self._side(i, share if self.reaching[i] or first else 1.0) for i in range(len(self.robot.limbs))]
            held = tuple(h if stays else -1 for h, stays in zip(self.new, self.staying, strict=True))
            return pose(self.robot, origin, angle, tips, sides, held)

        return at


def swung_foot(limb: Limb, start: complex, end: complex, share: float) -> complex:
    """Tip of a limb that swings from `start` to `end`, body frame [m]: round its port, drawn in a little half-way.

    The direction from the port never passes straight behind it, where the joints cannot follow.
    """
    port = complex(limb.port_x, limb.port_y)
    ahead = cmath.exp(1j * limb.port_angle)
    v0, v1 = (start - port) / ahead, (end - port) / ahead
    direction = cmath.phase(v0) + (cmath.phase(v1) - cmath.phase(v0)) * share
    length = (abs(v0) + (abs(v1) - abs(v0)) * share) * (1.0 - LIFT * math.sin(math.pi * share))
    return port + ahead * cmath.rect(length, direction)


def describe_holds(task: LimbedTask, held: Iterable[int]) -> str:
    """Which limb is on which hold, by the holds' indices; -1: none."""
    limbs = zip(task.robot.limb_names, held, strict=False)
    return ", ".join(f"{name} {task.world.holds[h].number if h >= 0 else 'free'}" for name, h in limbs)


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


class ClimbView(PlanView[Snapshot]):
    """A picture of a climb that can be set to any moment of it.

    Forces and torques pass evenly from one stance to the next; only those of settled stances are computed.
    """

    rows = ("Pose", "Holds")

    def __init__(self, task: LimbedTask, replay: Replay) -> None:
        self.postures = [stance_posture(task.robot, task.world, stance) for stance in replay.stances]
        self.settles = [
            settle(task, stance, posture) for stance, posture in zip(replay.stances, self.postures, strict=True)
        ]
        arrows = np.vstack([arrow_ends(task, snapshot) for snapshot in self.settles])
        bounds = find_bounds(task, self.postures, arrows)
        super().__init__(task, replay, bounds, torque_gauges(task))

    def draw(self, picture: Picture[Snapshot]) -> ClimberArtists:
        """Wall and climber."""
        draw_scene(picture.wall, self.task, self.bounds)
        draw_force_key(picture.panel, self.task, picture.key, picture.layout.scale)
        return ClimberArtists(picture.wall, self.task, self.bounds)

    def settled(self, step: int) -> Snapshot:
        """See `View`."""
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

    def values(self, at: Snapshot) -> tuple[Floats, ...]:
        """Torques of shoulders and elbows [N m], shape (2 n_limbs,)."""
        return (at.torques.ravel(),)

    def action(self, step: int) -> str:
        """A step in words."""
        stances = self.replay.stances
        return describe_action(self.task, stances[step - 1], stances[step], self.reason(step))

    def lines(self, step: int, at: Snapshot) -> tuple[str, ...]:
        """Pose and holds."""
        posture = at.posture
        pose = describe_pose(self.task, posture.x, posture.y, posture.angle)
        return pose, describe_holds(self.task, self.replay.stances["hold"][step])


def settle(task: LimbedTask, stance: np.void, posture: Posture) -> Snapshot:
    """A settled stance, as it is drawn, with its loads."""
    n = len(task.robot.limbs)
    return Snapshot(posture, np.array(stance["force"][:n]), np.array(stance["torques"][:n]))


def near_climb(task: LimbedTask, stance: np.void) -> CloseUp:
    """One stance with the part of the wall about it."""
    at = settle(task, stance, stance_posture(task.robot, task.world, stance))
    points = (at.posture.outline, at.posture.chains.reshape(-1, 2), arrow_ends(task, at))
    bounds = fit_bounds(np.vstack(points), ())

    def draw(axes: Axes) -> None:
        draw_scene(axes, task, bounds)
        ClimberArtists(axes, task, bounds).update(at)

    return CloseUp(bounds, draw)


def draw_climb(task: LimbedTask, stance: np.void, axes: Axes) -> None:
    """Draw one stance on given axes, which get the wall alone."""
    at = settle(task, stance, stance_posture(task.robot, task.world, stance))
    bounds = find_bounds(task, [at.posture], arrow_ends(task, at))
    draw_scene(axes, task, bounds)
    ClimberArtists(axes, task, bounds).update(at)
