"""A climb as it truly was: a film in its own time, and its figure."""

import cmath
from dataclasses import dataclass, replace
from typing import Any, Final

import numpy as np
from matplotlib.figure import Figure

from ....types import Floats
from ....viewing import style
from ....viewing.recording import Part, Recording, View
from ....viewing.route import draw_way, label_ghost, pick_ghosts
from ....viewing.scene import describe_pose
from ....viewing.view import Picture
from ..control.felt_force import feel_forces
from ..execution.climb_report import ActionReport
from ..execution.climb_trace import ClimbTrace
from ..execution.whole_body import WholeBody
from ..planning.task import LimbedTask
from ..trials.run_plan import ClimbRun
from .artists import ClimberArtists, Snapshot, draw_scene, find_bounds, torque_gauges, unloaded
from .climb_view import describe_holds
from .geometry import Posture, chained_pose

PART_SECONDS: Final = 2.8
"""Of the climb that one part of an action shows: five frames of 0.07 s, so eight times as fast as it was [s]."""
USUAL: Final = 8.0
"""A climb takes minutes: it is played that much faster than it was [-]."""
SMOOTH: Final = 0.15
"""Torques are averaged over so much time before and after a moment [s]."""
OUTCOMES: Final = ("failed", "stalled", "tried again", "ok")
SHOWN: Final = 400
"""Samples that the picture's frame is made for, at most."""


@dataclass(frozen=True, slots=True, eq=False)
class Moment(Snapshot):
    """A moment of a climb."""

    time: float
    """Since its start [s]."""


