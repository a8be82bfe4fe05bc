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
from ..trials.run_request import CarriedOut
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
    write_run: Callable[[Any, Path], None] | None = None
    """Writes what was carried out as the file's suffix says; None: nothing is."""


def pictures_of(task: Task) -> Pictures:
    """How a task's family is drawn.

    Raises:
        NotOfFamilyError: If it is not.
    """
    family = family_of(task)
    if family.pictures is None:
        raise NotOfFamilyError(family.title, "pictures")
    return family.pictures


def carried_out(task: Task, plan: Replay | Plan | None, label: str = "plan") -> Replay:
    """A plan carried out on paper, violations and all; without one, the start.

    Raises:
        ClamberError: If the plan, which `label` names, has actions that the task has not, or the start violates a hard check.
    """
    if isinstance(plan, Replay):
        return plan
    codes = np.zeros(0, np.int32) if plan is None else plan.codes(task, label)
    return family_of(task).plans.problem(task).replay(codes, go_on=True)


def draw_stance(task: Task, plan: Replay | Plan | None, step: int, target: str | Path | Axes) -> None:
    """Draw the stance after a step.

    Args:
        task: The task.
        plan: A plan, or its replay; None: the start alone.
        step: Number of the action, from 1; 0 is the start.
        target: A file (.png, .svg, .pdf), which also gets pose, nearest limit and loads; or axes, for the robot in its
            world alone.

    Raises:
        StepError: If there is no such step.
        SuffixError: If the file's suffix names no format for still pictures.
        FileError: If the file cannot be written.
    """
    family, replay = pictures_of(task), carried_out(task, plan)
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
        save_figure(pictures_of(task).route(task, carried_out(task, plan)), path)


def animate(task: Task, plan: Replay | Plan, path: str | Path) -> None:
    """Write a plan, carried out, as an animation (.gif, .html, .mp4).

    Raises:
        SuffixError: If the file's suffix names no format for animations.
        MissingExtraError: If .mp4 is asked for without the extra `video`.
        FileError: If the file cannot be written.
    """
    suffix = check_suffix(path, WRITERS)
    with styled():
        WRITERS[suffix](pictures_of(task).view(task, carried_out(task, plan)), Path(path))


def draw_run(run: CarriedOut, path: str | Path) -> None:
    """Write what was carried out as the file's suffix says: a log, an animation, or the whole run in one picture.

    Raises:
        NotOfFamilyError: If the family's runs are not drawn.
        SuffixError: If the suffix names no format.
        MissingExtraError: If the format needs an extra that is not installed.
        FileError: If the file cannot be written.
    """
    write = pictures_of(run.work).write_run
    if write is None:
        raise NotOfFamilyError(family_of(run.work).title, "pictures of runs")
    write(run, Path(path))
