"""Draw whatever the other functions answer."""

from pathlib import Path
from typing import Any

from ..errors import StatedError
from ..family import family_of
from ..files import as_text
from ..inspection.open_file import kind_of
from ..limb_bench.pictures.comparison import draw_comparison
from ..limb_bench.result import LimbResult
from ..planning.problem.plan import Plan
from ..planning.problem.plan_source import open_plan
from ..planning.reach.reach import Reach, choose_layer
from ..planning.result import PlanResult
from ..planning.sweep import Sweep
from ..tasks import Task, load_task
from ..trials.dynamics import CarriedOut
from ..trials.trial_runs import Trials
from ..trials.work import dynamics_of
from ..viewing.alone import alone_of, draw_alone, open_alone, shown_alone
from ..viewing.output import CANVASES
from ..viewing.pictures import animate, draw_route, draw_run, draw_stance
from ..viewing.reach_plot import draw_reach
from ..viewing.sweep_plot import draw_sweep


class NotDrawnError(StatedError):
    """A thing that nothing draws: names its type."""

    says = "a {kind} cannot be drawn; robots, worlds, tasks, plans, runs and what other functions answer can; of a walk, its run"
    kind: str


def draw(what: Any, path: str | Path, *, step: int | None = None, layer: str | None = None) -> Path:
    """Draw a robot, a world, a task, a plan, a planner's answer, a run or what many of them came to; the file's suffix says how.

    Args:
        what: What the other functions gave, or the name or file of a task, a plan, a robot or a world.
        path: A picture (.png, .svg, .pdf), or, of a plan or a run, an animation (.gif, .mp4); of a run also its log (.csv, .mcap). What
            the viewer shows can be a page (.html).
        step: Of a plan: the stance after this action, 0 for the start; None: all of it.
        layer: Of what `reach` gave: what is shown of every place, such as "force" or "steps"; None: the family's first.

    Returns:
        The path.

    Raises:
        NotDrawnError: If it is none of these.
        ClamberError: If the file cannot be written, or its suffix names nothing that can be made of it.
    """
    file = Path(as_text(path, "path"))
    made = what if isinstance(what, PlanResult) else getattr(what, "plan", what)  # such as what a plan has learned
    if isinstance(what, CarriedOut):
        draw_run(what, file)
    elif file.suffix.lower() == ".html":
        from ..viewing.browser.page import write_page
        from .viewing import exhibit_for  # loads the viewer

        write_page(exhibit_for((made,)), file)
    elif isinstance(what, LimbResult):
        draw_comparison(what, file)
    elif isinstance(what, Trials):
        dynamics_of(family_of(what.setup.work)).draw_trials(what, file)
    elif isinstance(what, Sweep):
        draw_sweep(what, file)
    elif isinstance(what, Reach):
        draw_reach(what, choose_layer(what.task, layer), file)
    elif isinstance(what, PlanResult):
        _draw_plan(what.task, what.plan, file, step)
    elif isinstance(made, Plan):
        _draw_plan(made.rebuild_task(), made, file, step)
    elif isinstance(what, Task):
        draw_stance(what, None, 0, file)
    elif isinstance(what, str | Path):
        _draw_named(str(what), file, step)
    elif (alone := alone_of(what)) is not None:
        draw_alone(alone, file)
    else:
        raise NotDrawnError(type(what).__name__)
    return file


def _draw_named(what: str, file: Path, step: int | None) -> None:
    kind = kind_of(what)
    if shown_alone(kind):
        draw_alone(open_alone(what, kind), file)
    elif kind == "task":
        draw_stance(load_task(what), None, 0, file)
    elif kind == "plan":
        opened = open_plan(what)
        _draw_plan(opened.task, opened.plan, file, step)
    else:
        raise NotDrawnError(kind)


def _draw_plan(task: Any, plan: Plan, file: Path, step: int | None) -> None:
    if file.suffix.lower() not in CANVASES:
        animate(task, plan, file)
    elif step is None:
        draw_route(task, plan, file)
    else:
        draw_stance(task, plan, step, file)