class ClimbFilm(View[Moment]):
    """A climb that was carried out.

    The forces of holds are not measured: pictures have none, and the viewer those that motors' torques and links' weights tell.

    Args:
        task: Robot and board.
        trace: What happened, with the truth if that is told.
        actions: What was reported, in order.
        pegs: Where the holds truly were, where that is not where the map says, shape (n_holds, 2) [m].
    """

    speed = USUAL
    rows = ("Time", "Pose", "Holds")
    verdict_row = "Outcome"
    noun = "Action"
    strip_title = "What became of every action"
    words = OUTCOMES

    def __init__(
        self, task: LimbedTask, trace: ClimbTrace, actions: list[ActionReport], pegs: Floats | None = None
    ) -> None:
        self.task, self.trace, self.actions, self._pegs = task, trace, actions, pegs
        self.poses = trace.believed if trace.true_pose is None else trace.true_pose
        """Of the body, truly where that is told, shape (rows, 3)."""
        self._angles = trace.angles if trace.true_angles is None else trace.true_angles
        self._index = {hold.number: k for k, hold in enumerate(task.world.holds)}
        some = np.unique(np.linspace(0, len(trace.time) - 1, SHOWN).astype(int))
        self.bounds = find_bounds(task, [self.posture(int(k)) for k in some])
        self.title, self.gauges, self.seconds = task.title or task.name, (torque_gauges(task),), float(trace.time[-1])
        self.steps = ("start", *(action.title for action in actions))
        self.grades = (3, *map(_grade, actions))
        self.starts = np.array([0.0, *(action.start for action in actions)])
        self.ends = np.array([0.0, *(action.start + action.seconds for action in actions)])
        self._body = WholeBody(task.robot, period=1.0)
        self._body.held[:] = 1

    def draw(self, picture: Picture[Moment]) -> ClimberArtists:
        """Wall and climber, with the pegs as they truly are."""
        draw_scene(picture.wall, self.task, self.bounds)
        if self._pegs is not None:
            x, y = self._pegs.T
            cross: dict[str, Any] = {"ls": "none", "marker": "x", "mew": 0.7, "color": style.ALERT, "zorder": 9}
            picture.wall.plot(x, y, ms=3.0, **cross)
            left, y_key = picture.key.left, picture.key.top
            picture.panel.plot([left + 0.06], [y_key], ms=5.0, **cross)
            words = "peg as it truly is; dots: as it is mapped"
            picture.panel.text(left + 0.2, y_key, words, fontsize=7, va="center", color=style.QUIET)
        return ClimberArtists(picture.wall, self.task, self.bounds)

    def posture(self, k: int) -> Posture:
        """The posture of a sample."""
        x, y, angle = (float(part) for part in self.poses[k])
        origin = complex(x, y)
        limbs = zip(self.task.robot.limbs, self._angles[k], strict=True)
        chains = origin + cmath.exp(1j * angle) * np.array([limb.chain(joints) for limb, joints in limbs])
        held = tuple(self._index.get(int(number), -1) for number in self.trace.holds[k])
        return chained_pose(self.task.robot, origin, angle, chains, held)

    def at_time(self, time: float) -> Moment:
        """The robot at a time [s]."""
        k = min(int(np.searchsorted(self.trace.time, time)), len(self.trace.time) - 1)
        torques = self.trace.torques[k]
        return Moment(self.posture(k), np.zeros_like(torques), torques, float(self.trace.time[k]))

    def at(self, time: float) -> Moment:
        """See `Recording`."""
        return replace(self.at_time(time), forces=self._forces(time))

    def _forces(self, time: float) -> Floats:
        """Forces of the holds on the tips by what the motors give, as if at rest, world frame, shape (n_limbs, 2) [N]."""
        trace = self.trace
        k = min(int(np.searchsorted(trace.time, time)), len(trace.time) - 1)
        first, last = np.searchsorted(trace.time, (time - SMOOTH, time + SMOOTH))
        torques = (
            trace.torques[first : max(last, first + 1)].mean(axis=0) if first < len(trace.time) else trace.torques[k]
        )
        body, still, forces = self._body, np.zeros((self._body.n, 2)), np.zeros((self._body.n, 2))
        body.pose[2] = self.poses[k, 2]
        body.q[:], body.torques[:] = trace.angles[k], torques
        feel_forces(body.work, still, still.copy(), forces, body.period, 1.0)
        return -forces

    def settled(self, step: int) -> Moment:
        """When the report's action of that number ended; 0 is the start."""
        return self.at_time(float(self.ends[step]))

    def motion(self, step: int) -> list[Part[Moment]]:
        """The action in parts of equal time."""
        action = self.actions[step - 1]
        count = max(1, round(action.seconds / PART_SECONDS))

        def part(k: int) -> Part[Moment]:
            return Part("move", lambda share, way: self.at_time(action.start + (k + share) / count * action.seconds))

        return [part(k) for k in range(count)]

    def values(self, at: Moment) -> tuple[Floats, ...]:
        """Torques of shoulders and elbows [N m], shape (2 n_limbs,)."""
        return (at.torques.ravel(),)

    def lines(self, step: int, at: Moment) -> tuple[str, ...]:
        """Time, pose and holds."""
        posture = at.posture
        pose = describe_pose(self.task, posture.x, posture.y, posture.angle)
        return f"{at.time:.0f} s", pose, describe_holds(self.task, posture.held)

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

    def facts(self, step: int, at: Moment) -> tuple[tuple[str, str], ...]:
        """See `Recording`: the moment, and what was reported of the step."""
        told = list(zip(self.rows, self.lines(step, at), strict=True))
        if step:
            action = self.actions[step - 1]
            words = [
                action.outcome,
                f"plan's step {action.steps}",
                f"{action.seconds:.1f} s",
                f"body {1e3 * action.off:.1f} mm off its aim",
            ]
            words += [f"{action.tries} tries"] if action.kind == "grab" and action.tries > 1 else []
            words += [f"tip believed {1e3 * action.tip_error:.1f} mm off"] if action.tip_error is not None else []
            told.append(("Outcome", ", ".join(words)))
            if action.reason:
                told.append(("Why", action.reason))
        return tuple(told)

    @property
    def worst(self) -> int | None:
        """See `Recording`."""
        return 1 + int(np.argmin(self.grades[1:])) if len(self.grades) > 1 and min(self.grades[1:]) < 3 else None

    def planned_time(self, time: float, plan: Recording[Moment]) -> float | None:
        """See `Recording`: as far in the same action; None after another plan took its place."""
        step = self.step_at(time)
        if step == 0:
            return 0.0
        if step > self._of_first_plan:
            return None
        action = self.actions[step - 1]
        if max(action.first, action.last) >= len(plan.steps):
            return None
        share = min(1.0, (time - action.start) / max(action.seconds, 1e-9))
        begin, end = float(plan.starts[action.first]), float(plan.ends[action.last])
        return begin + share * (end - begin)

    @property
    def _of_first_plan(self) -> int:
        """How many actions were of the plan that the run began with."""
        notes = self.trace.notes or {}
        replans = notes.get("replans") or ()
        return int(replans[0]["after"]) if replans else len(self.actions)


def _grade(action: ActionReport) -> int:
    """What became of an action, as an index into `OUTCOMES`."""
    if action.outcome != "ok":
        return int(action.outcome == "stalled")
    return 2 if action.kind == "grab" and action.tries > 1 else 3


class ClimbPicture(Picture[Moment]):
    """A figure of a climb; red crosses are pegs as they truly are."""

    view: ClimbFilm

    def whole(self) -> Figure:
        """The way of the body with ghosts along it, and how it ended."""
        view = self.view
        trace, last = view.trace, len(view.actions)
        poses = view.poses
        self.show(last, view.at_time(float(trace.time[-1])))
        ends = np.minimum(np.searchsorted(trace.time, view.ends), len(trace.time) - 1)
        for k in pick_ghosts(poses[ends, :2])[:-1]:
            ghost = ClimberArtists(self.wall, view.task, view.bounds, alpha=0.25, arrows=False)
            ghost.update(unloaded(view.posture(int(ends[k]))))
            x, y = poses[ends[k], :2].tolist()
            label_ghost(self.wall, k, x, y, "action")
        draw_way(self.wall, poses[:, :2])
        return self.figure


def run_film(run: ClimbRun) -> ClimbFilm:
    """A climb that was just carried out."""
    return ClimbFilm(run.task, run.trace, run.report.actions, run.true_pegs)


def run_picture(run: ClimbRun) -> ClimbPicture:
    """A figure of it."""
    return ClimbPicture(run_film(run))
