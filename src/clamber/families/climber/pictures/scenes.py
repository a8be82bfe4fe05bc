"""Climbers in the viewer: wall and climber in space, plans and runs of them, the board's editor, plans that hooks can be trusted with."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from ....execution.log import Log, LogError
from ....execution.sample_log import told_of
from ....planning.progress import Listener
from ....tasks.library import task_names
from ....trials.dynamics import RunEvents
from ....viewing.browser.solids import FOV, NARROW, Camera, Scenery
from ....viewing.browser.viewer_content import NAMED, Editor, Planned, Scenes, ViewerContent
from ....viewing.scene import Bounds, join
from ..execution.climb_report import LoggedClimb
from ..execution.climb_trace import ClimbTrace
from ..planning.task import LimbedTask
from ..trials.planning import plan_to_climb, validations
from ..trials.run_plan import ClimbRun, climbing_flaws, climbing_task
from .board_editor import BoardPanel
from .climb_run import ClimbFilm, run_film
from .space import ClimberFigure, WallScene

if TYPE_CHECKING:
    import viser

    from ....viewing.browser.scene_view import SceneView
    from ....viewing.browser.work_panel import Tell

ASIDE: Final = (-0.38, 0.12)
"""From where the camera looks at the wall: to the left and up, over its distance [-]."""
ROOM: Final = 1.2
"""Around what is shown [-]."""


@dataclass(frozen=True, slots=True)
class ClimbScenery(Scenery):
    """A climber's task."""

    task: LimbedTask

    def world(self, server: "viser.ViserServer") -> WallScene:
        """See `Scenery`."""
        return WallScene(server, self.task, self.bounds)

    def figure(self, server: "viser.ViserServer", name: str, opacity: float = 1.0) -> ClimberFigure:
        """See `Scenery`."""
        return ClimberFigure(server, name, self.task, opacity)

    def camera(self) -> Camera:
        """See `Scenery`: in front of the wall, a little aside."""
        x0, x1, y0, y1 = self.bounds
        size = ROOM * max(y1 - y0, (x1 - x0) / NARROW)
        far = 0.5 * size / math.tan(0.5 * FOV)
        middle = np.array((0.5 * (x0 + x1), 0.0, 0.5 * (y0 + y1)))
        return Camera(middle + far * np.array((ASIDE[0], -1.0, ASIDE[1])) / math.hypot(1.0, *ASIDE), middle)


class ClimbScenes(Scenes):
    """Climbers in the viewer."""

    tab = "Board"
    kernel = "command_tick"
    keeps_reserves = True

    def scenery(self, task: LimbedTask, bounds: Bounds) -> ClimbScenery:
        """See `Scenes`."""
        return ClimbScenery(bounds, task)

    def run_film(self, exhibit: ViewerContent, run: ClimbRun) -> ClimbFilm:
        """See `Scenes`."""
        return run_film(run)

    def with_log(self, exhibit: ViewerContent, log: Log) -> ViewerContent:
        """See `Scenes`."""
        task, trace = exhibit.task, ClimbTrace.from_log(log)
        if trace.limbs != task.robot.limb_names:
            words = f"robot '{task.robot.name}' has other ones; {NAMED}"
            raise LogError(log.label, None, None, f"limbs {', '.join(trace.limbs)}", words)
        film = ClimbFilm(task, trace, told_of(trace.notes, LoggedClimb, log.label).actions)
        scenery = replace(exhibit.scenery, bounds=join(exhibit.scenery.bounds, film.bounds))
        return replace(exhibit, scenery=scenery, run_film=film)

    def made_with(self, log: Log) -> str | None:
        """See `Scenes`."""
        if "limbs" not in log.notes:
            return None
        name = (ClimbTrace.from_log(log).notes or {}).get("task")
        return str(name) if name in task_names() else ""

    def editor(
        self, server: "viser.ViserServer", task: LimbedTask, stage: "SceneView", changed: Callable[[Any], None]
    ) -> Editor:
        """See `Scenes`."""

        def wall() -> WallScene:
            assert isinstance(stage.world, WallScene)  # a climber's
            return stage.world

        return BoardPanel(server, task, wall, changed)

    def plan_with_reserves(
        self, task: LimbedTask, planner: str, seconds: float, progress: Listener, tell: "Tell"
    ) -> Planned:
        """See `Scenes`: found first without, as that is sooner known."""
        found = self.plan(task, planner, seconds, progress)
        if found.plan is None:
            return found
        tell(f"a plan of {len(found.plan.actions)} actions; now one that keeps reserves")
        strict = climbing_task(task)
        flaws = climbing_flaws(strict, ())

        events = RunEvents(step=lambda words, share: tell(words))
        kept = plan_to_climb(strict, planner, seconds=seconds, seed=0, validate_plan=validations(flaws, events))
        if kept is None:
            reach = f"there is a plan of {len(found.plan.actions)} actions"
            return Planned(None, f"{reach}, but none that keeps reserves for a run, or that hooks can be trusted with")
        return Planned(kept, f"found: {len(kept.actions)} actions, with reserves for a run")

    def outcome(self, run: ClimbRun) -> str:
        """See `Scenes`."""
        report = run.report
        if not report.done:
            return f"not climbed: {report.reason}"
        return f"climbed: {len(report.actions)} actions in {report.seconds:.0f} s, {run.wall_seconds:.1f} s to compute"


SCENES: Final = ClimbScenes()
