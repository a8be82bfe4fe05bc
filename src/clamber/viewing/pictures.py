"""Pictures of any robot's plans and runs: each family says how its own are drawn."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, Protocol

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..execution.log_files import SUFFIXES as LOGS
from ..execution.log_files import write_log
from ..family import NotOfFamilyError, family_of
from ..planning.problem.plan import Plan
from ..planning.problem.problem import Replay
from ..tasks import Task
from ..trials.dynamics import CarriedOut
from ..types import Floats
from .alone import DrawsAlone
from .animation import WRITERS, Animated, Progress, untold
from .output import CANVASES, StepError, check_suffix, save_figure
from .recording import View
from .scene import Bounds
from .style import styled
from .view import CloseUp, Picture

if TYPE_CHECKING:
    from .report.run_page import RunPage

ANIMATIONS: Final = (".gif", ".html", ".mp4")


class RunPicture(Animated[Any], Protocol):
    """A figure of a run."""

    def whole(self) -> Figure:
        """All of it in one picture."""


@dataclass(frozen=True, slots=True)
class Chart:
    """A world as a map of the first two coordinates of a body's poses."""

    points: Callable[[Any], Floats]
    """Places of a task's holds, or what else must be seen, on the map, shape (n, 2) [m]."""
    world: Callable[[Axes, Any, Bounds], None]
    """A task's world on given axes."""


@dataclass(frozen=True, slots=True)
class Pictures:
    """How one family is drawn."""

    view: Callable[[Any, Replay], View[Any]]
    """A plan at any of its moments."""
    draw: Callable[[Any, np.void, Axes], None]
    """A stance record on given axes."""
    route: Callable[[Any, Replay], Figure]
    """A whole plan."""
    points: Callable[[Any], Floats]
    """What of a task's world must be seen under a map, world frame [m], shape (n, 2)."""
    world: Callable[[Axes, Any, Bounds], None]
    """A task's world on given axes."""
    torque_limits: Callable[[Any], Floats] | None = None
    """Of all joints that carry weight [N m]; None: the model has no joint torques."""
    run: Callable[[Any], RunPicture] | None = None
    """What was carried out; None: it is not drawn."""
    report: Callable[[Any], "RunPage"] | None = None
    """What a report says of a run; None: there are none."""
    robot_alone: DrawsAlone | None = None
    """A robot without a task; None: it is not drawn."""
    world_alone: DrawsAlone | None = None
    """A world without a task; None: it is not drawn."""
    near: "Callable[[Any, np.void], CloseUp] | None" = None
    """One stance from near, for worlds in which the robot would be a dot; None: it is not drawn so."""
    chart: Chart | None = None
    """What maps of reachable places are drawn over, its points those of the holds; None: the world as it is drawn otherwise."""
    seen_from: "Callable[[str], Pictures] | None" = None
    """The same from a camera that is asked for in words; None: what is drawn is flat."""


def pictures_of(task: Task, camera: str | None = None) -> Pictures:
    """How a task's family is drawn, from a camera in words; None: from where it is usual.

    Raises:
        NotOfFamilyError: If a camera is asked for and the family's pictures have none.
    """
    family = family_of(task)
    if camera is None:
        return family.pictures
    if family.pictures.seen_from is None:
        raise NotOfFamilyError(family.title, "camera: it is drawn in its plane")
    return family.pictures.seen_from(camera)


def carried_out(task: Task, plan: Replay | Plan | None, label: str = "plan") -> Replay:
    """A plan carried out on paper, violations and all; without one, the start.

    Raises:
        ClamberError: If the plan, which `label` names, has actions that the task has not, or the start violates a hard check.
    """
    if isinstance(plan, Replay):
        return plan
    codes = np.zeros(0, np.int32) if plan is None else plan.codes(task, label)
    return family_of(task).plans.problem(task).replay(codes, go_on=True)


