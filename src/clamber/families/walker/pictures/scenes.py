"""Walkers in the viewer: ground and walker in space, plans, walks and runs of them, the ground's editor."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from ....execution.log import Log, LogError
from ....execution.sample_log import told_of
from ....planning.problem.plan import Plan
from ....planning.problem.problem import Replay
from ....planning.progress import Listener
from ....tasks.library import task_names
from ....types import Floats, Json
from ....viewing.alone import Alone
from ....viewing.browser.solids import FOV, NARROW, Camera, Scenery
from ....viewing.browser.viewer_content import Editor, Planned, Scenes, ViewerContent
from ....viewing.recording import View
from ....viewing.scene import Bounds, join
from ..execution.walk_report import LoggedWalk
from ..execution.walk_trace import WalkTrace
from ..planning import Walk, walk_names
from ..planning.task import Goal, WalkerTask
from ..robot import WalkerRobot
from ..trials.planned import careful
from ..trials.run_walk import WalkRun
from ..world.ground import Ground
from .ground_editor import GroundPanel
from .space import GroundScene, WalkerFigure
from .walk_film import PlannedWalkFilm, WalkFilm, logged_walk, standing_film, way_poses
from .walker_view import WalkerView

if TYPE_CHECKING:
    import viser

    from ....viewing.browser.scene_view import SceneView
    from ....viewing.browser.work_panel import Tell

FROM: Final = (-0.45, -1.0, 0.75)
"""From where the camera looks at the ground, over its distance [-]."""
ROOM: Final = 1.05
"""Around what is shown [-]."""
TALL: Final = 0.7
"""Height of a robot with its arm, or more [m]."""
BESIDE: Final = 0.5
"""Ground shown around a walk [m]."""


@dataclass(frozen=True, slots=True)
class WalkScenery(Scenery):
    """A walker on a ground."""

    robot: WalkerRobot
    ground: Ground
    goals: tuple[Goal, ...] = ()
    way: Floats | None = None
    """Places that a walk's way leads along, seen from above, shape (n, 2) [m]; None: it is not known."""

    def world(self, server: "viser.ViserServer") -> GroundScene:
        """See `Scenery`."""
        return GroundScene(server, self.ground, self.goals, self.bounds, self.way)

    def figure(self, server: "viser.ViserServer", name: str, opacity: float = 1.0) -> WalkerFigure:
        """See `Scenery`."""
        return WalkerFigure(server, name, self.robot, opacity)

    def camera(self) -> Camera:
        """See `Scenery`: from above, aside."""
        x0, x1, y0, y1 = self.bounds
        middle = np.array((0.5 * (x0 + x1), 0.5 * (y0 + y1), 0.0))
        height = self.ground.heights(middle[:2])
        middle[2] = float(height) if np.isfinite(height) else 0.0
        back = np.array(FROM) / np.linalg.norm(FROM)
        ground = [(x, y, middle[2]) for x in (x0, x1) for y in (y0, y1)]
        robot = [(x, y, middle[2] + TALL) for x in (x0 + BESIDE, x1 - BESIDE) for y in (y0 + BESIDE, y1 - BESIDE)]
        far = ROOM * _distance(np.array(ground + robot) - middle, back)
        return Camera(middle + far * back, middle)


def _distance(points: Floats, back: Floats) -> float:
    """How far away a camera has to be to see all of some points, as wide as high a picture may be (`NARROW`) [m].

    Args:
        points: From where it looks at, shape (n, 3) [m].
        back: From there towards the camera, of length 1, shape (3,).
    """
    right = np.array((-back[1], back[0], 0.0)) / math.hypot(back[0], back[1])
    up = np.cross(back, right)
    half = math.tan(0.5 * FOV)
    needed = np.maximum(np.abs(points @ right) / NARROW, np.abs(points @ up)) / half + points @ back
    return float(needed.max())


def walk_bounds(centres: Floats) -> Bounds:
    """The part of a ground around places, shape (n, 2) [m]."""
    (x0, y0), (x1, y1) = centres.min(axis=0) - BESIDE, centres.max(axis=0) + BESIDE
    return float(x0), float(x1), float(y0), float(y1)


ROUND: Final = 0.2
"""Ground that is shown around a plan's picture [m]."""


