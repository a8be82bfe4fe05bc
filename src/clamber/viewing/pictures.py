"""Pictures of any robot's plan: each family says how its own are drawn."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..actions.plan import Plan
from ..actions.plan_families import plan_family
from ..actions.problem import Replay
from ..errors import UnknownNameError
from ..tasks import Task
from .animation import WRITERS
from .climb_route import climb_route
from .climb_view import ClimbView, draw_climb
from .output import CANVASES, StepError, check_suffix, save_figure
from .style import styled
from .view import View
from .walker_route import walker_route
from .walker_view import WalkerView, draw_walk


@dataclass(frozen=True, slots=True)
class Pictures:
    """How one family of robots is drawn."""

    view: Callable[[Any, Replay], View[Any]]
    """A picture that can be set to any moment."""
    draw: Callable[[Any, np.void, Axes], None]
    """One stance record on given axes."""
    route: Callable[[Any, Replay], Figure]
    """A whole plan."""


FAMILIES: Final[dict[str, Pictures]] = {
    "limbed": Pictures(ClimbView, draw_climb, climb_route),
    "walker": Pictures(WalkerView, draw_walk, walker_route),
}
"""Family of the robot -> how its plans are drawn."""


def _family(task: Task) -> Pictures:
    name = task.document["robot"]["family"]
    if name not in FAMILIES:
        raise UnknownNameError("robot family with pictures", name, tuple(FAMILIES))
    return FAMILIES[name]


def _carried_out(task: Task, plan: Replay | Plan) -> Replay:
    if isinstance(plan, Replay):
        return plan
    return plan_family(task).problem(task).replay(plan.codes(task), go_on=True)


def draw_stance(task: Task, plan: Replay | Plan, step: int, target: str | Path | Axes) -> None:
    """Draw the stance after a step.

    Args:
        task: The task.
        plan: A plan, or its replay.
        step: Number of the action, from 1; 0 is the start.
        target: A file (.png, .svg, .pdf), which also gets pose, nearest limit and loads; or axes, for the robot in its
            world alone.

    Raises:
        StepError: If there is no such step.
        SuffixError: If the file's suffix names no format for still pictures.
        FileError: If the file cannot be written.
    """
    family, replay = _family(task), _carried_out(task, plan)
    if not 0 <= step < len(replay.stances):
        raise StepError(step, len(replay.stances) - 1)
    if isinstance(target, Axes):
        family.draw(task, replay.stances[step], target)
        return
    check_suffix(target, CANVASES)
    with styled():
        view = family.view(task, replay)
        view.show(step, view.settled(step))
        save_figure(view.figure, target)


def draw_route(task: Task, plan: Replay | Plan, path: str | Path) -> None:
    """Draw a whole plan as one still picture (.png, .svg, .pdf).

    Raises:
        SuffixError: If the file's suffix names no format for still pictures.
        FileError: If the file cannot be written.
    """
    check_suffix(path, CANVASES)
    with styled():
        save_figure(_family(task).route(task, _carried_out(task, plan)), path)


def animate(task: Task, plan: Replay | Plan, path: str | Path) -> None:
    """Write a plan, carried out, as an animation (.gif, .html, .mp4).

    Raises:
        SuffixError: If the file's suffix names no format for animations.
        MissingExtraError: If .mp4 is asked for without the extra `video`.
        FileError: If the file cannot be written.
    """
    suffix = check_suffix(path, WRITERS)
    with styled():
        WRITERS[suffix](_family(task).view(task, _carried_out(task, plan)), Path(path))
