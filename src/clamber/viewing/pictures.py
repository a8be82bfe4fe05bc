"""Pictures of any robot's plan: each family says how its own are drawn."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..family import NotOfFamilyError, family_of
from ..planning.problem.plan import Plan
from ..planning.problem.problem import Replay
from ..tasks import Task
from ..types import Floats
from .animation import WRITERS
from .output import CANVASES, StepError, check_suffix, save_figure
from .scene import Bounds
from .style import styled
from .view import View


@dataclass(frozen=True, slots=True)
class Pictures:
    """How one family of robots is drawn."""

    view: Callable[[Any, Replay], View[Any]]
    """A picture that can be set to any moment."""
    draw: Callable[[Any, np.void, Axes], None]
    """One stance record on given axes."""
    route: Callable[[Any, Replay], Figure]
    """A whole plan."""
    points: Callable[[Any], Floats]
    """What of a task's world must be seen under a map, world frame [m], shape (n, 2)."""
    world: Callable[[Axes, Any, Bounds], None]
    """A task's world on given axes."""
    torque_limits: Callable[[Any], Floats] | None = None
    """Of all joints that carry weight [N m]; None: the model has no joint torques."""


def pictures_of(task: Task) -> Pictures:
    """How a task's family is drawn.

    Raises:
        NotOfFamilyError: If it is not.
    """
    family = family_of(task)
    if family.pictures is None:
        raise NotOfFamilyError(family.title, "pictures")
    return family.pictures


def _carried_out(task: Task, plan: Replay | Plan) -> Replay:
    if isinstance(plan, Replay):
        return plan
    return family_of(task).plans.problem(task).replay(plan.codes(task), go_on=True)


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
    family, replay = pictures_of(task), _carried_out(task, plan)
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
        save_figure(pictures_of(task).route(task, _carried_out(task, plan)), path)


def animate(task: Task, plan: Replay | Plan, path: str | Path) -> None:
    """Write a plan, carried out, as an animation (.gif, .html, .mp4).

    Raises:
        SuffixError: If the file's suffix names no format for animations.
        MissingExtraError: If .mp4 is asked for without the extra `video`.
        FileError: If the file cannot be written.
    """
    suffix = check_suffix(path, WRITERS)
    with styled():
        WRITERS[suffix](pictures_of(task).view(task, _carried_out(task, plan)), Path(path))
