"""Robots in space in the viewer: world and robot, plans of them, the editor of holds."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from ....execution.log import Log, LogError
from ....execution.sample_log import report_of, told_of
from ....tasks.library import task_names
from ....viewing.browser.solids import FOV, NARROW, Camera, Scenery
from ....viewing.browser.viewer_content import Editor, Scenes, ViewerContent
from ....viewing.scene import Bounds
from ..execution.carrying_report import LoggedRun
from ..execution.run_trace import NAMES, Named, RunTrace
from ..planning.task import SpatialTask
from ..trials.run_plan import SpatialRun
from .camera import camera_for
from .hold_editor import HoldPanel
from .run_view import RunView
from .space import SpatialFigure, WorldScene
from .spatial_view import way_places

if TYPE_CHECKING:
    import viser

    from ....viewing.browser.scene_view import SceneView

ROOM: Final = 1.08
"""Around what is shown [-]."""


@dataclass(frozen=True, slots=True)
class SpatialScenery(Scenery):
    """A task of a robot in space."""

    task: SpatialTask

    def world(self, server: "viser.ViserServer") -> WorldScene:
        """See `Scenery`."""
        return WorldScene(server, self.task, way_places(self.task))

    def figure(self, server: "viser.ViserServer", name: str, opacity: float = 1.0) -> SpatialFigure:
        """See `Scenery`."""
        return SpatialFigure(server, name, self.task, opacity)

    def camera(self) -> Camera:
        """See `Scenery`: from where pictures look, as near as all can be seen."""
        right, up, towards = camera_for(self.task, None).axes
        places = way_places(self.task)
        middle = 0.5 * (places.min(axis=0) + places.max(axis=0))
        away = places - middle
        half = math.tan(0.5 * FOV)
        far = float((np.maximum(np.abs(away @ right) / NARROW, np.abs(away @ up)) / half + away @ towards).max())
        return Camera(middle + ROOM * far * towards, middle)


class SpatialScenes(Scenes):
    """Robots in space in the viewer."""

    tab = "World"

    def scenery(self, task: SpatialTask, bounds: Bounds) -> SpatialScenery:
        """See `Scenes`."""
        return SpatialScenery(bounds, task)

    def editor(
        self, server: "viser.ViserServer", task: SpatialTask, stage: "SceneView", changed: Callable[[Any], None]
    ) -> Editor:
        """See `Scenes`."""

        def world() -> WorldScene:
            assert isinstance(stage.world, WorldScene)  # a world in space
            return stage.world

        return HoldPanel(server, task, world, changed)

    def run_film(self, exhibit: ViewerContent, run: SpatialRun) -> RunView:
        """See `Scenes`."""
        return RunView(run.task, run.trace, camera_for(run.task, None))

    def with_log(self, exhibit: ViewerContent, log: Log) -> ViewerContent:
        """See `Scenes`."""
        trace = RunTrace.from_log(log)
        told_of(trace.report, LoggedRun, log.label)
        task: SpatialTask = exhibit.task
        if trace.named != Named.of(task.robot.chains):
            raise LogError(log.label, None, None, None, f"is of another robot than {task.robot.name}")
        return replace(exhibit, run_film=RunView(task, trace, camera_for(task, None)))

    def made_with(self, log: Log) -> str | None:
        """See `Scenes`."""
        if NAMES not in log.notes:
            return None
        made = (report_of(log) or {}).get("task")
        return made if made in task_names() else ""

    def outcome(self, run: SpatialRun) -> str:
        """See `Scenes`."""
        if not run.done:
            return f"not carried out: {run.reason}"
        return f"carried out in {run.report.seconds:.0f} s, {run.wall_seconds:.1f} s to compute"


SCENES: Final = SpatialScenes()
