"""A climb as it truly was: a picture that can be set to any moment of it, animated or still."""

import cmath
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
from matplotlib.figure import Figure

from ....execution.log_files import SUFFIXES as LOGS
from ....execution.log_files import write_log
from ....planning.problem.problem import Replay
from ....planning.problem.problems import yardsticks_of
from ....types import Floats, Json
from ....viewing import style
from ....viewing.animation import WRITERS
from ....viewing.output import CANVASES, check_suffix, save_figure
from ....viewing.route import draw_way, label_ghost, pick_ghosts
from ....viewing.style import styled
from ....viewing.view import Part, Spread, View
from ....viewing.words import describe_pose
from ..execution.climb_report import ActionReport
from ..execution.climb_trace import TOPIC, ClimbTrace
from ..planning.task import LimbedTask
from ..robot.robot import Limb
from ..statics.checks import LIMBED_CHECKS
from ..statics.records import STANCE
from ..trials.run_plan import ClimbRun
from .climb_player import SCRIPT, climb_world, spread_snapshot
from .climber import ClimberArtists, Snapshot
from .geometry import Posture, body_outline
from .torques import torque_gauges
from .wall import draw_scene, find_bounds

PART_SECONDS: Final = 2.8
"""Of the climb that one part of an action shows: five frames of 0.07 s, so eight times as fast as it was [s]."""
OUTCOMES: Final = ("failed", "stalled", "tried again", "ok")
SHOWN: Final = 400
"""Samples that the picture's frame is made for, at most."""


@dataclass(frozen=True, slots=True, eq=False)
class Moment(Snapshot):
    """A moment of a climb."""

    time: float
    """Since its start [s]."""


class ClimbRunView(View[Moment]):
    """A picture of a climb that was carried out; forces of holds are not measured, so none are drawn.

    Args:
        task: Robot and board.
        trace: What happened, with the truth if that is told.
        actions: What was reported, in order.
        pegs: Where the holds truly were, where that is not where the map says, shape (n_holds, 2) [m].
    """

    rows = ("Time", "Pose", "Holds")
    verdict_row = "Outcome"
    noun = "Action"
    strip_title = "What became of every action"
    strip_words = OUTCOMES
    script = SCRIPT

    def __init__(
        self, task: LimbedTask, trace: ClimbTrace, actions: list[ActionReport], pegs: Floats | None = None
    ) -> None:
        self.task, self.trace, self.actions = task, trace, actions
        self._poses = trace.believed if trace.true_pose is None else trace.true_pose
        self._angles = trace.angles if trace.true_angles is None else trace.true_angles
        self._index = {hold.number: k for k, hold in enumerate(task.world.holds)}
        self._outline = body_outline(task.robot)
        some = np.unique(np.linspace(0, len(trace.time) - 1, SHOWN).astype(int))
        bounds = find_bounds(task, [self.posture(int(k)) for k in some])
        super().__init__(task, _no_replay(len(actions)), bounds, torque_gauges(task), yardsticks_of(task))
        draw_scene(self.wall, task, bounds)
        if pegs is not None:
            self.wall.plot(pegs[:, 0], pegs[:, 1], ls="none", marker="x", ms=3.0, mew=0.7, color=style.ALERT, zorder=9)
        self.robot = ClimberArtists(self.wall, task, bounds)

    @property
    def grades(self) -> list[int]:
        """What became of every action, as indices into `OUTCOMES`."""
        return [
            (2 if action.kind == "grab" and action.tries > 1 else 3)
            if action.outcome == "ok"
            else int(action.outcome == "stalled")
            for action in self.actions
        ]

    def posture(self, k: int) -> Posture:
        """The posture of a sample."""
        x, y, angle = (float(part) for part in self._poses[k])
        origin = complex(x, y)
        chains = [_chain(limb, origin, angle, self._angles[k, i]) for i, limb in enumerate(self.task.robot.limbs)]
        grips = [
            angle + limb.port_angle + float(self._angles[k, i].sum()) + limb.end.angle
            for i, limb in enumerate(self.task.robot.limbs)
        ]
        outline = origin + self._outline * cmath.exp(1j * angle)
        held = tuple(self._index.get(int(number), -1) for number in self.trace.holds[k])
        corners = np.stack([outline.real, outline.imag], axis=-1)
        return Posture(x, y, angle, corners, np.array(chains), np.array(grips), held)

    def at_time(self, time: float) -> Moment:
        """The robot at a time [s]."""
        k = min(int(np.searchsorted(self.trace.time, time)), len(self.trace.time) - 1)
        torques = self.trace.torques[k]
        return Moment(self.posture(k), np.zeros_like(torques), torques, float(self.trace.time[k]))

    def settled(self, step: int) -> Moment:
        """When the report's action of that number ended; 0 is the start."""
        if step == 0:
            return self.at_time(0.0)
        return self.at_time(self.actions[step - 1].start + self.actions[step - 1].seconds)

    def motion(self, step: int) -> list[Part[Moment]]:
        """The action in parts of equal time."""
        action = self.actions[step - 1]
        count = max(1, round(action.seconds / PART_SECONDS))

        def part(k: int) -> Part[Moment]:
            return Part("move", lambda share, way: self.at_time(action.start + (k + share) / count * action.seconds))

        return [part(k) for k in range(count)]

    def values(self, at: Moment) -> Floats:
        """Torques of shoulders and elbows [N m], shape (2 n_limbs,)."""
        return at.torques.ravel()

    def action(self, step: int) -> str:
        """An action in words."""
        return self.actions[step - 1].title

    def facts(self, step: int, at: Moment) -> tuple[str, ...]:
        """Time, pose and holds."""
        posture, names = at.posture, self.task.robot.limb_names
        numbers = [self.task.world.holds[k].number if k >= 0 else "free" for k in posture.held]
        pose = describe_pose(self.task, posture.x, posture.y, posture.angle)
        return f"{at.time:.0f} s", pose, ", ".join(f"{a} {b}" for a, b in zip(names, numbers, strict=True))

    def verdict(self, step: int) -> str:
        """What became of an action, and why; which steps of the plan it was."""
        if not step:
            return "at rest"
        action = self.actions[step - 1]
        why = f": {action.reason}" if action.reason else ""
        return f"{action.outcome}{why} (plan: step {action.steps})"

    def failed(self, step: int) -> bool:
        """Whether an action came to another end than it should."""
        return step > 0 and self.actions[step - 1].outcome != "ok"

    def world(self) -> Json:
        """Holds, keep-outs, goals and the shape of the robot."""
        return climb_world(self.task, self.bounds)

    def spread(self, at: Moment) -> Spread:
        """A moment for the player."""
        return spread_snapshot(at)