def draw_stance(
    task: Task, plan: Replay | Plan | None, step: int, target: str | Path | Axes, camera: str | None = None
) -> None:
    """Draw the stance after a step.

    Args:
        task: The task.
        plan: A plan, or its replay; None: the start alone.
        step: Number of the action, from 1; 0 is the start.
        target: A file (.png, .svg, .pdf), which also gets pose, nearest limit and loads; or axes, for the robot in its
            world alone.
        camera: See `pictures_of`.

    Raises:
        StepError: If there is no such step.
        SuffixError: If the file's suffix names no format for still pictures.
        FileError: If the file cannot be written.
    """
    family, replay = pictures_of(task, camera), carried_out(task, plan)
    if not 0 <= step < len(replay.stances):
        raise StepError(step, len(replay.stances) - 1)
    if isinstance(target, Axes):
        family.draw(task, replay.stances[step], target)
        return
    check_suffix(target, CANVASES)
    with styled():
        picture = Picture(family.view(task, replay))
        picture.show(step, picture.view.settled(step))
        if family.near is not None:
            picture.draw_near(family.near(task, replay.stances[step]))
        save_figure(picture.figure, target)


def draw_route(task: Task, plan: Replay | Plan, path: str | Path, camera: str | None = None) -> None:
    """Draw a whole plan as one still picture (.png, .svg, .pdf); `camera` as `pictures_of` has it."""
    check_suffix(path, CANVASES)
    with styled():
        save_figure(pictures_of(task, camera).route(task, carried_out(task, plan)), path)


def animate(
    task: Task, plan: Replay | Plan, path: str | Path, camera: str | None = None, progress: Progress = untold
) -> None:
    """Write a plan, carried out, as an animation (.gif, .html, .mp4); `camera` as `pictures_of` has it, a page's is moved by its reader.

    Raises:
        SuffixError: If the file's suffix names no format for animations.
        MissingExtraError: If .mp4 is asked for without the extra `video`.
        MissingViserError: If .html is asked for without the extra `view`.
        FileError: If the file cannot be written.
    """
    suffix = check_suffix(path, ANIMATIONS)
    if suffix not in WRITERS:
        from .browser.page import write_page  # loads the viewer
        from .browser.viewer_content import exhibit_of

        write_page(exhibit_of(task, plan), Path(path), progress)
        return
    with styled():
        picture = Picture(pictures_of(task, camera).view(task, carried_out(task, plan)))
        WRITERS[suffix](picture, Path(path), progress)


def check_run_suffix(path: str | Path) -> str:
    """The suffix of a file that a run can be written to: a log, an animation, or the whole run in one picture.

    Raises:
        SuffixError: If it is no such suffix.
    """
    return check_suffix(path, (*LOGS, *ANIMATIONS, *CANVASES))


def draw_run(run: CarriedOut, path: str | Path, progress: Progress = untold) -> None:
    """Write what was carried out as the file's suffix says.

    Raises:
        NotOfFamilyError: If the family's runs are not drawn.
        SuffixError: If the suffix names no format.
        MissingExtraError: If .mp4 is asked for without the extra `video`.
        MissingViserError: If .html is asked for without the extra `view`.
        FileError: If the file cannot be written.
    """
    suffix, file = check_run_suffix(path), Path(path)
    if suffix in LOGS:
        log = run.trace.to_log()
        write_log(log, file, log.label, run.scene)
        return
    if suffix in ANIMATIONS and suffix not in WRITERS:
        from .browser.page import write_page
        from .browser.viewer_content import run_exhibit  # loads the viewer

        write_page(run_exhibit(run), file, progress)
        return
    draw = pictures_of(run.work).run
    if draw is None:
        raise NotOfFamilyError(family_of(run.work).title, "pictures of runs")
    with styled():
        write_run_picture(draw(run), file, progress)


def write_run_picture(picture: RunPicture, path: Path, progress: Progress = untold) -> None:
    """Write a figure of a run, animated or still; within `styled`.

    Raises:
        SuffixError: If the suffix names no such format.
        MissingExtraError: If .mp4 is asked for without the extra `video`.
        FileError: If the file cannot be written.
    """
    suffix = check_suffix(path, (*WRITERS, *CANVASES))
    if suffix in WRITERS:
        WRITERS[suffix](picture, path, progress)
    else:
        save_figure(picture.whole(), path)