class WalkScenes(Scenes):
    """Walkers in the viewer: their tasks, and their walks, which need no plan."""

    tab = "Ground"
    kernel = "level_heights"
    keeps_reserves = True

    def scenery(self, task: WalkerTask, bounds: Bounds) -> WalkScenery:
        """See `Scenes`."""
        x0, x1, y0, y1 = bounds
        return WalkScenery((x0 - ROUND, x1 + ROUND, y0 - ROUND, y1 + ROUND), task.robot, task.world, task.goals)

    def film(self, view: View[Any]) -> PlannedWalkFilm:
        """See `Scenes`."""
        assert isinstance(view, WalkerView)  # a walker's
        return PlannedWalkFilm(view)

    def exhibit(self, task: Walk | WalkerTask, plan: Plan | Replay | None, label: str = "plan") -> ViewerContent:
        """See `Scenes`: of a walk before it has begun its robot at its start, and its way.

        Raises:
            ClamberError: If there is no way to one of a walk's places.
        """
        if not isinstance(task, Walk):
            return super().exhibit(task, plan, label)
        way = way_poses(task)[:, :2]
        scenery = WalkScenery(walk_bounds(way), task.robot, task.ground, way=way)
        return ViewerContent(task.title or task.name, scenery, standing_film(task), task=task, planned=False)

    def run_film(self, exhibit: ViewerContent, run: WalkRun) -> WalkFilm:
        """See `Scenes`."""
        walk = run.walk
        return WalkFilm(walk.robot, walk.ground, run.true, run.report.to_json(), exhibit.title, payload=walk.payload)

    def with_log(self, exhibit: ViewerContent, log: Log) -> ViewerContent:
        """See `Scenes`; beside a walk's log there is nothing to edit."""
        work, trace = exhibit.task, WalkTrace.from_log(log)
        told_of(trace.notes, LoggedWalk, log.label)
        if not np.isfinite(trace.believed).all():
            raise LogError(log.label, None, None, None, "tells no place of the robot")
        bounds = walk_bounds(trace.believed[:, :2])
        if isinstance(work, Walk):
            scenery = WalkScenery(bounds, work.robot, work.ground)
            return ViewerContent(
                exhibit.title, scenery, None, _logged_film(scenery, trace, exhibit.title, work.payload)
            )
        scenery = replace(self.scenery(work, bounds), bounds=join(exhibit.scenery.bounds, bounds))
        film = _logged_film(scenery, trace, exhibit.title, work.start.payload)
        return replace(exhibit, scenery=scenery, run_film=film)

    def made_with(self, log: Log) -> str | None:
        """See `Scenes`."""
        if "walker" not in log.notes:
            return None
        notes: Json = WalkTrace.from_log(log).notes or {}
        for key, known in (("task", task_names()), ("walk", (*walk_names(), *task_names()))):
            if notes.get(key) in known:
                return str(notes[key])
        return ""

    def editor(
        self, server: "viser.ViserServer", task: Walk | WalkerTask, stage: "SceneView", changed: Callable[[Any], None]
    ) -> Editor:
        """See `Scenes`."""
        return GroundPanel(server, task, lambda: stage.scenery.bounds, changed)

    def plan_with_reserves(
        self, task: WalkerTask, planner: str, seconds: float, progress: Listener, tell: "Tell"
    ) -> Planned:
        """See `Scenes`."""
        return self.plan(careful(task), planner, seconds, progress)

    def still(self, alone: Alone) -> Any:
        """See `Scenes`: on level ground."""
        return super().exhibit(alone.task, None).main.at(0.0)

    def outcome(self, run: WalkRun) -> str:
        """See `Scenes`."""
        if not run.done:
            return f"not walked: {run.reason}"
        report = run.report
        return f"walked: {len(report.steps)} steps in {report.seconds:.0f} s, {run.wall_seconds:.1f} s to compute"


def _logged_film(scenery: WalkScenery, trace: WalkTrace, title: str, payload: float) -> WalkFilm:
    margins = trace.margin if trace.true_margin is None else trace.true_margin
    return WalkFilm(
        scenery.robot, scenery.ground, logged_walk(trace), trace.notes or {}, title,
        payload=payload, margins=margins, exact=trace.true_forces is not None,
    )  # fmt: skip


SCENES: Final = WalkScenes()
