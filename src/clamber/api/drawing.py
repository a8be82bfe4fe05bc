"""Draw whatever the other functions answer."""

from pathlib import Path
from typing import Any

from ..errors import ClamberError
from ..inspection.open_file import kind_of
from ..limb_bench.pictures.comparison import draw_comparison
from ..limb_bench.result import LimbResult
from ..planning.problem.plan import Plan
from ..planning.problem.plan_source import open_plan
from ..planning.result import PlanResult
from ..tasks import Task, load_task
from ..trials.dynamics import CarriedOut
from ..viewing.alone import draw_alone, open_alone, shown_alone
from ..viewing.output import CANVASES
from ..viewing.pictures import animate, draw_route, draw_run, draw_stance


class NotDrawnError(ClamberError):
    """A thing that nothing draws: names its type."""

    def __init__(self, kind: str) -> None:
        super().__init__(kind)
        self.kind = kind

    def __str__(self) -> str:
        return f"a {self.kind} cannot be drawn; tasks, plans, answers, runs and comparisons can, and by name or file robots and worlds, too"


def draw(what: Any, path: str | Path, *, step: int | None = None) -> Path:
    """Draw a task, a plan, a planner's answer, a run or a comparison; the file's suffix says how.

    Args:
        what: What `load_task`, `plan`, `run` or `compare` gave, a `Plan`, or the name or file of a task, a plan, a robot or a world.
        path: A picture (.png, .svg, .pdf), or, of a plan or a run, an animation (.gif, .html, .mp4); of a run also its log (.csv, .mcap).
        step: Of a plan: the stance after this action, 0 for the start; None: all of it.

    Returns:
        The path.

    Raises:
        NotDrawnError: If it is none of these.
        ClamberError: If the file cannot be written, or its suffix names nothing that can be made of it.
    """
    file = Path(path)
    if isinstance(what, CarriedOut):
        draw_run(what, file)
    elif isinstance(what, LimbResult):
        draw_comparison(what, file)
    elif isinstance(what, PlanResult):
        _draw_plan(what.task, what.plan, file, step)
    elif isinstance(what, Plan):
        _draw_plan(what.rebuild_task(), what, file, step)
    elif isinstance(what, Task):
        draw_stance(what, None, 0, file)
    elif isinstance(what, str) and shown_alone(kind := kind_of(what)):
        draw_alone(open_alone(what, kind), file)
    elif isinstance(what, str) and kind_of(what) == "task":
        draw_stance(load_task(what), None, 0, file)
    elif isinstance(what, str) and kind_of(what) == "plan":
        opened = open_plan(what)
        _draw_plan(opened.task, opened.plan, file, step)
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
