"""Draw whatever the other functions answer."""

from pathlib import Path
from typing import Any

import numpy as np

from ..errors import ClamberError
from ..families.climber.pictures.climb_run_view import write_run
from ..families.climber.planning.task import LimbedTask
from ..families.climber.trials.run_plan import ClimbRun
from ..families.walker.pictures.walk_run_view import write_walk
from ..families.walker.planning.task import WalkerTask
from ..families.walker.trials.run_walk import WalkRun
from ..limb_bench.pictures.comparison import draw_comparison
from ..limb_bench.result import LimbResult
from ..planning.problem.plan import Plan
from ..planning.problem.problems import plan_family
from ..planning.result import PlanResult
from ..viewing.output import CANVASES
from ..viewing.pictures import animate, draw_route, draw_stance


class NotDrawnError(ClamberError):
    """A thing that nothing draws: names its type."""

    def __init__(self, kind: str) -> None:
        super().__init__(kind)
        self.kind = kind

    def __str__(self) -> str:
        return f"a {self.kind} cannot be drawn; tasks, plans, answers, runs and comparisons can"


def draw(what: Any, path: str | Path, *, step: int | None = None) -> Path:
    """Draw a task, a plan, a planner's answer, a run or a comparison; the file's suffix says how.

    Args:
        what: What `load_task`, `plan`, `run` or `compare` gave, or a `Plan`.
        path: A picture (.png, .svg, .pdf), or, of a plan or a run, an animation (.gif, .html, .mp4); of a run also its log (.csv, .mcap).
        step: Of a plan: the stance after this action, 0 for the start; None: all of it.

    Returns:
        The path.

    Raises:
        NotDrawnError: If it is none of these.
        ClamberError: If the file cannot be written, or its suffix names nothing that can be made of it.
    """
    file = Path(path)
    if isinstance(what, ClimbRun):
        write_run(what, file)
    elif isinstance(what, WalkRun):
        write_walk(what, file)
    elif isinstance(what, LimbResult):
        draw_comparison(what, file)
    elif isinstance(what, PlanResult):
        _draw_plan(what.task, what.plan, file, step)
    elif isinstance(what, Plan):
        _draw_plan(what.rebuild_task(), what, file, step)
    elif isinstance(what, LimbedTask | WalkerTask):
        start = plan_family(what).problem(what).replay(np.zeros(0, np.int32))
        draw_stance(what, start, 0, file)
    else:
        raise NotDrawnError(type(what).__name__)
    return file


def _draw_plan(task: Any, plan: Plan, file: Path, step: int | None) -> None:
    if file.suffix.lower() not in CANVASES:
        animate(task, plan, file)
    elif step is None:
        draw_route(task, plan, file)
    else:
        draw_stance(task, plan, step, file)