def check_run_suffix(path: Path) -> str:
    """The suffix of a file that a run can be written to: a log, an animation, or the whole climb in one picture.

    Raises:
        SuffixError: If it is no such suffix.
    """
    return check_suffix(path, (*LOGS, *WRITERS, *CANVASES))


def write_run(run: ClimbRun, path: Path) -> None:
    """Write what happened in a climb as the file's suffix says; red crosses are pegs as they truly are.

    Raises:
        SuffixError: If the suffix names no format.
        MissingExtraError: If .mp4 is asked for without the extra `video`.
        FileError: If the file cannot be written.
    """
    suffix = check_run_suffix(path)
    if suffix in LOGS:
        write_log(run.trace.to_log(), path, TOPIC)
        return
    with styled():
        view = ClimbRunView(run.task, run.trace, run.report.actions, run.true_pegs)
        if suffix in WRITERS:
            WRITERS[suffix](view, path)
        else:
            save_figure(_whole(view), path)


def _whole(view: ClimbRunView) -> Figure:
    """The way of the body with ghosts along it, and how it ended."""
    trace, last = view.trace, len(view.actions)
    poses = trace.believed if trace.true_pose is None else trace.true_pose
    view.show(last, view.at_time(float(trace.time[-1])))
    ends = np.searchsorted(trace.time, [0.0, *(one.start + one.seconds for one in view.actions)])
    ends = np.minimum(ends, len(trace.time) - 1)
    unloaded = np.zeros((len(trace.limbs), 2))
    for k in pick_ghosts(poses[ends, :2])[:-1]:
        ghost = ClimberArtists(view.wall, view.task, view.bounds, alpha=0.25, arrows=False)
        ghost.update(Snapshot(view.posture(int(ends[k])), unloaded, unloaded))
        x, y = poses[ends[k], :2].tolist()
        label_ghost(view.wall, k, x, y, "action")
    draw_way(view.wall, poses[:, :2])
    return view.figure


def _chain(limb: Limb, origin: complex, angle: float, joints: Floats) -> list[tuple[float, float]]:
    """Port, elbow, end of the second link and tip, world frame [m]."""
    port = origin + complex(limb.port_x, limb.port_y) * cmath.exp(1j * angle)
    first = angle + limb.port_angle + float(joints[0])
    elbow = port + cmath.rect(limb.l1, first)
    second = first + float(joints[1])
    end, tip = elbow + cmath.rect(limb.l2, second), elbow + cmath.rect(limb.l2_effective, second + limb.hook_beta)
    return [(point.real, point.imag) for point in (port, elbow, end, tip)]


def _no_replay(actions: int) -> Replay:
    """Stands for the plan's replay, for nothing of a run is judged by the checks."""
    checks = len(LIMBED_CHECKS)
    return Replay(np.zeros(actions + 1, STANCE), np.full((actions, checks), np.nan), np.full(actions, -1, np.int32))
